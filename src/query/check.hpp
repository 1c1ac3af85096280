// Exact verification of a stored mesh: what §4.11.2 of the dissertation asks for.
//
// A look at the header and three passes, each independent of how the mesh was made:
//
//   header    in 2D, Euler's relation holds
//   pages     every page decodes and has the checksum of its bytes; the intervals
//             partition the curve; each simplex is in the page that owns its key and
//             positively oriented; the boxes of patches fit; the counts add up
//   topology  every link leads, by its stored key, to the simplex with the same facet
//             in the opposite orientation; pages agree about the vertices they share;
//             across every facet the empty-sphere criterion holds under the
//             perturbation, and the hull is convex; simplices wind once around vertices
//             and edges, and are one piece
//   points    every repeated point equals a vertex; the sequence of those that wait is
//             whole; the counts add up
//
// If attributes are apart, two more passes look into their pages, and for the attributes of each
// vertex.
//
// A mesh that is not Delaunay need not fulfil the empty-sphere criterion and Euler's
// relation, nor have a convex hull, which its stars would be judged by. Instead, the two
// simplices at a facet must lie on its two sides, which follows from their orientations.
// That simplices which are no neighbours do not overlap is verified when the mesh is
// loaded, and not again.
//
// Its vertices are listed beside it, and the list is compared with the pages.
//
// The ids, attributes and places of points are stored only once. So only the checksum tells
// that they have changed in a simplex page. The other passes do not depend on it, and tell
// what else has changed.
//
// Locally Delaunay across every facet is globally Delaunay (Delaunay 1934), and under the
// perturbation unique, where no place is covered twice: see query/stars.hpp.
#pragma once

#include "attributes/attribute_reader.hpp"
#include "points/repeated_points.hpp"
#include "points/vertex_reader.hpp"
#include "query/page_scan.hpp"
#include "query/reader.hpp"
#include "query/stars.hpp"

#include "host/memory_resource.hpp"

#include <abacus/read.h>
#include <memory_resource>
#include <vector>

namespace abacus {

template <int D> class Check {
public:
    /// Verifies at once; keeps at most `limit` faults.
    Check(const Host &host, const abacus_header &header, std::size_t cache_bytes,
          std::size_t limit);

    /// False after the last fault.
    bool next(abacus_fault &fault) {
        if (at_ == faults_.size()) return false;
        fault = faults_[at_++];
        return true;
    }

private:
    void check_header();
    void check_pages();
    void check_page(const PageView<D> &page);
    void check_simplices(const PageView<D> &page);
    void check_box(const PageView<D> &page, int patch);
    void check_topology();
    void check_simplex(Cache<D> &cache, Handle h);
    void check_whole(const Stars<D> &stars);
    void check_repeated_points();
    void check_follows(const Key &last, const Key &at);
    void check_waiting_points();
    void check_listed_vertices();
    void check_attribute_pages();
    void check_attributes();
    void check_empty_sphere(const Cache<D> &cache, const Simplex<D> &s, const Point<D> &opposite);

    /// Keeps a fault, if there is room for more.
    void fault(const char *kind, const Key &key, const char *message);
    /// One of what the current page says of its content, which may well hold together.
    void fault_of_content(const char *kind, const char *message);
    /// Runs a pass; a page so damaged that the pass cannot go on is a fault of its own.
    template <class Pass> void run(const char *kind, Pass pass);
    void report(std::uint64_t pages);

    const Host &host_;
    const abacus_header &header_;
    std::size_t cache_bytes_, limit_;
    HostMemory memory_;
    Domain<D> domain_;
    std::pmr::vector<abacus_fault> faults_;
    std::size_t at_ = 0;
    Key at_key_{}; // of the current page
    std::uint64_t pages_ = 0;
    bool is_counted_ = false; // pages_ are all
    std::uint64_t simplices_ = 0, ghosts_ = 0;
    std::size_t contents_ = 0;        // of the faults so far, those of fault_of_content()
    std::uint64_t page_vertices_ = 0; // of all pages
};

} // namespace abacus
