// Locating a point in a stored page, without loading that into the cache.
//
// A page that is loaded pays off when it is asked again. Places at random in a mesh far
// larger than the cache do not come back: then it is several times quicker to decode the
// page, look for the one simplex, and keep nothing.
//
// A simplex belongs to the page that owns the greatest of its vertices' codes. So that of a
// place may be in another page than the one that owns the place itself, in the plane one time
// in ten, in space one in two: then a vertex not far away has that page's code.
//
// Whether a page will be asked again nobody knows; so it is loaded at the second time, if it
// is among the last pages looked into.
#pragma once

#include "cache/page_format.hpp"
#include "geometry/locational_code.hpp"
#include "geometry/predicates.hpp"
#include "host/host.hpp"

#include <array>

namespace abacus {

template <int D> class Glance {
public:
    Glance(const Host &host, int attributes) : host_(host), attributes_(attributes) {
        seen_.fill(end_key); // no page's
    }

    /// Looks for a finite simplex with p strictly inside: in the page that owns the key, p's,
    /// then in those around. False if they have none, or the page is to be loaded.
    bool find(const Key &key, const Domain<D> &domain, const Point<D> &p,
              abacus_simplex &simplex);

private:
    static constexpr std::size_t remembered = 64; // pages

    bool was_seen(const Key &page);
    bool look_into(const abacus_page &page, const Domain<D> &domain, const Point<D> &p,
                   abacus_simplex &simplex);
    /// In the pages that own places about as far from p as vertices are from one another.
    bool look_around(const Domain<D> &domain, const Point<D> &p, abacus_simplex &simplex);
    /// Number of the simplex in the page at hand, or -1.
    int search(const Point<D> &p) const;

    const Host &host_;
    const int attributes_;
    PageView<D> view_;
    std::array<Key, remembered> seen_;
    std::size_t next_ = 0; // of seen_
};

extern template class Glance<2>;
extern template class Glance<3>;

} // namespace abacus
