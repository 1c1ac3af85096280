// After each removal the mesh is CGAL's Delaunay triangulation of the remaining points, whatever
// the input, the order and the size of the cache.
#include "support/mesh_in_change.hpp"
#include "support/point_sets.hpp"
#include "support/sanitized.hpp"

namespace abacus::test {
namespace {

// A cache of about three blocks: everything is evicted and loaded again all the time.
constexpr std::size_t little = 60 << 10;

// Only a part of each input.
const std::size_t scale = sanitized ? 10 : 2;

template <int D> void remove_all(std::vector<Point<D>> points, std::size_t cache_bytes) {
    MeshInChange<D> mesh(box_around<D>(points), cache_bytes);
    std::vector<Point<D>> shuffled = distinct(points);
    Random random(1);
    std::shuffle(shuffled.begin(), shuffled.end(), random);
    if (!mesh.build(shuffled)) {
        EXPECT_TRUE(cgal_simplices<D>(points).empty());
        return;
    }
    const std::size_t half = points.size() / 2, tenth = points.size() / 10;
    while (!points.empty()) {
        const Point<D> p = points.back();
        points.pop_back();
        const Removed removed = mesh.removal.remove(p);
        if (removed == Removed::collapses) {
            EXPECT_TRUE(cgal_simplices<D>(points).empty());
            std::vector<Point<D>> left;
            mesh.removal.each_neighbour(
                [&](VertexIndex v) { left.push_back(mesh.cache.point(v)); });
            EXPECT_EQ(distinct(left), distinct(points));
            break;
        }
        ASSERT_EQ(removed, Removed::removed);
        ASSERT_EQ(mesh.cache.check_invariants(), nullptr) << points.size() << " points are left";
        if (points.size() == half || points.size() == tenth || points.size() < 24) {
            mesh.verify(points);
            if (testing::Test::HasFatalFailure()) return;
        }
    }
    EXPECT_FALSE(points.empty());
}

template <int D> class RemovalOf : public testing::TestWithParam<PointSet<D>> {
protected:
    std::vector<Point<D>> points() {
        Random random(7);
        auto points = this->GetParam().points(random);
        std::shuffle(points.begin(), points.end(), random);
        points.resize(std::max(points.size() / scale, std::min<std::size_t>(points.size(), 100)));
        return distinct(points);
    }
    void in_random_order() {
        auto points = this->points();
        Random random(3);
        std::shuffle(points.begin(), points.end(), random);
        remove_all<D>(points, little);
    }
    void in_lexicographic_order() { remove_all<D>(points(), 10 * little); }
};
class Removal2 : public RemovalOf<2> {};
class Removal3 : public RemovalOf<3> {};

TEST_P(Removal2, RemovesEverythingInRandomOrder) { in_random_order(); }
TEST_P(Removal2, RemovesEverythingInLexicographicOrder) { in_lexicographic_order(); }
TEST_P(Removal3, RemovesEverythingInRandomOrder) { in_random_order(); }
TEST_P(Removal3, RemovesEverythingInLexicographicOrder) { in_lexicographic_order(); }

INSTANTIATE_TEST_SUITE_P(Inputs, Removal2, testing::ValuesIn(point_sets<2>()),
                         [](const auto &info) { return info.param.name; });
INSTANTIATE_TEST_SUITE_P(Inputs, Removal3, testing::ValuesIn(point_sets<3>()),
                         [](const auto &info) { return info.param.name; });

} // namespace
} // namespace abacus::test
