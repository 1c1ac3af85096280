// A simplex page taken apart, changed and put together again: for tests that damage a
// mesh in ways that leave the page itself well-formed.
#pragma once

#include "keys/locational_code.hpp"
#include "mesh/page_format.hpp"
#include "mesh/simplex.hpp"
#include "support/memory_host.hpp"

#include <abacus/mesh_header.h>
#include <array>
#include <vector>

namespace abacus::test {

struct PageEditor {
    static constexpr int infinity = -1; // corner at infinity

    PageEditor(const MemoryHost::Page &page, const abacus_header &mesh);
    /// Writes the page, checksum included. The links are those of the facets that find no partner,
    /// in order. A page that is no longer sound may take more bytes, since each simplex then has to
    /// name its vertices.
    void write(MemoryHost::Page &page) const;

    int number_of(const Point<2> &p) const;
    /// A vertex on the border of the page, or one that is only in this page.
    int vertex(bool on_border) const;
    bool is_ghost(int simplex) const { return simplices[simplex][2] == infinity; }
    /// The neighbour inside the page across facet i; -1 if it is in another one.
    int neighbour(int simplex, int i) const;
    /// Index in `links` of the link across facet i, which leads to another page.
    int link_of(int simplex, int i) const;

    Domain<2> domain;
    Key lower, upper;
    int attribute_count;
    std::vector<std::int64_t> ids;
    std::vector<Point<2>> points;
    std::vector<std::vector<double>> attributes;
    std::vector<Key> links; // with their parts, 0 if the page has none
    std::vector<std::array<int, 3>> simplices;

private:
    /// The input of PageWriter: vertices by 1 + their number, and what lies across each facet.
    std::vector<Simplex<2>> slots() const;
};

} // namespace abacus::test
