// Finds the cavities of what is kept of a mesh in space: the enclosed parts that are not kept.
//
// The parts that are not kept are connected across facets. The part that has the ghosts is the
// outside; all others are cavities. Within a page parts are found in memory (union and find). A
// part that continues in other pages gets a number, and its facets on the page's border are
// recorded by their corners. After sorting by these, a facet comes twice in a row, and joins the
// numbers of its two sides; a facet of a fault may come four times, since each side has a ghost,
// and all are outside. A part that neither continues nor has a ghost is a cavity by itself, and
// takes no memory.
#pragma once

#include "query/shapes/disjoint_sets.hpp"
#include "query/shapes/kept_simplices.hpp"
#include "sort/record_sort.hpp"

namespace abacus {

class Cavities {
public:
    static constexpr std::uint32_t shut_in = UINT32_MAX;

    /// Takes two thirds of the memory for its facets, the rest for numbers.
    Cavities(const Host &host, std::size_t memory);

    /// For a page: first all of its simplices that are not kept, in any order, ...
    void begin_page(Cache<3> &cache, Handle any);
    /// ... each with `beyond`, the simplex across a facet, if it is not kept either, on the page or
    /// not, ...
    void meet(Handle h, int facet, Handle beyond);
    void meet_outside(Handle ghost) { here_.join(outside_here, local(ghost)); }
    /// ... then the number of each.
    void number_page();
    std::uint32_t number(Handle h) { return numbers_here_[here_.find(local(h))]; }

    /// After the last page.
    void finish();
    bool is_outside(std::uint32_t number) { return number != shut_in && parts_.find(number) == 0; }

private:
    // Corners of a facet, and the number of the part on one side of it.
    static constexpr std::size_t corner_words = 9, facet_words = corner_words + 1;
    static constexpr std::uint32_t outside_here = 0;

    std::uint32_t local(Handle h) const { return 1 + (h - first_); }
    std::uint32_t new_number();

    Cache<3> *cache_ = nullptr;
    Handle first_{}; // of the page's block
    DisjointSets here_;
    Arena<std::uint32_t> numbers_here_; // of the names of its sets
    Arena<Link> border_;                // facets of the page whose other side is not kept either
    const std::size_t most_numbers_;
    DisjointSets parts_; // the outside is 0
    RecordSort facets_;
};

} // namespace abacus
