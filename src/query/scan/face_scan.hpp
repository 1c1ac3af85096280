// The vertices of a window, or its edges, each once, without a list of those already returned.
//
// A face of the mesh, a vertex or an edge, is in all simplices around it, and these are in several
// pages. One simplex returns it, and can decide this by itself: the simplex into which a fixed
// direction leads from the face (geometry/direction.hpp). At the boundary the direction may lead
// outside. Then one of the ghosts around the face returns it: but whether the direction leads
// outside, and which ghost comes first, follows only from all simplices around the face. They are
// looked up in a cache. The facets of the boundary are those that only one of the simplices has;
// the one with the lexicographically least corners comes first. Results are kept for some faces,
// since a vertex may have any number of ghosts. For an edge in the plane its ghost alone decides.
//
// All these simplices and ghosts are in pages of the window, if the face meets it.
#pragma once

#include "host/memory_resource.hpp"
#include "query/locate/reader.hpp"
#include "query/pages/vertex_values.hpp"
#include "query/scan/window.hpp"

#include <bit>
#include <memory_resource>
#include <optional>
#include <vector>

namespace abacus {

template <int D> class FaceScan {
public:
    /// Faces of one corner, or of two, which are then at most as far apart as edges may be long, of
    /// simplices in the extent's region.
    FaceScan(const Host &host, const abacus_facts &facts, const abacus_window &window, int corners,
             const abacus_extent &extent, std::size_t cache_bytes)
        : FaceScan(host, facts, window, corners, extent, cache_bytes, std::nullopt) {}
    /// Vertices of which an attribute is within a range.
    FaceScan(const Host &host, const abacus_facts &facts, const abacus_window &window,
             const abacus_range &range, std::size_t cache_bytes)
        : FaceScan(host, facts, window, 1, {}, cache_bytes, range) {}

    /// Goes to the next face; false after the last.
    bool advance();
    /// The page with the current face, and the number of a corner there.
    const PageView<D> &page() const { return pages_.page(); }
    int vertex(int corner) const { return vertices_[corner]; }
    /// Whether the current face, an edge in the plane, is fixed.
    bool is_fixed() const requires(D == 2) {
        const unsigned face = face_ - 1; // advance() stands behind it
        return page().fixed(simplex_).is_fixed(std::countr_one(face));
    }
    /// Pages of the window, without those that the search for owners of faces reads.
    std::uint64_t pages_read() const { return pages_.pages_read(); }
    const VertexValues<D> &vertex_values() const { return vertex_values_; }

private:
    FaceScan(const Host &host, const abacus_facts &facts, const abacus_window &window, int corners,
             const abacus_extent &extent, std::size_t cache_bytes,
             std::optional<abacus_range> range);

    /// Vertices of different ids may be at one place.
    struct Corner {
        Point<D> point;
        std::int64_t id;

        auto operator<=>(const Corner &) const = default;
    };
    using FacetCorners = std::array<Corner, D>;

    bool take(int simplex, unsigned face);
    void compare_values();
    bool is_wanted();
    /// Whether a simplex at the current face is in the extent's region.
    bool touches_region();
    /// Whether the current face belongs to a ghost of the page.
    bool is_of_ghost(int ghost);
    /// The ghost to which it belongs, by its corners in order; nothing if the direction leads into
    /// a simplex.
    std::optional<FacetCorners> find_owner();

    /// The result for a face.
    using FaceCorners = std::array<Corner, 2>; // for a vertex both are the same
    struct Known {
        FaceCorners face;
        std::optional<FacetCorners> owner;
    };
    static constexpr std::size_t most_known = 1024;
    static std::size_t place(const FaceCorners &face);
    const Point<D> &point(int corner) const { return page().point(vertices_[corner]); }
    Corner corner(int vertex) const { return {page().point(vertex), page().id(vertex)}; }

    const Host &host_;
    const abacus_facts facts_;
    const int corners_;
    const abacus_extent extent_;
    const std::size_t cache_bytes_;
    const std::optional<abacus_range> range_;
    const Window<D> window_;
    const VertexValues<D> vertex_values_;
    std::array<bool, page_vertices<D>> is_in_range_; // of a page's vertices
    RangeScan<D> pages_;
    std::optional<Reader<D>> reader_; // once needed
    HostMemory memory_;
    std::pmr::vector<std::optional<Known>> known_; // by place(); empty until needed
    std::array<int, 2> vertices_{};
    bool in_page_ = false;
    int simplex_ = 0;
    unsigned face_ = 0; // the next face of the simplex
};

extern template class FaceScan<2>;
extern template class FaceScan<3>;

} // namespace abacus
