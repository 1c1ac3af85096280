// Walks, floods and stars over one of CGAL's triangulations: their results do not depend on the
// cache.
#include "traverse/flood.hpp"
#include "traverse/walk.hpp"

#include "support/memory_host.hpp"
#include "support/point_sets.hpp"

#include <CGAL/Delaunay_triangulation_2.h>
#include <CGAL/Delaunay_triangulation_3.h>
#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>

#include <gtest/gtest.h>

#include <algorithm>
#include <map>
#include <numeric>
#include <set>
#include <vector>

namespace abacus::test {
namespace {

using Kernel = CGAL::Exact_predicates_inexact_constructions_kernel;

/// The same names in both dimensions for CGAL's types.
template <int D> struct Cgal;
template <> struct Cgal<2> {
    using Triangulation = CGAL::Delaunay_triangulation_2<Kernel>;
    using Cell = Triangulation::Face_handle;
    static Kernel::Point_2 point(const Point<2> &p) { return {p[0], p[1]}; }
    static auto cells(const Triangulation &t) { return t.all_face_handles(); }
};
template <> struct Cgal<3> {
    using Triangulation = CGAL::Delaunay_triangulation_3<Kernel>;
    using Cell = Triangulation::Cell_handle;
    static Kernel::Point_3 point(const Point<3> &p) { return {p[0], p[1], p[2]}; }
    static auto cells(const Triangulation &t) { return t.all_cell_handles(); }
};

/// A topology copied from CGAL's.
template <int D> class Copied {
public:
    explicit Copied(const std::vector<Point<D>> &points) {
        typename Cgal<D>::Triangulation mesh;
        for (const Point<D> &p : points) mesh.insert(Cgal<D>::point(p));
        std::map<typename Cgal<D>::Triangulation::Vertex_handle, VertexIndex> numbers;
        points_.push_back({});
        for (auto v : mesh.finite_vertex_handles()) {
            numbers[v] = static_cast<VertexIndex>(points_.size());
            Point<D> p;
            for (int i = 0; i < D; ++i) p[i] = v->point()[i];
            points_.push_back(p);
        }
        numbers[mesh.infinite_vertex()] = infinite_vertex;
        std::map<typename Cgal<D>::Cell, Handle> handles;
        for (auto cell : Cgal<D>::cells(mesh)) {
            handles[cell] = static_cast<Handle>(simplices_.size());
            Simplex<D> s{};
            const auto places = order(mesh, cell);
            for (int i = 0; i <= D; ++i) s.vertex[i] = numbers.at(cell->vertex(places[i]));
            simplices_.push_back(s);
        }
        for (auto cell : Cgal<D>::cells(mesh)) {
            const auto places = order(mesh, cell);
            for (int i = 0; i <= D; ++i) {
                const auto beyond = cell->neighbor(places[i]);
                const auto there = order(mesh, beyond);
                int facet = 0;
                while (beyond->neighbor(there[facet]) != cell) ++facet;
                simplices_[to_number(handles[cell])].link[i] = make_link(handles[beyond], facet);
            }
        }
    }

    const Simplex<D> &simplex(Handle h) const { return simplices_[to_number(h)]; }
    const Point<D> &point(VertexIndex v) const { return points_[to_number(v)]; }
    Link cross(Handle h, int facet) { return simplices_[to_number(h)].link[facet]; }
    void poll() {}

    std::size_t size() const { return simplices_.size(); }
    std::vector<Handle> handles() const {
        std::vector<Handle> handles;
        for (std::uint32_t n = 0; n < simplices_.size(); ++n) handles.push_back(Handle{n});
        return handles;
    }
    std::size_t vertices() const { return points_.size(); }

private:
    /// The corners in an even order with the point at infinity last.
    template <class Mesh, class Cell>
    static std::array<int, D + 1> order(const Mesh &mesh, Cell cell) {
        std::array<int, D + 1> places;
        std::iota(places.begin(), places.end(), 0);
        const bool ghost = mesh.is_infinite(cell);
        while (!is_even(places) || (ghost && !mesh.is_infinite(cell->vertex(places[D]))))
            std::next_permutation(places.begin(), places.end());
        return places;
    }

    std::vector<Point<D>> points_;
    std::vector<Simplex<D>> simplices_;
};

template <int D> std::vector<Point<D>> some_points(Random &random) {
    std::vector<Point<D>> points(300);
    for (Point<D> &p : points)
        for (double &x : p) x = unit(random);
    return points;
}

template <int D> void check_stars() {
    Random random(1);
    Copied<D> mesh(some_points<D>(random));
    static_assert(Topology<Copied<D>, D>);
    MemoryHost host;
    Flood<D> flood(host.host());
    std::vector<std::set<Handle>> stars(mesh.vertices());
    for (const Handle h : mesh.handles())
        for (const VertexIndex v : mesh.simplex(h).vertex) stars[to_number(v)].insert(h);
    for (std::uint32_t n = 0; n < mesh.vertices(); ++n) {
        std::set<Handle> met;
        EXPECT_TRUE(flood.around(mesh, *stars[n].begin(), VertexIndex{n},
                                 [&](Handle h) { return met.insert(h).second; }));
        EXPECT_EQ(met, stars[n]);
        EXPECT_EQ(flood.met().size(), met.size());
    }
    // A visitor that has seen enough ends it, and leaves no mark behind.
    int visits = 0;
    EXPECT_FALSE(flood.around(mesh, *stars[1].begin(), VertexIndex{1},
                              [&](Handle) { return ++visits < 2; }));
    EXPECT_EQ(visits, 2);
    visits = 0;
    EXPECT_TRUE(flood.from(
        mesh, Handle{}, [](Handle, int) { return true; }, [&](Handle) { return ++visits > 0; }));
    EXPECT_EQ(static_cast<std::size_t>(visits), mesh.size());
}

template <int D> void check_walks() {
    Random random(2);
    Copied<D> mesh(some_points<D>(random));
    Walk<D, Copied<D>> walk(mesh);
    for (const Point<D> &p : some_points<D>(random)) {
        const Handle end = walk.within(p, mesh.handles()[random() % mesh.size()], mesh.size());
        ASSERT_NE(end, no_handle);
        const Simplex<D> &s = mesh.simplex(end);
        if (s.is_ghost()) { // then it is in no simplex
            for (const Handle h : mesh.handles())
                if (!mesh.simplex(h).is_ghost()) {
                    EXPECT_LT(in_simplex<D>(corners_of(mesh, mesh.simplex(h)), p), 1);
                }
        } else {
            EXPECT_GE(in_simplex<D>(corners_of(mesh, s), p), 0);
        }
    }
}

TEST(Traverse, FindsStarsOfCgal2D) { check_stars<2>(); }
TEST(Traverse, FindsStarsOfCgal3D) { check_stars<3>(); }
TEST(Traverse, WalksOverCgal2D) { check_walks<2>(); }
TEST(Traverse, WalksOverCgal3D) { check_walks<3>(); }

} // namespace
} // namespace abacus::test
