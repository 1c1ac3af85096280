// Which sets of simplices are complexes: a few random ones on a small grid, where everything
// degenerate happens, compared with a test of every pair with CGAL's kernel over rationals.
//
// Two simplices meet in a common face if and only if no vertex of one lies in a face of the
// other that lacks this vertex, and in space no edge of one meets an edge or a triangle of
// the other that shares no vertex with it (circuits: De Loera, Rambau and Santos,
// "Triangulations", 2010, §4.1).
#include "support/sanitized.hpp"
#include "support/triangulations.hpp"

#include <CGAL/Exact_rational.h>
#include <CGAL/Simple_cartesian.h>

#include <gtest/gtest.h>

#include <set>

namespace abacus::test {
namespace {

// Fewer sets under a sanitizer.
const int scale = sanitized ? 8 : 1;

using Kernel = CGAL::Simple_cartesian<CGAL::Exact_rational>;

auto cgal(const Point<2> &p) { return Kernel::Point_2(p[0], p[1]); }
auto cgal(const Point<3> &p) { return Kernel::Point_3(p[0], p[1], p[2]); }

template <int D> using Places = std::map<std::int64_t, Point<D>>;

template <int D> bool has(const Ids<D> &s, std::int64_t id) {
    return std::count(s.begin(), s.end(), id) > 0;
}

bool vertex_inside(const Places<2> &at, const Ids<2> &s, std::int64_t v) {
    const Kernel::Triangle_2 t(cgal(at.at(s[0])), cgal(at.at(s[1])), cgal(at.at(s[2])));
    return t.bounded_side(cgal(at.at(v))) != CGAL::ON_UNBOUNDED_SIDE;
}
bool vertex_inside(const Places<3> &at, const Ids<3> &s, std::int64_t v) {
    const Kernel::Tetrahedron_3 t(cgal(at.at(s[0])), cgal(at.at(s[1])), cgal(at.at(s[2])),
                                  cgal(at.at(s[3])));
    return t.bounded_side(cgal(at.at(v))) != CGAL::ON_UNBOUNDED_SIDE;
}

template <int D>
bool edges_meet(const Places<D> &at, std::array<std::int64_t, 2> a, std::array<std::int64_t, 2> b) {
    using Segment = std::conditional_t<D == 2, Kernel::Segment_2, Kernel::Segment_3>;
    return CGAL::do_intersect(Segment(cgal(at.at(a[0])), cgal(at.at(a[1]))),
                              Segment(cgal(at.at(b[0])), cgal(at.at(b[1]))));
}

/// Whether an edge of `a` meets an edge, or in space a triangle, of b elsewhere.
template <int D> bool edges_cross(const Places<D> &at, const Ids<D> &a, const Ids<D> &b) {
    for (int i = 0; i <= D; ++i)
        for (int j = 0; j < i; ++j) {
            for (int k = 0; k <= D; ++k)
                for (int l = 0; l < k; ++l)
                    if (a[i] != b[k] && a[i] != b[l] && a[j] != b[k] && a[j] != b[l] &&
                        edges_meet<D>(at, {a[i], a[j]}, {b[k], b[l]}))
                        return true;
            if constexpr (D == 3)
                for (int k = 0; k < 4; ++k) { // the triangle without b[k]
                    Ids<3> t = b;
                    std::swap(t[k], t[3]);
                    if (std::count(t.begin(), t.begin() + 3, a[i]) +
                            std::count(t.begin(), t.begin() + 3, a[j]) >
                        0)
                        continue;
                    if (CGAL::do_intersect(Kernel::Segment_3(cgal(at.at(a[i])), cgal(at.at(a[j]))),
                                           Kernel::Triangle_3(cgal(at.at(t[0])), cgal(at.at(t[1])),
                                                              cgal(at.at(t[2])))))
                        return true;
                }
        }
    return false;
}

template <int D> bool meet_properly(const Places<D> &at, const Ids<D> &a, const Ids<D> &b) {
    for (int i = 0; i <= D; ++i)
        if ((!has<D>(b, a[i]) && vertex_inside(at, b, a[i])) ||
            (!has<D>(a, b[i]) && vertex_inside(at, a, b[i])))
            return false;
    return !edges_cross<D>(at, a, b) && (D == 2 || !edges_cross<D>(at, b, a));
}

template <int D> void compare(int rounds, int points, int range, int most, unsigned seed) {
    std::mt19937_64 random(seed);
    int complexes = 0, others = 0;
    for (int round = 0; round < rounds; ++round) {
        Places<D> at;
        std::set<Point<D>> taken;
        while (static_cast<int>(at.size()) < points) {
            Point<D> p;
            for (double &x : p) x = static_cast<double>(random() % range);
            if (taken.insert(p).second) at[static_cast<std::int64_t>(at.size()) + 1] = p;
        }
        Triangulation<D> t;
        for (const auto &[id, p] : at) t.vertices.push_back({id, p});
        std::set<Ids<D>> chosen;
        const std::size_t wanted = 2 + random() % (most - 1);
        for (int tries = 0; chosen.size() < wanted && tries < 100; ++tries) {
            std::set<std::int64_t> ids;
            while (ids.size() <= D) ids.insert(1 + static_cast<std::int64_t>(random() % points));
            Ids<D> s;
            std::copy(ids.begin(), ids.end(), s.begin());
            Corners<D> corners;
            for (int i = 0; i <= D; ++i) corners[i] = &at[s[i]];
            if (orientation<D>(corners) != 0) chosen.insert(s);
        }
        t.simplices.assign(chosen.begin(), chosen.end());
        bool complex = true;
        for (std::size_t i = 0; complex && i < t.simplices.size(); ++i)
            for (std::size_t k = 0; complex && k < i; ++k)
                complex = meet_properly<D>(at, t.simplices[i], t.simplices[k]);
        ++(complex ? complexes : others);
        MeshOf<D> mesh(0);
        const abacus_status status = mesh.load(t.vertices, t.simplices);
        ASSERT_EQ(status == ABACUS_OK, complex)
            << mesh.error.message << "; " << testing::PrintToString(t.simplices) << " at "
            << testing::PrintToString(at);
        if (complex) {
            ASSERT_EQ(mesh.check(), std::vector<std::string>{});
        }
    }
    EXPECT_GT(complexes, rounds / 20);
    EXPECT_GT(others, rounds / 20);
}

TEST(LoadComplex, OfTriangles) {
    compare<2>(4000, 6, 4, 3, 51);
    compare<2>(2000, 9, 6, 5, 52);
}

TEST(LoadComplex, OfTetrahedra) {
    compare<3>(2000 / scale, 7, 3, 2, 53);
    compare<3>(1500 / scale, 8, 4, 3, 54);
    compare<3>(1000 / scale, 12, 5, 3, 55);
}

} // namespace
} // namespace abacus::test
