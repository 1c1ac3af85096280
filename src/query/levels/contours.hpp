// Lines of equal value in a mesh of the plane, and the bands between them.
//
// The pages of the window are read. Each triangle is cut into pieces (contour_cut.hpp), and
// these are joined (contour_pieces.hpp). A small interval can make any number of them, so unless
// they are few they are counted first, in a separate pass over the pages. Only triangles with a
// finite value at each corner and without too long an edge are used.
#pragma once

#include "query/levels/contour_pieces.hpp"
#include "query/levels/contour_rims.hpp"
#include "query/pages/corner_values.hpp"
#include "query/pages/extent.hpp"
#include "query/pages/vertex_values.hpp"
#include "query/scan/window.hpp"
#include "sort/pacer.hpp"

namespace abacus {

class Contours {
public:
    Contours(const Host &host, const abacus_facts &facts, const abacus_window &window,
             const abacus_contouring &contouring, std::size_t memory);

    /// Reports all lines, or rings, in order; once.
    void each(abacus_contour_report report, void *context);

private:
    using Page = PageView<2>;

    /// An edge of a page that has been seen in one triangle, or in two.
    struct PageEdge {
        std::uint16_t from, to; // vertices; equal if there is no edge
        bool has_two;
    };
    static constexpr std::size_t edge_slots = 4 * page_vertices<2>;

    void read();
    /// Throws if there are too many levels, or too many lines for spools.
    void count();
    /// Reads the values of a page's vertices; false if no line can be there.
    bool read_values(const Page &page);
    /// A lower bound for the number of pieces of the page whose values have been read.
    double most_pieces(const Page &page) const;
    /// Cuts triangles of the page whose values have been read, and calls take(corners) for each
    /// that has a part left.
    template <class Take> void each_triangle(const Page &page, Take take);
    void read_page(const Page &page);
    /// Adds the pieces of the triangle that has been cut.
    ContourRanks include_levels() {
        const ContourRanks ranks = cut_.ranks();
        levels_.include(ranks);
        return ranks;
    }
    void note_edge(int from, int to);
    void note_rims();
    void report_lines(abacus_contour_report report, void *context);
    void report_bands(abacus_contour_report report, void *context);

    // Up to this many are not counted first.
    static constexpr double few_pieces = 512;

    const Host &host_;
    const abacus_facts &facts_;     // as long as all is read
    const std::uint64_t simplices_; // of the mesh, ghosts included
    Pacer pacer_;
    const abacus_contouring how_;
    const Window<2> window_;
    const ContourWindow bounds_;
    ContourLevels levels_;
    CornerValues attribute_;
    const VertexValues<2> vertex_values_;
    RangeScan<2> pages_;
    ContourCut cut_;
    ContourPieces pieces_;
    ContourRims rims_;
    std::array<ContourPoint, page_vertices<2>> points_; // of the page's vertices
    std::array<double, page_vertices<2>> values_;       // of the page's vertices; NaN: not finite
    std::array<std::int64_t, page_vertices<2>> ranks_;
    ContourRanks all_ranks_{0, 0}; // of them
    Arena<PageEdge> edges_;        // of the page, hashed
};

} // namespace abacus
