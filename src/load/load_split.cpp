// The two sides of a fault: facets of the boundary at one place, whose vertices share their places.
//
// Sorting the boundary by the places of its facets finds them. If two facets are at one place,
// their simplices lie on different sides. As if they were matched, the number of simplices that
// cover a place is the same on both sides. So overlap.hpp does not need to know about them.
#include "blocks/bit_column.hpp"
#include "geometry/point.hpp"
#include "load/load.hpp"

#include <algorithm>

namespace abacus {

namespace {

// A side of a facet: the places of its corners in order, whether their own order is an odd
// permutation of it, and its record of the boundary.
template <int D> constexpr std::size_t place_words = D *D;
template <int D> constexpr std::size_t head_words = place_words<D> + 1;

template <int D> void write_side(const LoadLayout<D> &layout, const Word *boundary, Word *to) {
    std::array<const Point<D> *, D> corner;
    bool odd = false;
    for (int i = 0; i < D; ++i) {
        const Point<D> &p = point_in<D>(layout.boundary_vertex(boundary, i));
        int at = i;
        for (; at > 0 && lexicographically_less<D>(p, *corner[at - 1]); --at, odd = !odd)
            corner[at] = corner[at - 1];
        corner[at] = &p;
    }
    for (const Point<D> *p : corner)
        for (const double x : *p) *to++ = ordered(x);
    *to++ = odd;
    std::copy_n(boundary, layout.boundary, to);
}

} // namespace

template <int D> void Load<D>::leave_out_split_facets() {
    RecordSort sides(host_, head_words<D> + layout_.boundary, head_words<D>, share_);
    boundary_->rewind();
    while (const Word *record = boundary_->next()) write_side<D>(layout_, record, sides.add());
    sides.finish();
    begin(outer_, layout_.boundary, 2);
    Arena<Word> of_first(host_);
    Word *const first = of_first.extend(head_words<D> + layout_.boundary);
    std::uint64_t n = 0; // facets at the place of the first
    const auto facet_of = [&](const Word *side) {
        std::array<Word, D> ids;
        for (int i = 0; i < D; ++i) ids[i] = layout_.boundary_vertex(side + head_words<D>, i)[0];
        return ids;
    };
    const auto simplex_of = [&](const Word *side) {
        return sorted_name(facet_of(side), layout_.behind(side + head_words<D>)[2]);
    };
    const auto end_place = [&] {
        if (n == 1) std::copy_n(first + head_words<D>, layout_.boundary, outer_->add());
    };
    while (const Word *side = sides.next()) {
        const bool is_same = n > 0 && std::equal(side, side + place_words<D>, first);
        if (!is_same) {
            end_place();
            n = 0;
        } else if (side[place_words<D>] == first[place_words<D>]) {
            faults_.add(names_of(simplex_of(first), simplex_of(side)) + " overlap",
                        "They lie on the same side of their facets " +
                            sorted_name(facet_of(first)) + " and " + sorted_name(facet_of(side)) +
                            ", which are at one place.",
                        "Give at most one simplex at a place on each of the two sides of a fault.");
        }
        std::copy_n(side, of_first.size(), first);
        ++n;
    }
    end_place();
    faults_.raise();
    sides.close();
    outer_->finish();
}

} // namespace abacus
