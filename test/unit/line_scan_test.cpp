// The simplices along a line, compared with brute force in rational numbers over all simplices: in
// every kind of mesh, for lines through vertices, along edges and in facets, from inside and
// outside.
#include "query/lines/line_scan.hpp"
#include "support/containment.hpp"
#include "support/lattice.hpp"
#include "support/point_sets.hpp"
#include "support/sanitized.hpp"
#include "support/triangulations.hpp"

#include <CGAL/Exact_rational.h>

#include <gtest/gtest.h>

#include <map>

namespace abacus::test {
namespace {

using Rational = CGAL::Exact_rational;
constexpr std::size_t little = 60 << 10, ample = 64 << 20;

template <int D> using Vector = std::array<Rational, D>;

template <int D> Vector<D> exactly(const double *p) {
    Vector<D> v;
    for (int i = 0; i < D; ++i) v[i] = p[i];
    return v;
}

/// The determinant of D vectors.
Rational determinant(const std::array<Vector<2>, 2> &m) {
    return m[0][0] * m[1][1] - m[0][1] * m[1][0];
}
Rational determinant(const std::array<Vector<3>, 3> &m) {
    Rational sum = 0;
    for (int i = 0; i < 3; ++i) {
        const auto &a = m[(i + 1) % 3], &b = m[(i + 2) % 3];
        sum += m[i][0] * (a[1] * b[2] - a[2] * b[1]);
    }
    return sum;
}

/// How far a place is on the inner side of a facet, times a factor of the facet.
template <int D> Rational height(const abacus_simplex &s, int facet, const Vector<D> &p) {
    std::array<Vector<D>, D> m;
    const int origin = facet == 0 ? 1 : 0;
    const Vector<D> o = exactly<D>(s.corner[origin]);
    int n = 0;
    for (int i = 0; i <= D; ++i) {
        if (i == origin) continue;
        const Vector<D> v = i == facet ? p : exactly<D>(s.corner[i]);
        for (int k = 0; k < D; ++k) m[n][k] = v[k] - o[k];
        ++n;
    }
    const Rational value = determinant(m);
    return origin % 2 == 0 ? value : -value;
}

struct Found {
    Rational enters, leaves;
    abacus_simplex simplex;
};

template <int D>
std::optional<Found> clip(const abacus_simplex &s, const Line<D> &line, const Rational &end,
                          bool has_end) {
    const Vector<D> from = exactly<D>(line.from.data());
    Vector<D> to;
    for (int k = 0; k < D; ++k)
        to[k] = line.to ? Rational((*line.to)[k]) : from[k] + Rational(line.direction[k]);
    Rational least = 0, greatest = end;
    bool is_bounded = has_end;
    for (int facet = 0; facet <= D; ++facet) {
        const Rational at_from = height<D>(s, facet, from), at_to = height<D>(s, facet, to);
        const Rational slope = at_to - at_from;
        if (slope == 0) {
            if (at_from < 0) return std::nullopt;
            continue;
        }
        const Rational at = -at_from / slope;
        if (slope > 0)
            least = std::max(least, at);
        else if (!is_bounded || at < greatest) {
            greatest = at;
            is_bounded = true;
        }
    }
    if (!(least < greatest)) return std::nullopt;
    return Found{least, greatest, s};
}

template <int D>
std::vector<Found> brute_force(const std::vector<abacus_simplex> &all, const Line<D> &line) {
    std::map<Rational, Found> found;
    for (const abacus_simplex &s : all) {
        const auto piece = clip<D>(s, line, 1, line.to.has_value());
        if (!piece) continue;
        const auto [other, is_new] = found.emplace(piece->enters, *piece);
        if (is_new) continue;
        EXPECT_EQ(other->second.leaves, piece->leaves);
        if (rank<D>(s) < rank<D>(other->second.simplex)) other->second = *piece;
    }
    std::vector<Found> result;
    for (const auto &[enters, piece] : found) result.push_back(piece);
    return result;
}

void expect_near(double value, const Rational &exact) {
    const double expected = CGAL::to_double(exact);
    if (std::isinf(expected)) // beyond the range of doubles
        ASSERT_EQ(value, expected);
    else
        ASSERT_NEAR(value, expected, 1e-9 * std::max(1.0, std::abs(expected)));
}

template <int D>
void expect_pieces(Reader<D> &reader, const Line<D> &line, const std::vector<Found> &expected) {
    std::vector<LinePiece<D>> pieces;
    try {
        LineScan<D>(reader, line).each([&](const LinePiece<D> &piece) {
            pieces.push_back(piece);
            return true;
        });
    } catch (const Error &error) {
        FAIL() << error.what() << ": " << error.detail;
    }
    ASSERT_EQ(pieces.size(), expected.size());
    double before = 0;
    for (std::size_t i = 0; i < pieces.size(); ++i) {
        SCOPED_TRACE(i);
        const LinePiece<D> &piece = pieces[i];
        ASSERT_EQ(rank<D>(piece.simplex), rank<D>(expected[i].simplex));
        expect_near(piece.enters.at, expected[i].enters);
        expect_near(piece.leaves.at, expected[i].leaves);
        ASSERT_LE(before, piece.enters.at);
        ASSERT_LE(piece.enters.at, piece.leaves.at);
        before = piece.leaves.at;
        ASSERT_EQ(piece.follows, i > 0 && expected[i].enters == expected[i - 1].leaves);
        ASSERT_EQ(piece.enters.is_end, expected[i].enters == 0);
        ASSERT_EQ(piece.leaves.is_end, line.to.has_value() && expected[i].leaves == 1);
    }
}

/// Lines between vertices, along edges, between arbitrary places, on the lattice, far away.
template <int D>
std::vector<Line<D>> lines(const std::vector<Point<D>> &points,
                           const std::vector<abacus_simplex> &all, Random &random, int rounds) {
    std::vector<Line<D>> result;
    const auto add = [&](const Point<D> &a, const Point<D> &b) {
        Point<D> direction, longer;
        bool is_point = true, is_finite = true;
        for (int k = 0; k < D; ++k) {
            direction[k] = b[k] - a[k];
            longer[k] = a[k] - direction[k];
            is_point &= direction[k] == 0;
            is_finite &= std::isfinite(direction[k]) && std::isfinite(longer[k]);
        }
        if (is_point || !is_finite) return;
        result.push_back(Line<D>::between(a, b));
        result.push_back(Line<D>::towards(a, direction));
        result.push_back(Line<D>::towards(longer, direction));
        if (!(longer == b)) result.push_back(Line<D>::between(longer, b));
    };
    for (int i = 0; i < rounds; ++i) {
        const Point<D> &a = points[random() % points.size()], &b = points[random() % points.size()];
        add(a, b);
        Point<D> middle, beside, axis = a, far;
        for (int k = 0; k < D; ++k) {
            middle[k] = a[k] * 0.5 + b[k] * 0.5;
            beside[k] = middle[k] * (1 + 0.1 * unit(random));
            far[k] = (a[k] - b[k]) * 3;
            if (!std::isfinite(far[k])) far[k] = b[k];
        }
        axis[random() % D] = b[random() % D];
        add(middle, beside);
        add(beside, a);
        add(far, middle);
        add(a, axis);
        add(axis, a);
        if (all.empty()) continue;
        const abacus_simplex &s = all[random() % all.size()];
        Point<D> p, q;
        std::copy_n(s.corner[random() % 2], D, p.begin());
        std::copy_n(s.corner[2], D, q.begin());
        add(p, q);
        if (D == 3) { // in a facet
            for (int k = 0; k < D; ++k) q[k] = q[k] * 0.5 + s.corner[3][k] * 0.5;
            add(p, q);
        }
    }
    return result;
}

template <int D>
void expect_lines(MeshOf<D> &mesh, const std::vector<Point<D>> &points, int rounds) {
    Random random(5);
    const Host host = mesh.host.host();
    const std::vector<abacus_simplex> all = mesh.simplices(false);
    Reader<D> cached(host, mesh.header, ample), reading(host, mesh.header, little);
    for (const Line<D> &line : lines<D>(points, all, random, sanitized ? 1 : rounds)) {
        const std::vector<Found> expected = brute_force<D>(all, line);
        for (Reader<D> *reader : {&cached, &reading}) {
            expect_pieces<D>(*reader, line, expected);
            ASSERT_EQ(reader->cache().check_invariants(), nullptr);
            if (testing::Test::HasFatalFailure()) return;
        }
    }
}

template <int D> void expect_lines_of_sets() {
    Random random(1);
    for (const PointSet<D> &set : point_sets<D>()) {
        SCOPED_TRACE(set.name);
        auto points = set.points(random);
        if (points.size() > (D == 2 ? 60 : 20)) points.resize(D == 2 ? 60 : 20);
        for (Point<D> &p : points)
            for (double &x : p) x += 0.0;
        MeshOf<D> mesh(0);
        ASSERT_EQ(mesh.insert(number<D>(points)), ABACUS_OK);
        expect_lines<D>(mesh, points, 5 - D);
        if (testing::Test::HasFatalFailure()) return;
    }
}

TEST(LineScan, EqualsBruteForceInThePlane) { expect_lines_of_sets<2>(); }
TEST(LineScan, EqualsBruteForceInSpace) { expect_lines_of_sets<3>(); }

/// The same simplices in both directions of the line.
template <int D> void expect_reversible() {
    Random random(8);
    for (const PointSet<D> &set : point_sets<D>()) {
        SCOPED_TRACE(set.name);
        auto points = set.points(random);
        if (points.size() > 100) points.resize(100);
        MeshOf<D> mesh(0);
        ASSERT_EQ(mesh.insert(number<D>(points)), ABACUS_OK);
        const Host host = mesh.host.host();
        Reader<D> reader(host, mesh.header, little);
        for (const Line<D> &line : lines<D>(points, mesh.simplices(false), random, 5)) {
            if (!line.to) continue;
            std::vector<decltype(rank<D>(abacus_simplex()))> there, back;
            try {
                LineScan<D>(reader, line).each([&](const LinePiece<D> &piece) {
                    there.push_back(rank<D>(piece.simplex));
                    return true;
                });
                LineScan<D>(reader, Line<D>::between(*line.to, line.from))
                    .each([&](const LinePiece<D> &piece) {
                        back.insert(back.begin(), rank<D>(piece.simplex));
                        return true;
                    });
            } catch (const Error &error) {
                FAIL() << error.what() << ": " << error.detail;
            }
            ASSERT_EQ(there, back);
        }
    }
}

TEST(LineScan, IsTheSameBackwards) {
    expect_reversible<2>();
    expect_reversible<3>();
}

TEST(LineScan, OfGrids) {
    Mesh flat(0);
    ASSERT_EQ(flat.insert(number<2>(grid<2>(25))), ABACUS_OK);
    expect_lines<2>(flat, grid<2>(25), 3);
    MeshOf<3> solid(0);
    ASSERT_EQ(solid.insert(number<3>(grid<3>(5))), ABACUS_OK);
    expect_lines<3>(solid, grid<3>(5), 2);
}

/// Shells of a grid, pinched everywhere, and flipped.
template <int D> void expect_lines_of_loaded() {
    const int n = D == 2 ? 18 : 5;
    const auto full = delaunay<D>(grid<D>(n));
    for (const bool is_pinched : {false, true}) {
        auto t = keeping<D>(full, [&](const Point<D> &c) {
            double square = 0;
            int sum = 0;
            for (const double x : c) {
                square += (x - n / 2.0) * (x - n / 2.0);
                sum += static_cast<int>(x);
            }
            return is_pinched ? sum % 2 == 0 : static_cast<int>(std::sqrt(square)) % 3 != 0;
        });
        if (!is_pinched) flip(t, 100, 3);
        MeshOf<D> mesh(0);
        ASSERT_EQ(mesh.load(t.vertices, t.simplices), ABACUS_OK) << mesh.error.message;
        ASSERT_NE(mesh.header.facts.standing, 0u);
        std::vector<Point<D>> points;
        for (const auto &v : t.vertices) points.push_back(v.point);
        expect_lines<D>(mesh, points, D == 2 ? 3 : 2);
    }
}

TEST(LineScan, LeavesHolesAndComesBack) {
    expect_lines_of_loaded<2>();
    expect_lines_of_loaded<3>();
}

TEST(LineScan, StopsWhenNoMoreIsWanted) {
    Mesh mesh(0);
    ASSERT_EQ(mesh.insert(number<2>(grid<2>(25))), ABACUS_OK);
    const Host host = mesh.host.host();
    Reader<2> reader(host, mesh.header, ample);
    int pieces = 0;
    LineScan<2>(reader, Line<2>::towards({-1, 0.5}, {1, 0.25})).each([&](const LinePiece<2> &) {
        return ++pieces < 3;
    });
    EXPECT_EQ(pieces, 3);
}

TEST(LineScan, OfAnEmptyMeshIsEmpty) {
    Mesh mesh(0);
    ASSERT_EQ(mesh.insert({}), ABACUS_OK);
    const Host host = mesh.host.host();
    Reader<2> reader(host, mesh.header, ample);
    LineScan<2>(reader, Line<2>::towards({0, 0}, {1, 0})).each([&](const LinePiece<2> &) {
        ADD_FAILURE();
        return true;
    });
}

TEST(LineScan, ReadsPagesInProportionToTheAnswer) {
    for (const bool is_delaunay : {true, false}) {
        Random random(9);
        std::vector<Point<2>> points(20000);
        for (auto &p : points) p = {unit(random), unit(random)};
        Mesh mesh(0);
        if (is_delaunay) {
            ASSERT_EQ(mesh.insert(number<2>(points)), ABACUS_OK);
        } else {
            const auto t = keeping<2>(delaunay<2>(points), [](const Point<2> &c) {
                return std::hypot(c[0] - 0.5, c[1] - 0.5) > 0.2;
            });
            ASSERT_EQ(mesh.load(t.vertices, t.simplices), ABACUS_OK) << mesh.error.message;
        }
        const Host host = mesh.host.host();
        Reader<2> reader(host, mesh.header, ample);
        if (!is_delaunay) reader.boxes(); // made once
        const std::uint64_t before = reader.pages_read();
        LineScan<2>(reader, Line<2>::between({-1, 0.41}, {2, 0.43})).each([](const auto &) {
            return true;
        });
        const std::uint64_t all = mesh.host.pages.size();
        EXPECT_LT(reader.pages_read() - before, all / 3) << all;
    }
}

} // namespace
} // namespace abacus::test
