// The vertices of a mesh with their values, page by page. A vertex on a border of pages comes with
// each of them.
#pragma once

#include "query/pages/page_scan.hpp"
#include "query/pages/page_values.hpp"
#include "thin/candidate.hpp"

namespace abacus {

template <int D> class SourceVertices {
public:
    SourceVertices(const Host &host, const abacus_facts &facts, std::uint32_t attribute)
        : host_(host), pages_(host, facts), values_(host, facts, static_cast<int>(attribute)),
          all_(host, facts) {}

    /// Goes to the next page that `wants` wants, a function of a box around its vertices;
    /// false after the last.
    template <class Wants> bool advance(Wants wants) {
        const bool is_there = pages_.advance([&](const PageView<D> &page) {
            host_.poll();
            Box<D> box;
            constexpr double most = std::numeric_limits<double>::max();
            for (int axis = 0; axis < D; ++axis) {
                const Column &ranks = page.ranks(axis);
                box.lower[axis] = from_ordered(std::max(ranks.least(), ordered(-most)));
                box.upper[axis] = from_ordered(std::min(ranks.most(), ordered(most)));
            }
            return wants(box);
        });
        if (is_there) values_.enter(page());
        return is_there;
    }
    bool advance() {
        return advance([](const Box<D> &) { return true; });
    }
    const PageView<D> &page() const { return pages_.page(); }
    /// Its value; NaN if it has none, or an infinite one.
    double value(int vertex) const {
        const double value = values_.value(vertex);
        return std::isfinite(value) ? value : NAN;
    }
    /// Writes a vertex as a candidate has it.
    void put(std::uint64_t *to, int vertex) const {
        const double value = values_.value(vertex);
        to[0] = std::bit_cast<std::uint64_t>(page().id(vertex));
        std::memcpy(to + 1, &page().point(vertex), sizeof(Point<D>));
        std::memcpy(to + 1 + D, &value, sizeof value);
        if (!all_.are_elsewhere())
            all_.all(page(), vertex, reinterpret_cast<double *>(to + 1 + D + 1));
    }
    /// All attributes of a vertex that was put.
    void attributes_of(const std::uint64_t *vertex, double *to) const {
        if (!all_.are_elsewhere())
            std::memcpy(to, vertex + 1 + D + 1, all_.count() * sizeof *to);
        else
            all_.all_of(static_cast<std::int64_t>(vertex[0]), vertex_point<D>(vertex), to);
    }

private:
    const Host &host_;
    PageScan<D> pages_;
    PageValues<D> values_;
    VertexValues<D> all_;
};

} // namespace abacus
