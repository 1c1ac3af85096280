// Checks what has to hold between the simplices of a part of the curve and their neighbours,
// wherever these lie, and collects what the stars of the vertices there show about the whole
// (stars.hpp).
#pragma once

#include "blocks/fault_list.hpp"
#include "query/check/stars.hpp"
#include "query/locate/reader.hpp"

namespace abacus {

template <int D> class TopologyCheck {
public:
    TopologyCheck(const Host &host, const abacus_facts &facts, std::size_t cache_bytes,
                  FaultList &faults);

    /// Goes through the pages of [from, to), where pages begin; calls each_page() after each,
    /// until that returns false.
    template <class EachPage> void check(const Key &from, const Key &to, EachPage each_page) {
        for (Key key = from; key < to;) {
            faults_.at = key;
            key = check_page(key);
            if (!each_page()) return;
        }
    }
    const Stars<D> &stars() const { return stars_; }

private:
    /// Returns the key of the page behind.
    Key check_page(const Key &key);
    void check_simplex(Handle h);
    void check_empty_sphere(const Simplex<D> &s, const Point<D> &opposite);

    const bool is_convex_, is_own_;
    FaultList &faults_;
    Reader<D> reader_;
    Cache<D> &cache_;
    OwnVertices<D> own_;
    Stars<D> stars_;
};

extern template class TopologyCheck<2>;
extern template class TopologyCheck<3>;

} // namespace abacus
