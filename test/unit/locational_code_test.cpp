// Positions on the curve.
#include "keys/locational_code.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <random>
#include <set>
#include <vector>

namespace abacus {
namespace {

constexpr double largest = std::numeric_limits<double>::max();
constexpr double least = std::numeric_limits<double>::denorm_min();

template <class Dimension> class LocationalCode : public testing::Test {
protected:
    static constexpr int D = Dimension::value;
    static constexpr std::uint32_t last_cell = (std::uint32_t{1} << code_bits<D>)-1;

    static Point<D> all(double x) {
        Point<D> p;
        p.fill(x);
        return p;
    }
    static Domain<D> cube(double lower, double upper) { return {all(lower), all(upper)}; }

    /// Domains of every magnitude.
    static std::vector<Domain<D>> domains() {
        std::vector<Domain<D>> result = {
            cube(0, 1),
            cube(-180, 180),
            cube(-1.7e308, 1.7e308),
            cube(-largest, largest),
            cube(1e308, largest),
            cube(1e-300, 1e300),
            cube(0, std::numeric_limits<double>::min()),
            cube(0, least),
            cube(least, 2 * least),
            cube(3 * least, 4 * least),
            cube(-least, least),
            cube(-1e-310, 3e-320),
            cube(1, std::nextafter(1, 2)),
            cube(1e16, 1e16 + 2),
            cube(std::nextafter(largest, 0), largest),
        };
        // Axes of very different extent and place.
        Point<D> lower = all(0), upper = all(1e-300);
        lower[0] = upper[0] = 1e300;
        result.emplace_back(lower, upper);
        upper[0] = largest;
        result.emplace_back(lower, upper);
        return result;
    }
};
using Dimensions = testing::Types<std::integral_constant<int, 2>, std::integral_constant<int, 3>>;
TYPED_TEST_SUITE(LocationalCode, Dimensions);

TYPED_TEST(LocationalCode, InterleavesTheBits) {
    constexpr int D = TypeParam::value;
    std::mt19937 random(1);
    for (int round = 0; round < 1000; ++round) {
        Cell<D> cell;
        for (auto &c : cell) c = random() & this->last_cell;
        std::uint64_t expected = 0;
        for (int bit = 0; bit < code_bits<D>; ++bit)
            for (int axis = 0; axis < D; ++axis)
                expected |= std::uint64_t{cell[axis] >> bit & 1} << (D * bit + axis);
        EXPECT_EQ(morton<D>(cell), expected);
    }
}

TYPED_TEST(LocationalCode, StepsFromCellToNeighbour) {
    constexpr int D = TypeParam::value;
    constexpr std::uint32_t edge = 16;
    // Octants at both ends of the curve and inside it.
    for (const std::uint32_t corner :
         {0u, edge, 5 * edge, (this->last_cell + 1) / 2, this->last_cell + 1 - edge}) {
        std::map<std::uint64_t, Cell<D>> place;
        Cell<D> step{};
        for (int axis = 0; axis < D;) {
            Cell<D> cell;
            for (int i = 0; i < D; ++i) cell[i] = corner + step[i];
            place[curve_code<D>(cell)] = cell;
            for (axis = 0; axis < D && ++step[axis] == edge; ++axis) step[axis] = 0;
        }
        ASSERT_EQ(place.size(), std::size_t(std::pow(edge, D)));
        EXPECT_EQ(place.begin()->first % place.size(), 0u);
        EXPECT_EQ(place.rbegin()->first - place.begin()->first, place.size() - 1);
        for (auto at = place.begin(), next = std::next(at); next != place.end(); ++at, ++next) {
            std::uint32_t distance = 0;
            for (int i = 0; i < D; ++i)
                distance += std::max(at->second[i], next->second[i]) -
                            std::min(at->second[i], next->second[i]);
            EXPECT_EQ(distance, 1u);
        }
    }
}

TYPED_TEST(LocationalCode, PartDoesNotDependOnTheOrderOfTheCorners) {
    constexpr int D = TypeParam::value;
    std::mt19937_64 random(5);
    for (const Domain<D> &domain : this->domains()) {
        for (int round = 0; round < 50; ++round) {
            std::array<Point<D>, D + 1> points;
            for (Point<D> &p : points)
                for (int axis = 0; axis < D; ++axis) {
                    const double t = std::ldexp(static_cast<double>(random()), -64);
                    p[axis] = domain.lower()[axis] * (1 - t) + domain.upper()[axis] * t;
                }
            if (round % 2) points[0] = points[1]; // equal within their cells
            std::array<const Point<D> *, D + 1> corners;
            for (int i = 0; i <= D; ++i) corners[i] = &points[i];
            const auto part_of = [&] {
                std::array<std::uint64_t, D + 1> codes;
                for (int i = 0; i <= D; ++i) codes[i] = domain.code(*corners[i]);
                return Domain<D>::part(corners, codes, D + 1);
            };
            const std::uint64_t part = part_of();
            EXPECT_LT(part, std::uint64_t{1} << 63);
            std::sort(corners.begin(), corners.end());
            do EXPECT_EQ(part_of(), part);
            while (std::next_permutation(corners.begin(), corners.end()));
        }
    }
}

TYPED_TEST(LocationalCode, PartsOfAGridAreInOrderHoweverFineItIs) {
    constexpr int D = TypeParam::value;
    constexpr int n = 32;
    Point<D> lower, upper;
    lower.fill(-1);
    upper.fill(1);
    const Domain<D> domain(lower, upper);
    for (const double step : {0x1p-990, 0x1p-1020, 0x1p-1030, 0x1p-1060, 0x1p-1074}) {
        std::set<std::uint64_t> coarse, places;
        for (int i = 0; i < n; ++i)
            for (int j = 0; j < n; ++j) {
                std::array<Point<D>, D + 1> points;
                for (int k = 0; k <= D; ++k) {
                    points[k].fill(0);
                    points[k][0] = (i + (k == 1)) * step;
                    points[k][1] = (j + (k == 2)) * step;
                    if (D == 3) points[k][D - 1] = (k == 3) * step;
                }
                std::array<const Point<D> *, D + 1> corners;
                std::array<std::uint64_t, D + 1> codes{};
                for (int k = 0; k <= D; ++k) {
                    corners[k] = &points[k];
                    codes[k] = domain.code(points[k]);
                }
                const std::uint64_t part = Domain<D>::part(corners, codes, D + 1);
                coarse.insert(part >> 47);
                places.insert(part >> (D == 2 ? 15 : 11));
            }
        // All are in the same coarse place, each in a fine place of its own.
        EXPECT_EQ(coarse.size(), 1u) << step;
        EXPECT_EQ(places.size(), std::size_t(n) * n) << step;
    }
}

TYPED_TEST(LocationalCode, DomainReachesFromTheFirstCellToTheLast) {
    constexpr int D = TypeParam::value;
    for (const Domain<D> &domain : this->domains()) {
        SCOPED_TRACE(domain.lower()[0]);
        const Cell<D> lower = domain.cell(domain.lower()), upper = domain.cell(domain.upper());
        EXPECT_EQ(lower, Cell<D>{});
        // Rounding may cost a cell or two. A greater loss would waste bits, and the refinement of
        // clusters must distinguish the ends.
        EXPECT_GE(*std::max_element(upper.begin(), upper.end()), this->last_cell - 2);
    }
}

TYPED_TEST(LocationalCode, IsMonotoneInEachAxis) {
    constexpr int D = TypeParam::value;
    std::mt19937_64 random(2);
    for (const Domain<D> &domain : this->domains()) {
        SCOPED_TRACE(domain.lower()[0]);
        for (int axis = 0; axis < D; ++axis) {
            std::vector<double> xs = {-largest, -1, -least, 0, least, 1, largest};
            const double lower = domain.lower()[axis], upper = domain.upper()[axis];
            std::uniform_real_distribution<double> unit(0, 1);
            for (int i = 0; i < 1000; ++i) {
                const double t = unit(random);
                const double x = lower * (1 - t) + upper * t;
                xs.insert(xs.end(), {x, std::nextafter(x, largest), std::nextafter(x, -largest)});
            }
            std::sort(xs.begin(), xs.end());
            std::uint32_t before = 0;
            Point<D> p = domain.lower();
            for (const double x : xs) {
                p[axis] = x;
                const std::uint32_t cell = domain.cell(p)[axis];
                EXPECT_LE(before, cell) << x;
                EXPECT_LE(cell, this->last_cell);
                before = cell;
            }
        }
    }
}

TYPED_TEST(LocationalCode, ClampsPointsOutside) {
    constexpr int D = TypeParam::value;
    for (const Domain<D> &domain : this->domains()) {
        EXPECT_EQ(domain.code(this->all(-largest)), 0u);
        EXPECT_LT(domain.code(this->all(largest)), std::uint64_t{1} << 63);
    }
    const Domain<D> unit = this->cube(0, 1);
    EXPECT_EQ(unit.cell(this->all(-1e300)), unit.cell(this->all(0)));
    EXPECT_EQ(unit.cell(this->all(1e300)), unit.cell(this->all(1)));
    EXPECT_EQ(unit.cell(this->all(1))[0], this->last_cell);
}

TYPED_TEST(LocationalCode, DomainWithoutExtentIsOneCell) {
    constexpr int D = TypeParam::value;
    for (const double at : {0.0, 1.0, -largest, largest, least}) {
        const Domain<D> domain = this->cube(at, at);
        for (const double x : {-largest, -1.0, 0.0, least, at, 1.0, largest})
            EXPECT_EQ(domain.code(this->all(x)), 0u);
    }
}

TYPED_TEST(LocationalCode, AxesShareOneScale) {
    constexpr int D = TypeParam::value;
    Point<D> upper = this->all(1);
    upper[0] = 1024;
    const Domain<D> domain(this->all(0), upper);
    EXPECT_NEAR(domain.cell(this->all(1))[0], domain.cell(this->all(1))[1], 1);
    EXPECT_NEAR(domain.cell(this->all(0.5))[1], std::ldexp(1.0, code_bits<D>) / 2048, 1);
}

} // namespace
} // namespace abacus
