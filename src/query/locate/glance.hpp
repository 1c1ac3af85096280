// Locates a point in a stored page without loading the page into the cache.
//
// Loading a page pays off when the page is needed again. Random places in a mesh far larger than
// the cache do not come back. Then it is many times faster to search for the one simplex in the
// page's bytes, to decode no more of them than necessary, and to keep only the location of the page
// (known_pages.hpp).
//
// Where places come along the curve, the last few pages searched are held, with everything decoded
// so far, and one place after the other is found there. When several places have come to a page,
// the boxes of its simplices are worth computing: a place is then compared with eight of them at
// once. For places in no order the copies would cost 4 to 6 % of the time.
//
// A simplex belongs to the page that owns the greatest of its vertices' codes. So the simplex of
// a place may lie in another page than the one that owns the place, further on the curve: in the
// plane one time in ten, in space four in ten. Its vertices are about as far from the place as from
// one another. The greatest code of a few places around, at that distance, leads to the right page
// nineteen times in twenty, in space four in five.
//
// It is not known whether a page will be needed again. So it is loaded the second time, if it is
// among the last pages searched and is not held.
#pragma once

#include "host/memory_resource.hpp"
#include "mesh/cache.hpp"
#include "query/pages/corner_values.hpp"
#include "query/pages/known_pages.hpp"
#include "query/pages/simplex_boxes.hpp"
#include "query/pages/vertex_values.hpp"

#include <abacus/simplex.h>
#include <algorithm>
#include <array>
#include <memory_resource>
#include <vector>

namespace abacus {

template <int D> class Glance {
public:
    /// `bytes` are for what is known about pages. If places come in the order of the curve, as many
    /// again are for held pages; a page that is searched again is then not needed for long.
    Glance(const Cache<D> &cache, const VertexValues<D> &vertex_values, std::size_t bytes,
           bool in_order)
        : cache_(cache), vertex_values_(vertex_values), known_(cache.host(), bytes),
          in_order_(in_order), memory_(cache.host()),
          held_(in_order ? std::clamp<std::size_t>(bytes / sizeof(Held), 2, most_held) : 1,
                &memory_) {
        seen_.fill(end_key); // of no page
    }

    /// Searches pages for a finite simplex with p strictly inside. False if there is none where it
    /// may be expected, or p is on a facet, or a page is in the cache, or should be loaded. The
    /// code is p's, and becomes that of the first place where the simplex may be expected.
    bool find(std::uint64_t &code, const Point<D> &p, abacus_simplex &simplex,
              CornerValues *values);

    std::size_t bytes() const { return known_.bytes() + held_.size() * sizeof(Held); }
    std::uint64_t pages_read() const { return pages_read_; }

private:
    static constexpr std::size_t remembered = 32; // pages
    static constexpr std::size_t most_held = D == 2 ? 8 : 16;
    /// The number of places in a held page from which on the boxes of its simplices are worth
    /// computing.
    static constexpr unsigned worth_boxes = 8;
    /// Distances of places around p, in units of the distance between vertices.
    static constexpr std::array<double, 4> distances{0.6, 1.2, 2.2, 4};
    static constexpr int most_codes = 2 * D + (1 << D); // at one of them

    using Side = std::uint16_t; // as wide as what is compared
    /// The greatest first.
    struct Codes {
        std::array<std::uint64_t, most_codes> code;
        int count = 0;

        void add(std::uint64_t another) {
            int at = count++;
            for (; at > 0 && code[at - 1] < another; --at) code[at] = code[at - 1];
            code[at] = another;
        }
        std::uint64_t *begin() { return code.data(); }
        std::uint64_t *end() { return code.data() + count; }
    };
    enum class Outcome { found, not_here, not_now };

    using Prefix = Column::Prefix;
    /// A page that has been searched. Its bytes are the host's, and invalid after the next call;
    /// for places in order they are copied.
    struct Held {
        Held() {} // the arrays get their content with the page

        Key lower{}, upper{}; ///< the interval it owns; empty at first
        KnownPage page;
        std::uint64_t last_use = 0;
        unsigned asked = 0;        ///< places searched for
        std::uint64_t patches = 0; ///< the patches that have been read, a bit each
        bool has_boxes = false;
        PageView<D> view;
        SimplexBoxes<D> boxes;
        alignas(8) std::array<unsigned char, ABACUS_PAGE_BYTES> bytes;
    };

    /// Codes of places around a cell.
    static void add_along_axes(const Cell<D> &cell, double distance, Codes &codes);
    static void add_diagonally(const Cell<D> &cell, double distance, Codes &codes);
    /// Searches the page that owns a code; `known` if its location is known.
    Outcome look(std::uint64_t code, const KnownPage *known, const Point<D> &p,
                 abacus_simplex &simplex, CornerValues *values);
    bool fetch(std::uint64_t code, const KnownPage *known, abacus_page &page);
    /// The held page that owns a code, or null; for places in no order, the one searched last.
    Held *find_held(std::uint64_t code);
    /// Opens the page that owns a code, in place of the one used longest ago.
    Held &hold(std::uint64_t code, const abacus_page &page, const KnownPage *known);
    bool is_cached(std::uint64_t code) const { return cache_.is_cached({code, 0}); }
    bool has_looked(std::uint64_t code) const;
    bool was_seen(const Key &page);
    /// What a search returns instead of a simplex's number: there is none, or p is on its
    /// border and so inside no other.
    static constexpr int nowhere = -1, on_facet = -2;
    using Prefixes = typename SimplexBoxes<D>::Place;
    int search(Held &held, const Point<D> &p);
    int search_patches(Held &held, const Point<D> &p, const Prefixes &own);
    int search_boxes(Held &held, const Point<D> &p, const Prefixes &own);
    static void read_patch(Held &held, int patch);
    static void make_boxes(Held &held);
    /// Sets the sides of a patch's vertices.
    void compare(const PageView<D> &view, int patch, const Prefixes &own);
    /// As in_simplex(); every point is outside of a ghost.
    static int position(PageView<D> &view, int simplex, const Point<D> &p);
    /// The spacing of the page's vertices, in cells.
    static double spacing(const PageView<D> &view);

    const Cache<D> &cache_;
    const VertexValues<D> &vertex_values_;
    KnownPages known_;
    const bool in_order_;
    HostMemory memory_;
    std::pmr::vector<Held> held_;
    std::uint64_t uses_ = 0;
    std::uint64_t pages_read_ = 0;
    /// For each vertex, and for the point at infinity behind them, two bits per axis: whether it is
    /// below p, or above. A bit that all corners have in common dismisses a simplex.
    std::array<Side, page_vertices<D> + 1> sides_;
    std::array<Prefix, page_vertices<D>> prefixes_; // of a page's vertices on one axis
    /// The intervals of the pages that have been searched for this place.
    std::array<std::pair<Key, Key>, 1 + distances.size() * most_codes> looked_;
    std::size_t looks_ = 0;
    std::array<Key, remembered> seen_;
    std::size_t next_ = 0; // of seen_
};

extern template class Glance<2>;
extern template class Glance<3>;

} // namespace abacus
