// Outlines, compared with brute force over all simplices.
#include "geometry/ball.hpp"
#include "geometry/circumradius.hpp"
#include "geometry/distance.hpp"
#include "support/extents.hpp"
#include "support/point_sets.hpp"
#include "support/sanitized.hpp"
#include "support/triangulations.hpp"

#include <CGAL/Alpha_shape_2.h>
#include <CGAL/Alpha_shape_3.h>
#include <CGAL/Alpha_shape_cell_base_3.h>
#include <CGAL/Alpha_shape_face_base_2.h>
#include <CGAL/Alpha_shape_vertex_base_2.h>
#include <CGAL/Alpha_shape_vertex_base_3.h>
#include <CGAL/Delaunay_triangulation_2.h>
#include <CGAL/Delaunay_triangulation_3.h>
#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>

#include <abacus/shapes.h>
#include <gtest/gtest.h>

#include <map>
#include <set>

namespace abacus::test {
namespace {

constexpr std::size_t little = 4 << 10;

template <int D> using Facet = std::array<Point<D>, D>; ///< oriented, the least corner first
using Row = abacus_outline_row;

abacus_host_status keep(void *context, const Row *row) {
    static_cast<std::vector<Row> *>(context)->push_back(*row);
    return ABACUS_HOST_OK;
}

template <int D>
std::vector<Row> read(MeshOf<D> &mesh, const abacus_outline_kind &kind, std::size_t memory) {
    std::vector<Row> rows;
    abacus_error error{};
    EXPECT_EQ(abacus_outline(mesh.host.table(), &mesh.header.facts, &kind, memory, memory, keep,
                             &rows, &error),
              ABACUS_OK)
        << error.message;
    EXPECT_EQ(mesh.host.violations, std::vector<std::string>{});
    EXPECT_EQ(mesh.host.bytes, 0u);
    return rows;
}

template <int D> Facet<D> normal(Facet<D> facet) {
    if (D == 3)
        std::rotate(facet.begin(), std::min_element(facet.begin(), facet.end()), facet.end());
    return facet;
}

/// Facets of the rings; in the plane, their edges.
template <int D> std::multiset<Facet<D>> facets_of(const std::vector<Row> &rows) {
    std::map<std::uint64_t, std::vector<Point<D>>> rings;
    for (const Row &row : rows) {
        auto &ring = rings[row.ring];
        EXPECT_EQ(row.position, ring.size() + 1);
        Point<D> p;
        std::copy_n(row.point, D, p.begin());
        EXPECT_TRUE(ring.empty() || ring[0] < p) << "it does not begin with the least, or repeats";
        ring.push_back(p);
    }
    std::multiset<Facet<D>> facets;
    Point<D> before{};
    for (const auto &[number, ring] : rings) {
        EXPECT_EQ(std::set<Point<D>>(ring.begin(), ring.end()).size(), ring.size());
        EXPECT_TRUE(number == 1 || !(ring[0] < before));
        before = ring[0];
        if constexpr (D == 3)
            facets.insert({ring[0], ring[1], ring[2]});
        else
            for (std::size_t i = 0; i < ring.size(); ++i)
                facets.insert({ring[i], ring[(i + 1) % ring.size()]});
    }
    return facets;
}

template <int D>
std::multiset<Facet<D>> border_by_hand(MeshOf<D> &mesh, const abacus_outline_kind &kind) {
    std::map<std::set<Point<D>>, std::vector<Facet<D>>> around;
    for (const abacus_simplex &s : mesh.simplices(false)) {
        std::array<Point<D>, D + 1> points;
        Corners<D> corners;
        for (int i = 0; i <= D; ++i) {
            std::copy_n(s.corner[i], D, points[i].begin());
            corners[i] = &points[i];
        }
        bool is_kept = kind.has_alpha == 0 || has_circumsphere_within<D>(corners, kind.alpha);
        for (int i = 0; i <= D && kind.extent.max_edge > 0; ++i)
            for (int j = 0; j < i; ++j)
                is_kept = is_kept && is_within<D>(kind.extent.max_edge, points[i], points[j]);
        if (!is_kept) continue;
        for (int left_out = 0; left_out <= D; ++left_out) {
            Facet<D> facet;
            for (int i = 0, n = 0; i <= D; ++i)
                if (i != left_out) facet[n++] = points[i];
            if (left_out % 2 == 1) std::swap(facet[0], facet[1]);
            around[{facet.begin(), facet.end()}].push_back(normal<D>(facet));
        }
    }
    std::multiset<Facet<D>> border;
    for (const auto &[corners, facets] : around)
        if (facets.size() == 1) border.insert(facets[0]);
    return border;
}

template <int D> void expect_outlines(MeshOf<D> &mesh, std::initializer_list<double> sizes) {
    for (const double size : sizes) {
        SCOPED_TRACE(size);
        std::vector<abacus_outline_kind> kinds{{up_to(size), 0, 0, 0}};
        if (mesh.header.facts.standing == 0) kinds.push_back({{}, 1, size * size, 0});
        for (const abacus_outline_kind &kind : kinds) {
            const auto expected = border_by_hand<D>(mesh, kind);
            EXPECT_TRUE(facets_of<D>(read<D>(mesh, kind, little)) == expected);
            EXPECT_TRUE(facets_of<D>(read<D>(mesh, kind, 16 << 20)) == expected);
        }
    }
}

template <int D> void expect_outlines_of_sets() {
    const std::size_t most = D == 2 ? 300 : sanitized ? 30 : 60;
    Random random(2);
    for (const PointSet<D> &set : point_sets<D>()) {
        SCOPED_TRACE(set.name);
        auto points = set.points(random);
        if (points.size() > most) points.resize(most);
        for (Point<D> &p : points)
            for (double &x : p) x += 0.0;
        MeshOf<D> mesh(0);
        ASSERT_EQ(mesh.stage(number<D>(points)), ABACUS_OK);
        ASSERT_EQ(mesh.build(), ABACUS_OK) << mesh.error.message;
        const double size = std::min(1e150, distance<D>(points[0], points[1]));
        expect_outlines<D>(mesh, {0, size / 8, size / 3, size});
    }
}

TEST(Outlines, OfSetsInThePlane) { expect_outlines_of_sets<2>(); }
TEST(Outlines, OfSetsInSpace) { expect_outlines_of_sets<3>(); }

/// Every second cell of a grid: parts and holes that meet only in vertices.
template <int D> void expect_outlines_of_pinched(bool is_even) {
    std::vector<Point<D>> grid;
    const int n = D == 2 ? 14 : 5;
    for (int i = 0; i < (D == 2 ? n * n : n * n * n); ++i) {
        Point<D> p{};
        for (int k = 0, rest = i; k < D; ++k, rest /= n) p[k] = rest % n;
        grid.push_back(p);
    }
    const auto t = keeping<D>(delaunay<D>(grid), [&](const Point<D> &c) {
        int sum = 0;
        bool is_rim = false;
        for (const double x : c) {
            sum += static_cast<int>(x);
            is_rim = is_rim || x < 1 || x > n - 2;
        }
        return is_even ? sum % 2 == 0 : is_rim || sum % 2 == 1;
    });
    MeshOf<D> mesh(0);
    ASSERT_EQ(mesh.load(t.vertices, t.simplices), ABACUS_OK) << mesh.error.message;
    ASSERT_NE(mesh.header.facts.standing, 0u);
    expect_outlines<D>(mesh, {0, 1.2, 1.5, 9});
}

TEST(Outlines, OfPartsAndHolesThatTouch) {
    for (const bool is_even : {true, false}) {
        expect_outlines_of_pinched<2>(is_even);
        expect_outlines_of_pinched<3>(is_even);
    }
}

/// Squares within squares, each with a hole: only the outermost one is kept.
TEST(Outlines, WithoutHolesAndWhatLiesInThem) {
    std::vector<Point<2>> points;
    for (int x = -33; x <= 33; ++x)
        for (int y = -33; y <= 33; ++y) {
            const int ring = std::max(std::abs(x), std::abs(y));
            if (ring % 10 < 4) points.push_back({double(x), double(y)});
        }
    for (int x = 60; x < 66; ++x)
        for (int y = 0; y < 6; ++y) points.push_back({double(x), double(y)});
    MeshOf<2> mesh(0);
    ASSERT_EQ(mesh.stage(number<2>(points)), ABACUS_OK);
    ASSERT_EQ(mesh.build(), ABACUS_OK);
    const auto with = read<2>(mesh, {{}, 1, 0.5, 0}, little);
    EXPECT_EQ(with.back().ring, 8u); // four squares, three of them with a hole, and one elsewhere
    const auto without = read<2>(mesh, {{}, 1, 0.5, 1}, little);
    ASSERT_EQ(without.back().ring, 2u);
    EXPECT_EQ(without.size(), 4u * 66 + 4 * 5);
}

/// Shells within shells: only the outermost surface is kept, and those elsewhere.
TEST(Outlines, WithoutCavitiesAndWhatLiesInThem) {
    std::vector<Point<3>> points;
    for (int x = -5; x <= 5; ++x)
        for (int y = -5; y <= 5; ++y)
            for (int z = -5; z <= 5; ++z)
                if (std::max({std::abs(x), std::abs(y), std::abs(z)}) % 4 < 2)
                    points.push_back({double(x), double(y), double(z)});
    for (int i = 0; i < 27; ++i) points.push_back({20.0 + i % 3, double(i / 3 % 3), double(i / 9)});
    MeshOf<3> mesh(0);
    ASSERT_EQ(mesh.stage(number<3>(points)), ABACUS_OK);
    ASSERT_EQ(mesh.build(), ABACUS_OK);
    const auto with = facets_of<3>(read<3>(mesh, {{}, 1, 0.75, 0}, little));
    const auto without = facets_of<3>(read<3>(mesh, {{}, 1, 0.75, 1}, little));
    EXPECT_TRUE(without == facets_of<3>(read<3>(mesh, {{}, 1, 0.75, 1}, 16 << 20)));
    EXPECT_EQ(without.size(), 2u * 6 * (10 * 10 + 2 * 2)); // of the cube and of the one elsewhere
    EXPECT_GT(with.size(), without.size() + 2 * 6 * 2 * 2);
    EXPECT_TRUE(std::includes(with.begin(), with.end(), without.begin(), without.end()));
}

TEST(Outlines, OfWhatIsAsFarAwayAsCanBe) {
    constexpr double far = std::numeric_limits<double>::lowest();
    std::vector<Point<2>> flat{{far, far}};
    std::vector<Point<3>> solid{{far, far, far}};
    for (int i = 0; i < 100; ++i) {
        flat.push_back({double(i % 10), double(i / 10)});
        solid.push_back({double(i % 5), double(i / 5 % 5), double(i / 25)});
    }
    MeshOf<2> plane(0);
    ASSERT_EQ(plane.stage(number<2>(flat)), ABACUS_OK);
    ASSERT_EQ(plane.build(), ABACUS_OK) << plane.error.message;
    expect_outlines<2>(plane, {0});
    MeshOf<3> space(0);
    ASSERT_EQ(space.stage(number<3>(solid)), ABACUS_OK);
    ASSERT_EQ(space.build(), ABACUS_OK) << space.error.message;
    expect_outlines<3>(space, {0});
}

using Kernel = CGAL::Exact_predicates_inexact_constructions_kernel;
template <int D> using Sides = std::set<std::set<Point<D>>>;

/// CGAL's regularized alpha shape: its facets.
Sides<2> cgal_alpha_shape(const std::vector<Point<2>> &points, double alpha) {
    using Structure = CGAL::Triangulation_data_structure_2<CGAL::Alpha_shape_vertex_base_2<Kernel>,
                                                           CGAL::Alpha_shape_face_base_2<Kernel>>;
    using Shape = CGAL::Alpha_shape_2<CGAL::Delaunay_triangulation_2<Kernel, Structure>>;
    std::vector<Kernel::Point_2> input;
    for (const Point<2> &p : points) input.emplace_back(p[0], p[1]);
    const Shape shape(input.begin(), input.end(), alpha, Shape::REGULARIZED);
    Sides<2> sides;
    for (auto edge = shape.alpha_shape_edges_begin(); edge != shape.alpha_shape_edges_end();
         ++edge) {
        const Kernel::Segment_2 s = shape.segment(*edge);
        const Point<2> from{s.source().x(), s.source().y()}, to{s.target().x(), s.target().y()};
        sides.insert(std::set<Point<2>>{from, to});
    }
    return sides;
}

Sides<3> cgal_alpha_shape(const std::vector<Point<3>> &points, double alpha) {
    using Structure = CGAL::Triangulation_data_structure_3<CGAL::Alpha_shape_vertex_base_3<Kernel>,
                                                           CGAL::Alpha_shape_cell_base_3<Kernel>>;
    using Shape = CGAL::Alpha_shape_3<CGAL::Delaunay_triangulation_3<Kernel, Structure>>;
    std::vector<Kernel::Point_3> input;
    for (const Point<3> &p : points) input.emplace_back(p[0], p[1], p[2]);
    const Shape shape(input.begin(), input.end(), alpha, Shape::REGULARIZED);
    std::vector<Shape::Facet> facets;
    shape.get_alpha_shape_facets(std::back_inserter(facets), Shape::REGULAR);
    Sides<3> sides;
    for (const auto &[cell, left_out] : facets) {
        std::set<Point<3>> side;
        for (int i = 0; i < 4; ++i) {
            const Kernel::Point_3 &p = cell->vertex(i)->point();
            if (i != left_out) side.insert({p.x(), p.y(), p.z()});
        }
        sides.insert(side);
    }
    return sides;
}

template <int D> void expect_alpha_shapes_of_cgal() {
    Random random(6);
    std::vector<Point<D>> points(600);
    for (Point<D> &p : points)
        for (double &x : p) x = unit(random);
    MeshOf<D> mesh(0);
    ASSERT_EQ(mesh.stage(number<D>(points)), ABACUS_OK);
    ASSERT_EQ(mesh.build(), ABACUS_OK);
    for (const double alpha : {0.0004, 0.002, 0.006, 0.02, 1.0}) {
        Sides<D> sides;
        for (const Facet<D> &facet : facets_of<D>(read<D>(mesh, {{}, 1, alpha, 0}, little)))
            sides.insert(std::set<Point<D>>(facet.begin(), facet.end()));
        EXPECT_FALSE(alpha > 0.001 && sides.empty());
        EXPECT_TRUE(sides == cgal_alpha_shape(points, alpha)) << alpha;
    }
}

TEST(Outlines, AreAlphaShapesOfCgal) {
    expect_alpha_shapes_of_cgal<2>();
    expect_alpha_shapes_of_cgal<3>();
}

TEST(Circumradius, IsComparedExactly) {
    Random random(3);
    for (int i = 0; i < 200; ++i) {
        // Exactly on a circle of radius 5 around a corner of a grid.
        const double x = std::ldexp(double(random() % 1000), -10), y = double(random() % 100);
        const Point<2> a{x + 5, y}, b{x - 3, y + 4}, c{x - 4, y - 3};
        const Corners<2> corners{&a, &b, &c};
        EXPECT_TRUE(has_circumsphere_within<2>(corners, 25));
        EXPECT_FALSE(has_circumsphere_within<2>(corners, std::nextafter(25, 0)));
        EXPECT_TRUE(has_circumsphere_within<2>(corners, 26));
        EXPECT_FALSE(has_circumsphere_within<2>(corners, 24));
    }
}

} // namespace
} // namespace abacus::test
