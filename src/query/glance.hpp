// Locating a point in a stored page, without loading that into the cache.
//
// A page that is loaded pays off when it is asked again. Places at random in a mesh far
// larger than the cache do not come back: then it is many times quicker to look for the one
// simplex in the page's bytes, to decode no more of them than that takes, and to keep nothing
// but where the page is (known_pages.hpp).
//
// A simplex belongs to the page that owns the greatest of its vertices' codes. So that of a
// place is in the plane one time in ten, in space four in ten, in another page than the one that
// owns the place itself: in one further on the curve. The vertices are about as far away as they
// are from one another; the greatest code of a few places around, at that distance, leads to the
// right page nineteen times in twenty, and four in five.
//
// Whether a page will be asked again nobody knows; so it is loaded at the second time, if it
// is among the last pages looked into.
#pragma once

#include "cache/cache.hpp"
#include "query/known_pages.hpp"

#include <array>

namespace abacus {

template <int D> class Glance {
public:
    /// `bytes` are for what is known of pages.
    Glance(const Cache<D> &cache, std::size_t bytes)
        : cache_(cache), known_(cache.host(), bytes) {
        seen_.fill(end_key); // no page's
    }

    /// Looks for a finite simplex with p strictly inside, in pages that are not in the cache.
    /// False if there is none where it may be expected, or a page is in the cache or to be
    /// loaded. The code is p's, and becomes that of where it may be expected first.
    bool find(std::uint64_t &code, const Point<D> &p, abacus_simplex &simplex);

    std::size_t bytes() const { return known_.bytes(); }

private:
    static constexpr std::size_t remembered = 32; // pages
    /// Distances of places around p, in those of vertices.
    static constexpr std::array<double, 4> distances{0.6, 1.2, 2.2, 4};
    static constexpr int most_codes = 2 * D + (1 << D); // at one of them

    using Side = std::uint16_t; // as wide as what is compared
    struct Codes {
        std::array<std::uint64_t, most_codes> code;
        int count = 0;

        void add(std::uint64_t another) { code[count++] = another; }
        std::uint64_t *begin() { return code.data(); }
        std::uint64_t *end() { return code.data() + count; }
    };
    enum class Outcome { found, not_here, not_now };

    /// Codes of places around a cell.
    static void add_along_axes(const Cell<D> &cell, double distance, Codes &codes);
    static void add_diagonally(const Cell<D> &cell, double distance, Codes &codes);
    /// Looks into the page that owns a code, which may be known.
    Outcome look(std::uint64_t code, const KnownPage *known, const Point<D> &p,
                 abacus_simplex &simplex);
    bool fetch(std::uint64_t code, const KnownPage *known, abacus_page &page);
    bool is_cached(std::uint64_t code) const { return cache_.is_cached({code, 0}); }
    bool has_looked(std::uint64_t code) const;
    bool was_seen(const Key &page);
    /// Number of the simplex in the page at hand, or -1.
    int search(const Point<D> &p);
    /// Sets the sides of these vertices.
    void compare(const Point<D> &p, int begin, int end);
    bool contains(int simplex, const Point<D> &p);
    /// Of the vertices in the page at hand, in cells.
    double spacing() const;

    const Cache<D> &cache_;
    KnownPages known_;
    PageView<D> view_;
    KnownPage at_hand_;
    /// Of each vertex, and of the point at infinity behind them, two bits an axis: whether it
    /// is below p, or above. What all corners have in common dismisses a simplex.
    std::array<Side, page_vertices<D> + 1> sides_;
    /// What the pages own that have been looked into for this place.
    std::array<std::pair<Key, Key>, 1 + distances.size() * most_codes> looked_;
    std::size_t looks_ = 0;
    std::array<Key, remembered> seen_;
    std::size_t next_ = 0; // of seen_
};

extern template class Glance<2>;
extern template class Glance<3>;

} // namespace abacus
