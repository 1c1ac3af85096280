// The simplices of a mesh that overlap a simplex of another one: their intersection has an area, or
// a volume. Exact.
//
// Let T be the simplex, without its border. In a convex mesh a walk leads to a point strictly
// inside of T. The simplex around it overlaps T, and from there a flood crosses each facet that has
// points in T. It finds all of them. Those that overlap T fill its part in the mesh, which is
// convex; without the vertices, and without the edges in space, this is still connected; and a path
// in it leads from one simplex to the next across facets that have points in T. If the point lies
// outside the mesh, a flood over the hull's facets that it sees looks for one that has points in T
// (see range_scan.hpp), and the other flood begins there.
//
// Because of rounding, no point strictly inside T may be found. Then the flood begins at a corner
// and crosses every facet that T's box meets, which is more than necessary.
//
// A flood holds what it meets in the cache. So beyond a certain number the pages are read one after
// the other instead (range_scan.hpp). In a mesh that is not convex, pages are found by their
// boxes.
//
// A window leaves out simplices outside it where that saves work: some of them may still be found.
#pragma once

#include "geometry/overlap.hpp"
#include "query/locate/reader.hpp"
#include "query/pages/page_search.hpp"
#include "query/scan/range_scan.hpp"

#include <functional>

namespace abacus {

template <int D> class Overlaps {
public:
    /// `attribute`: of the values handed out. Simplices outside of the extent are left
    /// out, unless that is 0.
    Overlaps(const Host &host, const abacus_facts &facts, std::uint32_t attribute,
             const abacus_extent &extent, const Box<D> &window, std::size_t cache_bytes);

    /// Gets a simplex of positive orientation and the values at its corners.
    using Visit = std::function<void(const Corners<D> &, const std::array<double, D + 1> &)>;
    void each(const Corners<D> &simplex, const Visit &visit);

    /// A box around the whole mesh; the empty box for an empty mesh.
    Box<D> around_all();

private:
    /// The simplex of the query, and what is known about it.
    struct Asked {
        const Corners<D> &corners;
        Box<D> box;
        Point<D> inside;         // a point of it, strictly inside it and the window, or a corner
        bool is_strictly_inside; // whether it is the former
    };
    class Area;

    Asked asked(const Corners<D> &simplex) const;
    bool crosses(const Asked &t, const FacetCorners<D> &facet) const;
    /// A simplex where a flood may begin: no_handle if nothing overlaps.
    Handle begin(const Asked &t);
    Handle begin_outside(const Asked &t, Handle ghost);
    /// False if it would meet too many at once; then nothing has been visited.
    bool flood(const Asked &t, const Visit &visit);
    void scan_pages(const Asked &t, const Visit &visit);
    void search_pages(const Asked &t, const Visit &visit);
    void show(const Asked &t, const PageView<D> &page, int simplex, const Visit &visit) const;
    void show(const Asked &t, const Corners<D> &corners, const std::array<double, D + 1> &values,
              const Visit &visit) const;

    const Host &host_;
    const abacus_facts facts_;
    const int attribute_;
    const abacus_extent extent_;
    const Box<D> window_;
    Reader<D> reader_;
    std::optional<PageSearch<D>> search_; // of a mesh that is not Delaunay
};

extern template class Overlaps<2>;
extern template class Overlaps<3>;

} // namespace abacus
