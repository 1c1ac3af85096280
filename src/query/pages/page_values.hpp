// An attribute of the vertices of one page after the other. A vertex is in several simplices of its
// page; its value is looked up once, and only if needed.
#pragma once

#include "query/pages/vertex_values.hpp"

#include <bitset>
#include <cmath>

namespace abacus {

template <int D> class PageValues {
public:
    /// Without an attribute (-1) all values are missing.
    PageValues(const Host &host, const abacus_facts &facts, int attribute)
        : vertex_values_(host, facts), attribute_(attribute) {}

    /// Goes to a page, which must exist until the next one.
    void enter(const PageView<D> &page) {
        page_ = &page;
        is_known_.reset();
    }
    double value(int vertex) const {
        if (attribute_ < 0) return NAN;
        const auto v = static_cast<std::size_t>(vertex);
        if (!is_known_[v]) {
            is_known_.set(v);
            values_[v] = vertex_values_.value(*page_, vertex, attribute_);
        }
        return values_[v];
    }

private:
    const VertexValues<D> vertex_values_;
    const int attribute_;
    const PageView<D> *page_ = nullptr;
    // A cache: it changes no answer.
    mutable std::bitset<page_vertices<D>> is_known_;
    mutable std::array<double, page_vertices<D>> values_;
};

} // namespace abacus
