// Minimum spanning trees, compared with Kruskal's algorithm over all pairs of points, and the order
// of lengths, compared with rational numbers.
#include "geometry/distance.hpp"
#include "query/shapes/length_key.hpp"
#include "support/oracle.hpp"
#include "support/point_sets.hpp"

#include <CGAL/Exact_rational.h>

#include <abacus/shapes.h>
#include <gtest/gtest.h>

#include <numeric>
#include <set>

namespace abacus::test {
namespace {

using Rational = CGAL::Exact_rational;
using Ends = std::pair<std::int64_t, std::int64_t>;

template <int D> Rational square(const Point<D> &a, const Point<D> &b) {
    Rational sum = 0;
    for (int i = 0; i < D; ++i) {
        const Rational edge = Rational(b[i]) - Rational(a[i]);
        sum += edge * edge;
    }
    return sum;
}

abacus_host_status keep(void *context, const abacus_edge *edge) {
    static_cast<std::vector<abacus_edge> *>(context)->push_back(*edge);
    return ABACUS_HOST_OK;
}

template <int D> std::vector<Ends> read(MeshOf<D> &mesh, std::size_t memory) {
    std::vector<abacus_edge> edges;
    abacus_error error{};
    EXPECT_EQ(abacus_spanning_tree(mesh.host.table(), &mesh.header.facts, memory, 1 << 10, keep,
                                   &edges, &error),
              ABACUS_OK)
        << error.message;
    EXPECT_EQ(mesh.host.violations, std::vector<std::string>{});
    EXPECT_EQ(mesh.host.bytes, 0u);
    std::vector<Ends> ends;
    double before = 0;
    for (const abacus_edge &edge : edges) {
        EXPECT_LE(before, edge.length);
        EXPECT_LT(edge.id[0], edge.id[1]);
        before = edge.length;
        ends.push_back({edge.id[0], edge.id[1]});
    }
    return ends;
}

template <int D> std::vector<Ends> by_hand(const std::vector<InputOf<D>> &points) {
    struct Edge {
        Rational square;
        Point<D> a, b;
        std::size_t i, j;
        bool operator<(const Edge &other) const {
            if (square != other.square) return square < other.square;
            return std::pair(a, b) < std::pair(other.a, other.b);
        }
    };
    std::vector<Edge> edges;
    for (std::size_t i = 0; i < points.size(); ++i)
        for (std::size_t j = 0; j < i; ++j) {
            const auto &[a, b] = std::minmax(points[i].point, points[j].point);
            edges.push_back({square<D>(a, b), a, b, i, j});
        }
    std::sort(edges.begin(), edges.end());
    std::vector<std::size_t> part(points.size());
    std::iota(part.begin(), part.end(), std::size_t{0});
    std::vector<Ends> tree;
    for (const Edge &edge : edges) {
        const std::size_t from = part[edge.i], to = part[edge.j];
        if (from == to) continue;
        std::replace(part.begin(), part.end(), from, to);
        tree.push_back(std::minmax(points[edge.i].id, points[edge.j].id));
    }
    return tree;
}

template <int D> void expect_trees() {
    Random random(4);
    for (const PointSet<D> &set : point_sets<D>()) {
        SCOPED_TRACE(set.name);
        auto points = set.points(random);
        if (points.size() > 150) points.resize(150);
        for (Point<D> &p : points)
            for (double &x : p) x += 0.0;
        std::sort(points.begin(), points.end());
        points.erase(std::unique(points.begin(), points.end()), points.end());
        const auto input = number<D>(points);
        MeshOf<D> mesh(0);
        ASSERT_EQ(mesh.stage(input), ABACUS_OK);
        ASSERT_EQ(mesh.build(), ABACUS_OK) << mesh.error.message;
        if (mesh.header.facts.census.simplices == 0) continue;
        const auto expected = by_hand<D>(input);
        EXPECT_TRUE(read<D>(mesh, 16 << 20) == expected);
        for (const std::size_t vertices : {32, 100}) // in one pass
            EXPECT_TRUE(read<D>(mesh, vertices * 64) == expected) << vertices;
    }
}

TEST(SpanningTree, InThePlane) { expect_trees<2>(); }
TEST(SpanningTree, InSpace) { expect_trees<3>(); }

TEST(LengthKey, HasTheOrderOfLengths) {
    Random random(5);
    std::vector<std::pair<Point<3>, Point<3>>> edges;
    for (int i = 0; i < 300; ++i) {
        Point<3> a{}, b{};
        for (int axis = 0; axis < 3; ++axis) {
            a[axis] = i % 3 == 0 ? double(random() % 4) * 0.1 : unit(random) * (1 + 1e6 * (i % 2));
            b[axis] = i % 3 == 0 ? a[axis] + double(random() % 4) * 0.1
                                 : a[axis] + std::ldexp(unit(random), -int(random() % 60));
        }
        edges.push_back({a, b});
        edges.push_back({b, a});
        edges.push_back({{a[1], a[0], a[2]}, {b[1], b[0], b[2]}});
        if (b[0] != 0) b[0] = std::nextafter(b[0], 9); // next to 0, the square is lost
        edges.push_back({a, b});
    }
    std::erase_if(edges, [](const auto &e) { return e.first == e.second; });
    std::vector<std::pair<Rational, LengthKey>> lengths;
    for (const auto &e : edges)
        lengths.push_back({square<3>(e.first, e.second), length_key<3>(e.first, e.second)});
    std::sort(lengths.begin(), lengths.end());
    for (std::size_t i = 1; i < lengths.size(); ++i) {
        const auto &[x, one] = lengths[i - 1];
        const auto &[y, other] = lengths[i];
        ASSERT_EQ(one < other, x < y);
        ASSERT_EQ(one == other, x == y);
        ASSERT_LE(length_of(one), length_of(other));
    }
    EXPECT_EQ(length_of(length_key<2>({0, 0}, {3, 4})), 5);
    EXPECT_EQ(length_of(length_key<2>({-1e308, 0}, {1e308, 0})), INFINITY);
    EXPECT_EQ(length_of(length_key<2>({0, 0}, {3 * 5e-324, 4 * 5e-324})), 5 * 5e-324);
}

} // namespace
} // namespace abacus::test
