// The surface on which an attribute has a value, where it varies linearly in each tetrahedron.
//
// It is found in one scan of the pages, which skips those without such a value. Each page gives its
// triangles and their corners; tetrahedra that share an edge share the corner on it. Between pages
// the numbers of corners show which are the same (sort/dense_ranks.hpp). These are known when all
// pages have been read, so triangles and corners wait in spools. If these may lack room, the pages
// are read once before, to count.
//
// A corner is computed from the two vertices of its edge, the lexicographically lesser one first.
// So every computation of it gives the same bits, and the surface has no cracks.
#pragma once

#include "query/pages/page_edges.hpp"
#include "query/pages/vertex_values.hpp"
#include "query/scan/cell_filter.hpp"
#include "sort/dense_ranks.hpp"
#include "sort/record_spool.hpp"

#include <abacus/surface.h>

namespace abacus {

class Isosurface {
public:
    /// Numbers corners within `memory` bytes, and finds all there is.
    Isosurface(const Host &host, const abacus_facts &facts, const abacus_isosurface_query &query,
               std::size_t memory);

    /// Calls report(triangle) for each; once.
    template <class Report> void each(Report report) {
        abacus_surface_triangle triangle;
        while (read_page())
            for (std::uint64_t left = triangles_here_; left > 0; --left) {
                read(triangle);
                report(triangle);
            }
        close();
    }

private:
    /// Which side a vertex is on; one without a finite value is on neither.
    enum class Side : std::uint8_t { below, above, nowhere };
    struct Corner {
        std::int64_t number;
        Point<3> point;
        double value;
    };

    /// First: pages to spools.
    void scan();
    /// Only counts corners and triangles. Throws if spools have no room for them.
    void count();
    /// Calls end_page() after each page.
    template <class End> void each_page(End end_page);
    void take(const PageView<3> &page);
    void cut(const PageView<3> &page, int simplex);
    std::size_t corner(const PageView<3> &page, int below, int above);
    void add_triangle(std::size_t a, std::size_t b, std::size_t c);

    /// Then: from spools to triangles.
    bool read_page();
    void read(abacus_surface_triangle &triangle);
    void close();

    const abacus_isosurface_query query_;
    const bool is_split_; // vertices at one place are distinguished by their ids
    const Host &host_;
    const abacus_facts facts_;
    const CellFilter<3> filter_;
    const VertexValues<3> vertex_values_;
    Pacer pacer_;
    bool only_counts_ = false;

    std::array<Side, page_vertices<3>> sides_;
    PageEdges edges_;
    DenseRanks numbers_;
    RecordSpool pages_made_; // corners and triangles of each
    RecordSpool corners_;    // coordinates, and the value carried
    RecordSpool triangles_;  // the corners' numbers in their page
    std::uint64_t triangles_here_ = 0;
    Arena<Corner> corners_here_;
};

} // namespace abacus
