// The cavity of a point that is inserted (Bowyer 1981, Watson 1981; dissertation §4.12.3):
// the simplices whose circumspheres contain it, a ghost's being the half-space beyond its
// hull facet. It is star-shaped around the point, and is replaced by the simplices that join
// the facets of its rim to the point.
//
// The test of a simplex beyond a facet reuses what earlier tests have computed from the facet's
// corners, and reads only one vertex, the apex (geometry/in_sphere.hpp).
//
// In the plane the triangles form a tree, since the polygon has no vertex inside. A
// depth-first search that keeps the order of the edges around each triangle visits each
// triangle once. It lists the rim as a cycle: an edge ends where the next one begins. Nothing needs
// to be looked up: the new triangle on an edge meets the one on the next edge.
//
// If the mesh is constrained, the cavity ends at fixed edges, and the search has to begin at the
// triangle that contains the point. What lies beyond a fixed edge is loaded all the same, since its
// link changes. Only an edge on which the point lies is crossed: it is split, and both halves are
// fixed. The rest of the rim keeps what is fixed. A new triangle is in the region of the one that
// was on its edge of the rim.
//
// In space the search may return to a tetrahedron, so it marks what it has seen, and numbers the
// corners. It goes breadth first, and tests the tetrahedra beyond several facets together. No
// processor can predict the outcome of a test, which is about a coin's toss. A branch on it would
// stop the following tests too, not only the next step. So links and vertices are fetched side by
// side, determinants are computed side by side, and the results are sorted out without branches.
// The new tetrahedra find one another by their ridges, the edges of the rim, in small tables
// (ridges.hpp).
#pragma once

#include "delaunay/delaunay.hpp"
#include "delaunay/ridges.hpp"
#include "geometry/in_sphere.hpp"

namespace abacus {

/// The simplices inside the cavity, in either dimension.
template <int D> class CavityInside {
protected:
    explicit CavityInside(Delaunay<D> &mesh)
        : mesh_(mesh), cache_(mesh.cache()), inside_(cache_.host()) {}

    void add(Handle h) {
        inside_.push_back(h);
        if (inside_.size() % 4096 == 0) {
            cache_.poll();
            if (inside_.size() > cache_.cached_blocks() * std::size_t(block_slots<D>))
                throw_no_triangulation();
        }
    }
    /// Destroys them; returns how many were ghosts.
    std::int64_t hollow_out() {
        std::int64_t ghosts = 0;
        for (const Handle h : inside_) {
            // The search can return here only if the triangulation is not Delaunay.
            if (cache_.simplex(h).is_free()) throw_no_triangulation();
            ghosts += cache_.simplex(h).is_ghost();
            if (mesh_.log != nullptr) mesh_.log->go(cache_, h);
            cache_.destroy(h);
        }
        mesh_.forget();
        return ghosts;
    }
    /// Logs the n simplices created in their place.
    void log_created(const Arena<Handle> &created, std::size_t n) {
        if (mesh_.log == nullptr) return;
        for (std::size_t i = 0; i < n; ++i) mesh_.log->come(cache_, created[i]);
    }

    Delaunay<D> &mesh_;
    Cache<D> &cache_;
    Arena<Handle> inside_;
};

template <int D> class Cavity;

template <> class Cavity<2> : CavityInside<2> {
public:
    explicit Cavity(Delaunay<2> &mesh);

    /// Finds the cavity of p, which is in conflict with `first`.
    void find(const Point<2> &p, Handle first);
    /// Replaces the cavity found last by the star of v, the vertex at its point.
    void fill(VertexIndex v);
    /// After find() has thrown: the next search starts afresh.
    void give_up() {}

private:
    /// An edge of a triangle inside, counterclockwise; it ends where the one below it on the stack
    /// begins.
    struct Edge {
        SeenPoint<2> begin;
        double cross; // of both ends
        VertexIndex vertex;
        // About the triangle beyond:
        bool is_inside;
        Link outer;
        SeenPoint<2> apex;
        double cross_ac, cross_cb; // of the begin and the apex, the apex and the end
    };
    /// It ends where the next one begins.
    struct RimEdge {
        VertexIndex begin;
        Link outer;
    };

    template <bool is_constrained> void search(const Point<2> &p, Handle first);
    /// Tests the triangle beyond an edge whose begin is known.
    template <bool is_constrained>
    void look_beyond(Edge &edge, Link inner, const SeenPoint<2> &end, const Point<2> &p);
    /// Whether p lies on a fixed edge, which is to be split then.
    [[gnu::noinline]] bool splits(Link edge, const Point<2> &p);
    /// Keeps the regions of the triangles inside, along the rim.
    void note_regions();
    /// Fixes the edges of the new triangles, and puts these into the regions that were there.
    void fix_edges();
    /// The test where in_circle() is uncertain: above all for ghosts, whose point at infinity has
    /// no coordinates. It is a separate function to keep the loop around the test small.
    [[gnu::noinline]] bool is_exactly_inside(Handle h, const Point<2> &p) const;
    /// Room for more; returns where the top is now.
    Edge *deepen(const Edge *top);
    /// Allocates slots for the star of a vertex with this code, one for each edge of the rim, and
    /// repeats the first one at the end.
    void allot(std::uint64_t code);
    void bring_infinity_last(Handle h);

    Arena<Edge> stack_;
    Arena<RimEdge> rim_; // with the first one repeated at the end, while it is filled
    Arena<Handle> created_;
    Arena<RegionNumber> regions_;      // along the rim, of a constrained mesh
    std::array<VertexIndex, 2> split_; // the ends of the fixed edge that is split, or none
    Fixed split_kind_ = Fixed::no;
};

template <> class Cavity<3> : CavityInside<3> {
public:
    explicit Cavity(Delaunay<3> &mesh);

    void find(const Point<3> &p, Handle first);
    void fill(VertexIndex v);
    void give_up();

private:
    /// A facet of a tetrahedron inside, which sees its corners s, t, u counterclockwise.
    /// These are numbers of corners; those of its edges st, su, tu are numbers of cross
    /// products.
    struct Facet {
        Link inner;
        std::array<std::uint8_t, 3> slot; // of the corners in the tetrahedron
        std::int8_t sign;                 // -1: the first cross product is that of ts
        std::array<std::uint32_t, 3> corner, edge;
    };
    struct RimFacet {
        Link outer;
        std::uint32_t facet;
    };

    /// A tetrahedron beyond a facet.
    struct Beyond {
        Link outer;
        std::uint32_t facet;
        VertexIndex vertex; // the one opposite the facet
        InSphere test;
        SeenPoint<3> apex; // that vertex
    };
    /// The tetrahedra that are tested together.
    struct Batch {
        static constexpr std::size_t most = 8;
        std::size_t size;
        std::size_t entered;
        std::array<Beyond, most> beyond;
        std::array<std::uint32_t, most> to_enter; // of them, those newly found inside
    };

    void begin(const Point<3> &p, Handle first);
    /// Gathers the tetrahedra beyond the facets from `at` on that are not known to be inside;
    /// returns the number of facets.
    std::size_t look_beyond(std::size_t at, Batch &batch);
    /// The same links, where pages have to be loaded; loading may number their
    /// vertices.
    [[gnu::noinline]] void load_beyond(std::size_t at, std::size_t facets, Link *outer);
    void test(Batch &batch, const Point<3> &p);
    /// Decides the uncertain tests.
    [[gnu::noinline]] void test_exactly(Batch &batch, const Point<3> &p);
    /// Marks the tetrahedra; those outside go to the rim, the others will be entered.
    void sort_out(Batch &batch);
    /// Adds a tetrahedron that is inside, with its other three facets.
    void enter(const Beyond &beyond);
    std::uint32_t add_corner(VertexIndex v, const SeenPoint<3> &point);
    void make_room();
    LiftedPlane plane(const Facet &facet) const;
    bool is_exactly_inside(Handle h, const Point<3> &p) const;
    /// The new tetrahedron on a facet of the rim; it enters its ridges in the table.
    template <class View>
    Handle create(const RimFacet &rim, VertexIndex v, std::uint64_t code, const View &ridges);

    typename VertexHeap<3>::Numbering corners_;
    Arena<SeenPoint<3>> seen_;   // of the corners
    Arena<std::uint64_t> codes_; // also of these
    Arena<Cross> edges_;
    Arena<Facet> facets_; // in the order in which they are crossed
    Arena<RimFacet> rim_;
    Arena<Handle> created_;
    Ridges ridges_;
};

} // namespace abacus
