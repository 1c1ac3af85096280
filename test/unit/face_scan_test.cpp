// Vertices and edges of windows, each once: compared with brute force over all simplices.
#include "query/scan/face_scan.hpp"
#include "support/extents.hpp"
#include "support/point_sets.hpp"
#include "support/sanitized.hpp"
#include "support/triangulations.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <set>

namespace abacus::test {
namespace {

template <int D> using Face = std::set<Point<D>>;

template <int D>
std::multiset<Face<D>> read(MeshOf<D> &mesh, const abacus_window &window, int corners,
                            double max_edge) {
    const Host host = mesh.host.host();
    FaceScan<D> scan(host, mesh.header, window, corners, up_to(max_edge), std::size_t{1} << 20);
    std::multiset<Face<D>> found;
    while (scan.advance()) {
        Face<D> face;
        for (int i = 0; i < corners; ++i) face.insert(scan.page().point(scan.vertex(i)));
        found.insert(face);
    }
    return found;
}

template <int D>
std::set<Face<D>> all(const std::vector<abacus_simplex> &simplices, const abacus_window &window,
                      int corners, double max_edge) {
    const Window<D> wanted(window);
    std::set<Face<D>> result;
    for (const abacus_simplex &s : simplices)
        for (int i = 0; i <= D; ++i)
            for (int j = 0; j <= (corners == 1 ? 0 : i - 1); ++j) {
                Point<D> a, b;
                std::copy_n(s.corner[i], D, a.begin());
                std::copy_n(s.corner[corners == 1 ? i : j], D, b.begin());
                if (corners == 1 ? !wanted.contains(a) : !wanted.meets(a, b)) continue;
                if (max_edge > 0 && !is_within<D>(max_edge, a, b)) continue;
                result.insert({a, b});
            }
    return result;
}

template <int D> void expect_faces(MeshOf<D> &mesh, const std::vector<Point<D>> &points) {
    Random random(1);
    const auto simplices = mesh.simplices(false);
    for (int i = 0; i < (sanitized ? 8 : 24); ++i) {
        const Point<D> &a = points[random() % points.size()], &b = points[random() % points.size()];
        abacus_window window{};
        window.kind = i < 2        ? ABACUS_NO_WINDOW
                      : i % 2 == 0 ? ABACUS_BOX_WINDOW
                                   : ABACUS_BALL_WINDOW;
        for (int k = 0; k < D; ++k) {
            window.lower[k] = std::min(a[k], b[k]);
            window.upper[k] = std::max(a[k], b[k]);
            window.center[k] = a[k];
        }
        window.radius = std::min(1e300, distance<D>(a, b) * unit(random));
        const double max_edge = i % 3 == 0 ? 0 : std::min(1e300, distance<D>(a, b) * 0.4);
        for (const int corners : {1, 2}) {
            const auto found = read<D>(mesh, window, corners, max_edge);
            const auto expected = all<D>(simplices, window, corners, corners == 1 ? 0 : max_edge);
            EXPECT_EQ(found.size(), expected.size()) << i;
            EXPECT_TRUE(std::set<Face<D>>(found.begin(), found.end()) == expected) << i;
        }
    }
    EXPECT_EQ(mesh.host.violations, std::vector<std::string>{});
    EXPECT_EQ(mesh.host.bytes, 0u);
}

template <int D> void expect_faces_of_sets() {
    Random random(2);
    for (const PointSet<D> &set : point_sets<D>()) {
        SCOPED_TRACE(set.name);
        auto points = set.points(random);
        constexpr std::size_t most = D == 2 ? 250 : 80;
        if (points.size() > most) points.resize(most);
        for (Point<D> &p : points)
            for (double &x : p) x += 0.0;
        MeshOf<D> mesh(0);
        ASSERT_EQ(mesh.stage(number<D>(points)), ABACUS_OK);
        ASSERT_EQ(mesh.build(), ABACUS_OK) << mesh.error.message;
        expect_faces<D>(mesh, points);
    }
}

TEST(Faces, ComeOnceEachInThePlane) { expect_faces_of_sets<2>(); }
TEST(Faces, ComeOnceEachInSpace) { expect_faces_of_sets<3>(); }

template <int D> void expect_faces_of_pinched() {
    std::vector<Point<D>> grid;
    const int n = D == 2 ? 14 : 5;
    for (int i = 0; i < (D == 2 ? n * n : n * n * n); ++i) {
        Point<D> p{};
        for (int k = 0, rest = i; k < D; ++k, rest /= n) p[k] = rest % n;
        grid.push_back(p);
    }
    const auto t = keeping<D>(delaunay<D>(grid), [](const Point<D> &c) {
        int sum = 0;
        for (const double x : c) sum += static_cast<int>(x);
        return sum % 2 == 0;
    });
    MeshOf<D> mesh(0);
    ASSERT_EQ(mesh.load(t.vertices, t.simplices), ABACUS_OK) << mesh.error.message;
    ASSERT_NE(mesh.header.facts.standing, 0u);
    std::vector<Point<D>> points;
    for (const auto &v : t.vertices) points.push_back(v.point);
    expect_faces<D>(mesh, points);
}

TEST(Faces, OfMeshesPinchedAtVerticesAndEdges) {
    expect_faces_of_pinched<2>();
    expect_faces_of_pinched<3>();
}

/// A value of one of several kinds, mostly near the first coordinate.
double value_of(const Point<2> &p, std::size_t n) {
    constexpr double infinity = std::numeric_limits<double>::infinity();
    const double odd[] = {std::nan(""), 0.0, -0.0, infinity, -infinity, -p[0]};
    return n % 7 < 6 && n % 5 == 0 ? odd[n % 7] : p[0];
}

TEST(Faces, OfARangeOfAnAttribute) {
    constexpr double infinity = std::numeric_limits<double>::infinity();
    const auto points = unit_square_points(20000, 5);
    auto input = number(points);
    for (std::size_t n = 0; n < input.size(); ++n)
        input[n].attributes = {points[n][1], value_of(points[n], n)};
    Mesh mesh(2);
    ASSERT_EQ(mesh.stage(input), ABACUS_OK);
    ASSERT_EQ(mesh.build(), ABACUS_OK);
    const Host host = mesh.host.host();
    abacus_window box{};
    box.kind = ABACUS_BOX_WINDOW;
    box.lower[0] = box.lower[1] = 0.2;
    box.upper[0] = box.upper[1] = 0.4;
    for (const abacus_range &range : {abacus_range{1, 0.25, 0.3},
                                      {1, 0, 0},
                                      {1, -0.0, 0.01},
                                      {1, -1, -0.3},
                                      {1, infinity, infinity},
                                      {1, -infinity, infinity},
                                      {0, 0.5, 0.5001},
                                      {1, 2, 3}})
        for (const abacus_window &window : {abacus_window{}, box}) {
            std::set<std::int64_t> expected;
            std::multiset<std::int64_t> found;
            for (const Input &vertex : input) {
                const double value = vertex.attributes[range.attribute];
                if (range.least <= value && value <= range.greatest &&
                    Window<2>(window).contains(vertex.point))
                    expected.insert(vertex.id);
            }
            FaceScan<2> scan(host, mesh.header, window, range, std::size_t{1} << 20);
            while (scan.advance()) found.insert(scan.page().id(scan.vertex(0)));
            EXPECT_EQ(found.size(), expected.size());
            EXPECT_TRUE(std::set<std::int64_t>(found.begin(), found.end()) == expected);
        }
}

TEST(Faces, PagesWithoutAValueArePassedOverByTheirHeads) {
    auto input = number(unit_square_points(20000, 6));
    for (Input &vertex : input) vertex.attributes = {vertex.point[0]};
    Mesh mesh(1);
    ASSERT_EQ(mesh.stage(input), ABACUS_OK);
    ASSERT_EQ(mesh.build(), ABACUS_OK);
    const Host host = mesh.host.host();
    std::size_t pages = 0;
    RangeScan<2> scan(host, mesh.header, nullptr, [](const PageView<2> &page) {
        return page.may_have_attribute(0, 0.7, 0.71);
    });
    while (scan.advance()) ++pages;
    EXPECT_GT(pages, 0u);
    EXPECT_LT(pages, mesh.host.pages.size() / 2) << "of " << mesh.host.pages.size();
}

} // namespace
} // namespace abacus::test
