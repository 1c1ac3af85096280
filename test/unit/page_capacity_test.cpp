// What pages show about how many simplices fit into one.
#include "mesh/simplex_blocks.hpp"
#include "support/oracle.hpp"

#include <gtest/gtest.h>

#include <cstring>
#include <random>

namespace abacus::test {
namespace {

template <class Dimension> class PageCapacities : public testing::Test {
protected:
    static constexpr int D = Dimension::value;

    /// A mesh whose pages are filled to different degrees, since its points came and went at random
    /// places. All coordinates have the same exponent.
    static void make(MeshOf<D> &mesh) {
        constexpr std::size_t many = D == 2 ? 30000 : 8000, some = many / 20, rounds = 8;
        std::mt19937_64 random(1);
        std::uniform_real_distribution<double> coordinate(1, 2);
        std::vector<Point<D>> points(many + rounds * some);
        for (Point<D> &p : points)
            for (double &x : p) x = coordinate(random);
        const auto all = number<D>(points);
        ASSERT_EQ(mesh.insert({all.begin(), all.begin() + many}), ABACUS_OK);
        for (auto out = all.begin(), in = out + many; in < all.end(); out += some, in += some) {
            std::uint64_t deleted = 0;
            ASSERT_EQ(mesh.remove({out, out + some}, deleted), ABACUS_OK);
            ASSERT_EQ(mesh.insert({in, in + some}), ABACUS_OK);
        }
    }
};
using Dimensions = testing::Types<std::integral_constant<int, 2>, std::integral_constant<int, 3>>;
TYPED_TEST_SUITE(PageCapacities, Dimensions);

TYPED_TEST(PageCapacities, AreTheSameOfFullPagesAndOfHalfFullOnes) {
    constexpr int D = TypeParam::value;
    MeshOf<D> mesh;
    ASSERT_NO_FATAL_FAILURE(this->make(mesh));
    double sum[2] = {}, count[2] = {};
    for (auto &[key, page] : mesh.host.pages) {
        PageHeader header;
        std::memcpy(&header, page.bytes(), sizeof header);
        const double share = double(page.size) / ABACUS_PAGE_BYTES;
        const bool is_full = share > 0.8, is_half = share > 0.35 && share < 0.6;
        if (!is_full && !is_half) continue;
        sum[is_full] += PageCapacity(simplex_pages<D>(0)).learn(header.simplices, page.size);
        ++count[is_full];
    }
    ASSERT_GE(count[false], 5);
    ASSERT_GE(count[true], 5);
    EXPECT_NEAR(sum[false] / count[false], sum[true] / count[true], 0.06 * sum[true] / count[true]);
}

TYPED_TEST(PageCapacities, AreLearnedFromTheFirstPageAndNotLostByCrumbs) {
    constexpr int D = TypeParam::value;
    PageCapacity capacity(simplex_pages<D>(0));
    const int guess = capacity.usual();
    EXPECT_GT(guess, 100);
    EXPECT_EQ(capacity.learn(0, 200), guess); // an empty page shows nothing
    const int first = capacity.learn(500, 6000);
    EXPECT_GT(first, 500);
    EXPECT_EQ(capacity.usual(), first);
    for (int i = 0; i < 20; ++i) capacity.learn(500, 6000);
    EXPECT_EQ(capacity.usual(), first);
    capacity.learn(1, 300);
    EXPECT_NEAR(capacity.usual(), first, 0.01 * first);
    // Whatever a page says, a block takes some simplices, and no more than it has slots.
    EXPECT_GE(capacity.learn(1, 100000), 8);
    EXPECT_EQ(capacity.learn(600, 300), block_slots<D>);
    for (int i = 0; i < 100; ++i) capacity.learn(400, 6000);
    EXPECT_LT(capacity.usual(), 0.9 * first);
}

} // namespace
} // namespace abacus::test
