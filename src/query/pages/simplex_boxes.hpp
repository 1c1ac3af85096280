// The boxes of a page's simplices, to find the simplices around a place eight at a time.
//
// They consist of prefixes of coordinates (Column::prefix), two bytes each. A simplex whose box
// does not contain a place does not contain the place either; a simplex whose box does is tested
// exactly.
#pragma once

#include "mesh/page_format.hpp"

#include <array>
#include <bit>
#include <cstring>
#include <limits>

namespace abacus {

template <int D> class SimplexBoxes {
public:
    using Prefix = Column::Prefix;
    /// A place in terms of a page's columns.
    using Place = std::array<Prefix, D>;
    using Range = typename PageView<D>::Range;

    SimplexBoxes() {} // make() fills them

    static Place place(const PageView<D> &page, const Point<D> &p) {
        Place place;
        for (int axis = 0; axis < D; ++axis)
            place[axis] = page.ranks(axis).prefix(ordered(p[axis]));
        return place;
    }

    /// Makes the boxes of a patch, which has been read.
    void make(const PageView<D> &page, int patch);

    /// Calls visit(simplex) for each of a range, which begins with a patch and ends with one, whose
    /// box meets that from `lower` to `upper`, until it returns false.
    template <class Visit>
    void meeting(const Place &lower, const Place &upper, Range range, Visit visit) const {
        for (int first = range.begin; first < range.end; first += at_once) {
            Lanes within = Lanes{} - 1;
            for (int axis = 0; axis < D; ++axis)
                within &= (lanes(&lower_[axis][first]) <= upper[axis]) &
                          (lower[axis] <= lanes(&upper_[axis][first]));
            const auto halves = std::bit_cast<std::array<std::uint64_t, 2>>(within);
            if ((halves[0] | halves[1]) == 0) continue;
            for (int i = 0; i < at_once; ++i)
                if (within[i] != 0 && !visit(first + i)) return;
        }
    }
    /// The same for those whose box contains the place.
    template <class Visit> void around(const Place &place, Range range, Visit visit) const {
        meeting(place, place, range, visit);
    }

private:
    static constexpr int at_once = 8;
    static_assert(patch_simplices % at_once == 0);
    using Lanes = Prefix __attribute__((vector_size(at_once * sizeof(Prefix))));
    static constexpr Prefix most = std::numeric_limits<Prefix>::max(), least = Prefix(~most);

    static Lanes lanes(const Prefix *from) {
        Lanes lanes;
        std::memcpy(&lanes, from, sizeof lanes);
        return lanes;
    }

    /// The least and the greatest prefix of each simplex's vertices on each axis. A ghost contains
    /// nothing, nor does what follows the last simplex.
    using Bounds = std::array<Prefix, block_slots<D> + at_once>;
    std::array<Bounds, D> lower_, upper_;
};

template <int D> void SimplexBoxes<D>::make(const PageView<D> &page, int patch) {
    std::array<Prefix, page_vertices<D>> prefixes; // of vertices on one axis
    const Range fresh = page.fresh_of(patch), named = page.named_of(patch),
                simplices = page.simplices_of(patch);
    for (int axis = 0; axis < D; ++axis) {
        const Column &ranks = page.ranks(axis);
        ranks.prefixes(static_cast<std::size_t>(fresh.begin), static_cast<std::size_t>(fresh.end),
                       prefixes.data() + fresh.begin);
        for (int i = named.begin; i < named.end; ++i)
            if (const int v = page.named(i); v < fresh.begin)
                prefixes[v] = ranks.prefix_at(static_cast<std::size_t>(v));
        for (int s = simplices.begin; s < simplices.end; ++s) {
            const auto &corners = page.corners(s);
            Prefix below = most, above = least;
            for (int i = 0; i <= D && !page.is_ghost(s); ++i) {
                below = std::min(below, prefixes[corners[i]]);
                above = std::max(above, prefixes[corners[i]]);
            }
            lower_[axis][s] = below;
            upper_[axis][s] = above;
        }
        if (simplices.end < page.simplices()) continue; // another patch's
        std::fill_n(&lower_[axis][simplices.end], at_once, most);
        std::fill_n(&upper_[axis][simplices.end], at_once, least);
    }
}

} // namespace abacus
