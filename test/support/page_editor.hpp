// A simplex page taken apart, changed and put together again: for tests that damage a
// mesh in ways that leave the page itself well-formed.
#pragma once

#include "cache/page_format.hpp"
#include "support/memory_host.hpp"

#include <array>
#include <vector>

namespace abacus::test {

struct PageEditor {
    static constexpr int infinity = -1; // corner at infinity

    explicit PageEditor(const MemoryHost::Page &page);
    /// Puts the page together: counts and flags follow from the arrays, the box from the
    /// vertices unless `keep_box`.
    void write(MemoryHost::Page &page, bool keep_box = false) const;

    int number_of(const Point<2> &p) const;
    bool is_ghost(int simplex) const { return simplices[simplex][2] == infinity; }
    /// The neighbour inside the page across facet i; -1 if it is in another one.
    int neighbour(int simplex, int i) const;
    /// Index in `links` of the link across facet i, which leads to another page.
    int link_of(int simplex, int i) const;

    PageHeader header;
    std::array<double, 4> box;
    std::vector<std::int64_t> ids;
    std::vector<Point<2>> points;
    std::vector<std::vector<double>> attributes;
    std::vector<Key> links; // with their parts, 0 if the page has none
    std::vector<std::array<int, 3>> simplices;
};

} // namespace abacus::test
