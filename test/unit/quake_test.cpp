// The earthquake data sets, compared with an octree made in the simplest way: leaves in a map,
// split until the wavelength is resolved, then until no leaf presses another.
#include "host/host.hpp"
#include "keys/locational_code.hpp"
#include "quake/quake_points.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>
#include <memory>
#include <set>
#include <tuple>
#include <vector>

namespace abacus {
namespace {

using Place = Cell<3>; // in units of the octree

constexpr std::uint32_t width = BalancedOctree::width, height = BalancedOctree::height;
constexpr double unit = BalancedOctree::unit;

struct Leaf {
    Place lower;
    int shift;

    std::uint32_t size() const { return 1u << shift; }
    auto operator<=>(const Leaf &) const = default;
};

class PlainOctree {
public:
    PlainOctree(double frequency, double points_per_wavelength)
        : slowness_(frequency * points_per_wavelength) {
        for (std::uint32_t z = 0; z < height; z += width / 8)
            for (std::uint32_t y = 0; y < width; y += width / 8)
                for (std::uint32_t x = 0; x < width; x += width / 8)
                    refine({{x, y, z}, BalancedOctree::coarsest});
        balance();
    }

    const std::set<Leaf> &leaves() const { return leaves_; }

    std::set<std::uint64_t> corners() const {
        std::set<std::uint64_t> codes;
        for (const Leaf &leaf : leaves_)
            for (std::uint32_t i = 0; i < 8; ++i)
                codes.insert(morton<3>({leaf.lower[0] + (i & 1) * leaf.size(),
                                        leaf.lower[1] + (i >> 1 & 1) * leaf.size(),
                                        leaf.lower[2] + (i >> 2) * leaf.size()}));
        return codes;
    }

    double slowest(const Leaf &leaf) const {
        return Basin::slowest({unit * leaf.lower[0], unit * (leaf.lower[0] + leaf.size()),
                               unit * leaf.lower[1], unit * (leaf.lower[1] + leaf.size()),
                               unit * (leaf.lower[2] + leaf.size()) - Basin::depth});
    }

    bool resolves(const Leaf &leaf) const {
        return unit * leaf.size() * slowness_ <= slowest(leaf);
    }

private:
    static std::vector<Leaf> children(const Leaf &leaf) {
        std::vector<Leaf> result;
        const std::uint32_t half = leaf.size() / 2;
        for (std::uint32_t i = 0; i < 8; ++i)
            result.push_back({{leaf.lower[0] + (i & 1) * half, leaf.lower[1] + (i >> 1 & 1) * half,
                               leaf.lower[2] + (i >> 2) * half},
                              leaf.shift - 1});
        return result;
    }

    void refine(const Leaf &leaf) {
        if (resolves(leaf))
            leaves_.insert(leaf);
        else
            for (const Leaf &child : children(leaf)) refine(child);
    }

    /// The leaf that contains a place, if any.
    const Leaf *owner(const Place &place) const {
        for (int shift = 0; shift <= BalancedOctree::coarsest; ++shift) {
            Leaf leaf{place, shift};
            for (std::uint32_t &v : leaf.lower) v = v >> shift << shift;
            if (const auto found = leaves_.find(leaf); found != leaves_.end()) return &*found;
        }
        return nullptr;
    }

    void balance() {
        std::vector<Leaf> pending(leaves_.begin(), leaves_.end());
        while (!pending.empty()) {
            const Leaf leaf = pending.back();
            pending.pop_back();
            if (!leaves_.contains(leaf)) continue;
            for (int i = 0; i < 27; ++i) {
                const int step[3] = {i % 3 - 1, i / 3 % 3 - 1, i / 9 - 1};
                const int axes = std::abs(step[0]) + std::abs(step[1]) + std::abs(step[2]);
                if (axes == 0 || axes == 3) continue;
                Place beside = leaf.lower;
                for (int a = 0; a < 3; ++a) beside[a] += step[a] * int(leaf.size());
                const Leaf *near = owner(beside);
                if (near == nullptr || near->shift <= leaf.shift + 1) continue;
                const Leaf coarse = *near;
                leaves_.erase(coarse);
                for (const Leaf &child : children(coarse)) {
                    leaves_.insert(child);
                    pending.push_back(child);
                }
                pending.push_back(leaf);
            }
        }
    }

    double slowness_;
    std::set<Leaf> leaves_;
};

std::uint64_t code_of(const QuakePoint &point) {
    const double place[3] = {point.x / unit, point.y / unit, (point.z + Basin::depth) / unit};
    Place cell;
    for (int i = 0; i < 3; ++i) {
        cell[i] = static_cast<std::uint32_t>(place[i]);
        EXPECT_EQ(place[i], cell[i]) << "an exact multiple of the unit";
    }
    return morton<3>(cell);
}

struct Case {
    double frequency, points_per_wavelength;
};

class QuakeSet : public testing::TestWithParam<Case> {};

TEST_P(QuakeSet, IsTheCornersOfTheBalancedOctreeInZOrder) {
    const auto [frequency, points_per_wavelength] = GetParam();
    const PlainOctree octree(frequency, points_per_wavelength);
    const std::set<std::uint64_t> corners = octree.corners();
    auto points = std::make_unique<QuakePoints>(frequency, points_per_wavelength);
    auto expected = corners.begin();
    QuakePoint point;
    std::int64_t count = 0;
    while (points->next(point)) {
        ASSERT_EQ(point.id, ++count);
        ASSERT_NE(expected, corners.end());
        ASSERT_EQ(code_of(point), *expected++) << "point " << count;
    }
    EXPECT_EQ(expected, corners.end());
    EXPECT_FALSE(points->next(point)) << "the end stays the end";
}

INSTANTIATE_TEST_SUITE_P(Frequencies, QuakeSet,
                         testing::Values(Case{1e-6, 8}, Case{0.003, 8}, Case{0.01, 8},
                                         Case{0.02, 8}, Case{0.03, 5}, Case{0.05, 8},
                                         Case{0.05, 10}, Case{0.075, 8}));

// Only the product of the two matters, however different they are.
TEST(QuakeSet, TakesFactorsOfAnySize) {
    const double greatest = std::numeric_limits<double>::max();
    const double least = std::numeric_limits<double>::denorm_min();
    for (const auto &[frequency, points_per_wavelength] :
         {Case{0x1p1000, 0x1p-1003}, Case{0x1p-1003, 0x1p1000}, Case{0x1p-1074, 0x1p1023},
          Case{0x1p1023, 0x1p-1074}, Case{greatest, least}, Case{least, least}, Case{0x1p-7, 16}}) {
        const double product = frequency * points_per_wavelength;
        auto points = std::make_unique<QuakePoints>(frequency, points_per_wavelength);
        auto same = std::make_unique<QuakePoints>(std::max(product, 1e-300), 1);
        QuakePoint point, expected;
        while (same->next(expected)) {
            ASSERT_TRUE(points->next(point)) << frequency << ", " << points_per_wavelength;
            ASSERT_EQ(code_of(point), code_of(expected));
        }
        EXPECT_FALSE(points->next(point)) << frequency << ", " << points_per_wavelength;
    }
}

// The guarantee of a box's bound, and of the refinement by it.
TEST(QuakeSet, LeavesResolveTheWavelength) {
    const double frequency = 0.05, points_per_wavelength = 8;
    const PlainOctree octree(frequency, points_per_wavelength);
    int refined_by_balance = 0;
    for (const Leaf &leaf : octree.leaves()) {
        ASSERT_TRUE(octree.resolves(leaf));
        const double bound = octree.slowest(leaf);
        for (std::uint32_t i = 0; i < 125; ++i) {
            const double step = unit * leaf.size() / 4;
            const double x = unit * leaf.lower[0] + (i % 5) * step,
                         y = unit * leaf.lower[1] + (i / 5 % 5) * step,
                         z = unit * leaf.lower[2] + (i / 25) * step - Basin::depth;
            ASSERT_GE(Basin::material(x, y, z).vs, bound);
        }
        refined_by_balance +=
            leaf.shift < BalancedOctree::coarsest &&
            octree.resolves({{leaf.lower[0] >> (leaf.shift + 1) << (leaf.shift + 1),
                              leaf.lower[1] >> (leaf.shift + 1) << (leaf.shift + 1),
                              leaf.lower[2] >> (leaf.shift + 1) << (leaf.shift + 1)},
                             leaf.shift + 1});
    }
    EXPECT_GT(refined_by_balance, 100) << "the case tests balance";
}

// The numbers in the documentation; the same on every machine.
TEST(QuakeSet, HasItsDocumentedSize) {
    auto points = std::make_unique<QuakePoints>(0.1);
    QuakePoint point, last{};
    double least_x = 1, greatest_x = 0, least_z = 0, greatest_z = -1;
    while (points->next(point)) {
        last = point;
        least_x = std::min(least_x, point.x);
        greatest_x = std::max(greatest_x, point.x);
        least_z = std::min(least_z, point.z);
        greatest_z = std::max(greatest_z, point.z);
        ASSERT_FALSE(std::signbit(point.x) || std::signbit(point.y));
        ASSERT_TRUE(point.z < 0 || !std::signbit(point.z)) << "no negative zero";
    }
    EXPECT_EQ(last.id, 131692);
    EXPECT_EQ(least_x, 0);
    EXPECT_EQ(greatest_x, 100'000);
    EXPECT_EQ(least_z, -37'500);
    EXPECT_EQ(greatest_z, 0);
}

// To the last bit, with any compiler and machine.
TEST(QuakeSet, IsTheSameEverywhere) {
    auto points = std::make_unique<QuakePoints>(0.05);
    QuakePoint point;
    std::uint64_t hash = 0;
    while (points->next(point))
        for (const double value : {point.x, point.y, point.z, point.material.vs, point.material.vp,
                                   point.material.density})
            hash = (hash ^ std::bit_cast<std::uint64_t>(value)) * 0x9e3779b97f4a7c15u;
    EXPECT_EQ(hash, 6159355530686002659u);
}

TEST(Basin, IsSoftOverHard) {
    const Material valley = Basin::material(52'000, 45'000, 0);
    const Material hill = Basin::material(99'000, 99'000, 0);
    const Material deep = Basin::material(52'000, 45'000, -30'000);
    EXPECT_EQ(valley.vs, Basin::slowest({52'000, 52'000, 45'000, 45'000, 0}));
    EXPECT_LT(valley.vs, 300);
    EXPECT_EQ(hill.vs, 1'500);
    EXPECT_GT(deep.vs, 3'500);
    for (const Material &m : {valley, hill, deep}) {
        EXPECT_GT(m.vp, 1.5 * m.vs);
        EXPECT_LT(m.vp, 7'000);
        EXPECT_GT(m.density, 1'300);
        EXPECT_LT(m.density, 3'000);
    }
}

TEST(Basin, GetsFasterWithDepth) {
    for (double x = 0; x <= Basin::width; x += 2'500)
        for (double y = 0; y <= Basin::width; y += 2'500) {
            double vs = 0;
            for (double z = 0; z >= -Basin::depth; z -= 62.5) {
                const double here = Basin::material(x, y, z).vs;
                ASSERT_GT(here, vs) << x << " " << y << " " << z;
                vs = here;
            }
        }
}

TEST(QuakeSet, RefusesArgumentsOutOfRange) {
    const double nan = std::numeric_limits<double>::quiet_NaN();
    const double inf = std::numeric_limits<double>::infinity();
    for (const auto &[frequency, points_per_wavelength] :
         {Case{0, 8}, Case{-1, 8}, Case{nan, 8}, Case{inf, 8}, Case{1, 0}, Case{1, -8},
          Case{1, nan}, Case{1, inf}, Case{1000, 8}, Case{1e300, 1e300}}) {
        try {
            std::make_unique<QuakePoints>(frequency, points_per_wavelength);
            ADD_FAILURE() << frequency << ", " << points_per_wavelength;
        } catch (const Error &error) {
            EXPECT_EQ(error.kind, ABACUS_ERROR_ARGUMENT);
        }
    }
}

// The deepest possible octree starts at once and streams evenly.
TEST(QuakeSet, StreamsAtTheHighestFrequency) {
    auto points = std::make_unique<QuakePoints>(262);
    QuakePoint point;
    std::uint64_t previous = 0;
    for (int i = 0; i < 100'000; ++i) {
        ASSERT_TRUE(points->next(point));
        const std::uint64_t code = code_of(point);
        ASSERT_TRUE(i == 0 || code > previous);
        previous = code;
    }
}

} // namespace
} // namespace abacus
