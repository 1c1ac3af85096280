// Whether a simplex meets a box, compared with CGAL in exact arithmetic.
#include "geometry/simplex_box.hpp"

#include <CGAL/Exact_predicates_exact_constructions_kernel.h>

#include <gtest/gtest.h>

#include <random>

namespace abacus {
namespace {

using Kernel = CGAL::Exact_predicates_exact_constructions_kernel;

bool cgal_meets(const Corners<2> &c, const Box<2> &b) {
    const auto point = [](const Point<2> &p) { return Kernel::Point_2(p[0], p[1]); };
    const Kernel::Triangle_2 triangle(point(*c[0]), point(*c[1]), point(*c[2]));
    if (b.is_point()) return !triangle.has_on_unbounded_side(point(b.lower));
    if (b.lower[0] == b.upper[0] || b.lower[1] == b.upper[1])
        return CGAL::do_intersect(triangle, Kernel::Segment_2(point(b.lower), point(b.upper)));
    return CGAL::do_intersect(triangle, Kernel::Iso_rectangle_2(point(b.lower), point(b.upper)));
}

bool cgal_meets(const Corners<3> &c, const Box<3> &b) {
    const auto point = [](const Point<3> &p) { return Kernel::Point_3(p[0], p[1], p[2]); };
    const Kernel::Tetrahedron_3 tetrahedron(point(*c[0]), point(*c[1]), point(*c[2]), point(*c[3]));
    if (b.is_point()) return !tetrahedron.has_on_unbounded_side(point(b.lower));
    return CGAL::do_intersect(tetrahedron, Kernel::Iso_cuboid_3(point(b.lower), point(b.upper)));
}

template <int D> void compare(int range, unsigned seed) {
    std::mt19937_64 random(seed);
    const auto any = [&] {
        Point<D> p;
        for (double &x : p) x = static_cast<double>(random() % range);
        return p;
    };
    int met = 0, compared = 0;
    while (compared < 4000) {
        std::array<Point<D>, D + 1> points;
        Corners<D> corners;
        for (int i = 0; i <= D; ++i) {
            points[i] = any();
            corners[i] = &points[i];
        }
        const int turned = orientation<D>(corners);
        if (turned == 0) continue;
        if (turned < 0) std::swap(corners[0], corners[1]);
        Box<D> box;
        box.extend(any());
        Point<D> other = any();
        if (compared % 2 == 0)
            for (int i = 0; i < D; ++i)
                other[i] = box.lower[i] + static_cast<double>(random() % (range / 4 + 1));
        box.extend(other);
        bool is_flat = false;
        for (int i = 0; i < D; ++i) is_flat = is_flat || box.lower[i] == box.upper[i];
        if (D == 3 && is_flat && !box.is_point()) continue;
        const bool expected = cgal_meets(corners, box);
        EXPECT_EQ(meets<D>(corners, box), expected);
        met += expected;
        ++compared;
    }
    EXPECT_GT(met, compared / 50);
    EXPECT_LT(met, compared - compared / 50);
}

TEST(SimplexBox, EqualsCgal) {
    for (const int range : {4, 8, 20, 1000}) { // small ones touch often
        compare<2>(range, 1);
        compare<3>(range, 2);
    }
}

TEST(SimplexBox, OpenOverlapLeavesOutWhatTouches) {
    const Point<2> triangle[] = {{0, 0}, {2, 0}, {0, 2}};
    EXPECT_TRUE(is_kept_apart(triangle, 3, {{1, 1}, {2, 2}}, false));
    EXPECT_FALSE(is_kept_apart(triangle, 3, {{1, 1}, {2, 2}}, true));
    EXPECT_FALSE(is_kept_apart(triangle, 3, {{0.9, 0.9}, {2, 2}}, false));
    EXPECT_TRUE(is_kept_apart(triangle, 3, {{1.1, 1.1}, {2, 2}}, true));
}

} // namespace
} // namespace abacus
