// The facet that separates a simplex from a point, along walks: compared with the orientations of
// all facets of each simplex, wherever the point lies.
#include "traverse/separator.hpp"

#include "support/mesh_in_change.hpp"
#include "support/point_sets.hpp"

namespace abacus::test {
namespace {

/// The ends of walks: vertices, middles of pairs, which sometimes lie on edges, and arbitrary
/// places.
template <int D>
std::vector<Point<D>> targets(const std::vector<Point<D>> &points, Random &random) {
    const auto any = [&] { return points[random() % points.size()]; };
    std::vector<Point<D>> targets;
    for (int i = 0; i < 40; ++i) {
        const Point<D> a = any(), b = any();
        Point<D> middle, mixed;
        for (int axis = 0; axis < D; ++axis) {
            middle[axis] = a[axis] / 2 + b[axis] / 2 + 0.0;
            mixed[axis] = any()[axis];
        }
        targets.insert(targets.end(), {a, middle, mixed});
    }
    return targets;
}

/// The side of each facet on which p lies.
template <int D>
std::array<int, D + 1> sides(const Cache<D> &cache, const Simplex<D> &s, const Point<D> &p) {
    std::array<int, D + 1> sides;
    for (int i = 0; i <= D; ++i) sides[i] = facet_side<D>(cache.corners(s), i, p);
    return sides;
}

/// Walks to p and checks each answer on the way; returns the simplex at the end.
template <int D>
int expect_right_facets(Cache<D> &cache, Handle h, const Point<D> &p, Random &random) {
    Separator<D, Cache<D>> separator(cache, p);
    int entered = separator.none;
    while (!cache.simplex(h).is_ghost()) {
        const Simplex<D> &s = cache.simplex(h);
        const std::array<int, D + 1> sides = test::sides<D>(cache, s, p);
        const int facet = separator.find(s, entered, static_cast<std::uint32_t>(random()));
        if (facet == separator.none) {
            EXPECT_GE(*std::min_element(sides.begin(), sides.end()), 0);
            EXPECT_EQ(separator.is_on_facet(), std::count(sides.begin(), sides.end(), 0) > 0);
            return separator.is_on_facet() ? 1 : 0;
        }
        EXPECT_NE(facet, entered);
        EXPECT_LT(sides[facet], 0);
        if (sides[facet] >= 0) return -1;
        const Link link = cache.cross(h, facet);
        h = link_simplex(link);
        entered = link_facet(link);
    }
    return 2;
}

template <class Dimension> class Separating : public testing::Test {};
using Dimensions = testing::Types<std::integral_constant<int, 2>, std::integral_constant<int, 3>>;
TYPED_TEST_SUITE(Separating, Dimensions);

TYPED_TEST(Separating, IsWhatOrientationsSay) {
    constexpr int D = TypeParam::value;
    int ended_inside = 0, ended_on_facet = 0, ended_outside = 0;
    for (const PointSet<D> &set : point_sets<D>()) {
        SCOPED_TRACE(set.name);
        Random random(1);
        std::vector<Point<D>> points = distinct(set.points(random));
        if (points.size() > 2000) points.resize(2000);
        MeshInChange<D> mesh(box_around<D>(points), 64 << 20);
        if (!mesh.build(points)) continue;
        std::vector<Handle> finite;
        mesh.cache.visit(first_key, [&](Handle h) {
            if (!mesh.cache.simplex(h).is_ghost()) finite.push_back(h);
        });
        if (finite.empty()) continue;
        for (const Point<D> &p : targets<D>(points, random)) {
            const int end =
                expect_right_facets<D>(mesh.cache, finite[random() % finite.size()], p, random);
            ended_inside += end == 0;
            ended_on_facet += end == 1;
            ended_outside += end == 2;
        }
    }
    EXPECT_GT(ended_inside, 100);
    EXPECT_GT(ended_on_facet, 100);
    EXPECT_GT(ended_outside, 5);
}

} // namespace
} // namespace abacus::test
