// Exact verification of a stored mesh, as §4.11.2 of the dissertation requires.
//
// A check of the header and three passes, each independent of how the mesh was made:
//
//   header    in 2D, Euler's relation holds
//   pages     every page decodes and has the checksum of its bytes; the intervals
//             partition the curve; each simplex is in the page that owns its key and
//             positively oriented; the boxes of patches fit; the counts add up
//   topology  every link leads, by its stored key, to the simplex with the same facet
//             in the opposite orientation; pages agree about the vertices they share;
//             across every facet that is not fixed the empty-sphere criterion holds under
//             the perturbation, and both sides are in the same region; both say whether it is
//             fixed, and the hull is convex;
//             simplices wind once around vertices and edges, and form one piece
//   points    every repeated point equals a vertex; the sequence of those that wait is
//             whole; the counts add up
//
// If attributes are apart, two more passes check their pages, and that each vertex has its
// attributes. If simplices have labels, two more check their pages, and to which simplices they
// belong; the same for markers of facets, on which both sides have to agree.
//
// A mesh that is not Delaunay need not fulfil the empty-sphere criterion and Euler's
// relation, nor have a convex hull, on which the check of stars relies. Instead, the two simplices
// at a facet must lie on its two sides, which follows from their orientations. Whether simplices
// that are not neighbours overlap is verified when the mesh is loaded, and not again.
//
// The vertices of such a mesh are listed beside it, and the list is compared with the pages.
//
// A page stores the id, the attributes and the place of each of its vertices. If two pages have a
// vertex, they have to agree. If one page alone has it, only the checksum shows that its id, its
// attributes or, by a little, its place has changed. The other passes do not depend on the
// checksum, and detect all other changes.
//
// A mesh that is locally Delaunay across every facet is globally Delaunay (Delaunay 1934), or,
// across every facet that is not fixed, constrained Delaunay (Lee and Lin 1986), and under the
// perturbation unique, if no place is covered twice: see query/check/stars.hpp.
//
// In a large mesh several threads check pages and follow links (check_threads.cpp).
#pragma once

#include "attributes/attribute_reader.hpp"
#include "mesh/page_attributes.hpp"
#include "points/repeated_points.hpp"
#include "points/vertex_reader.hpp"
#include "query/check/page_check.hpp"
#include "query/check/topology_check.hpp"
#include "query/pages/page_scan.hpp"

#include <abacus/check.h>

namespace abacus {

template <int D> class Check {
public:
    /// Verifies at once; keeps at most `limit` faults.
    Check(const Host &host, const abacus_facts &facts, std::size_t cache_bytes, std::size_t limit);

    /// False after the last fault.
    bool next(abacus_fault &fault) { return faults_.next(fault); }
    /// Simplices that are flat in doubles, which is not a fault.
    std::uint64_t flat() const { return counts_.flat; }
    /// Fixed edges, of a constrained mesh.
    std::uint64_t fixed() const { return counts_.fixed / 2; }
    std::uint64_t soft() const { return counts_.soft / 2; }

private:
    class Together;

    void check_header();
    void check_pages();
    /// The passes that need a mesh of sound pages; links by several threads if there are any.
    void check_links_and_points(Together *together);
    void check_topology();
    /// What the stars of all vertices show together.
    void check_stars(const StarCounts &stars);
    void check_repeated_points();
    void check_follows(const Key &last, const Key &at);
    void check_waiting_points();
    void check_listed_vertices();
    /// Their pages have this many rows in each group.
    template <int K>
    void check_attribute_pages(const char *kind, unsigned attributes, std::uint64_t owners,
                               unsigned first = first_group<K>);
    void check_attributes();
    void check_labels(const char *kind, unsigned columns, std::uint64_t owners, unsigned first);
    void check_markers();
    /// Calls visit(page, simplex) for all of them.
    template <class Visit> void each_simplex(const Visit &visit) {
        PageScan<D> scan(host_, facts_);
        PageView<D> page;
        std::uint64_t pages = passes_++ * pages_;
        while (scan.fetch()) {
            report_some(++pages);
            page.read(scan.bytes(), scan.size(), page_attributes(facts_.columns),
                      PageView<D>::Checksum::ignore);
            for (int s = 0; s < page.simplices(); ++s) visit(page, s);
        }
    }

    void report(std::uint64_t pages, unsigned threads = 0);
    void report_some(std::uint64_t pages) {
        if (pages % 64 == 0) report(pages);
    }

    const Host &host_;
    const abacus_facts &facts_;
    std::size_t cache_bytes_;
    Domain<D> domain_;
    FaultList faults_;
    std::uint64_t pages_ = 0;
    std::uint64_t passes_ =
        2; // passes over all pages that are done before those over labels and the like
    bool is_counted_ = false; // pages_ are all
    typename PageCheck<D>::Counts counts_;
};

} // namespace abacus
