// Insertion order: what abacus_stage_* writes to the vertex pages.
#include "staging/rounds.hpp"
#include "support/staged_points.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>
#include <random>
#include <set>
#include <string>

namespace abacus {
namespace {

template <class Dimension> class Staging : public testing::Test {};
using Dimensions = testing::Types<std::integral_constant<int, 2>, std::integral_constant<int, 3>>;
TYPED_TEST_SUITE(Staging, Dimensions);

TYPED_TEST(Staging, OrderIsTheSameForEveryMemoryAndBatch) {
    constexpr int D = TypeParam::value;
    for (const Kind kind : all_kinds) {
        SCOPED_TRACE(static_cast<int>(kind));
        const Input<D> input = with_ids<D>(points<D>(kind, 30000));
        const Input<D> order = order_of<D>(input);
        expect_permutation<D>(input, order);
        EXPECT_TRUE(order_of<D>(input, tiny) == order);
        EXPECT_TRUE(order_of<D>(input, std::size_t{1} << 20, 17) == order);
        EXPECT_TRUE(order_of<D>(input, std::size_t{3} << 19, 30000) == order);
    }
}

TYPED_TEST(Staging, OrderOfDistinctPointsIsTheSameForEveryInputOrder) {
    constexpr int D = TypeParam::value;
    for (const Kind kind : all_kinds) {
        SCOPED_TRACE(static_cast<int>(kind));
        std::vector<Point<D>> shuffled = points<D>(kind, 20000);
        const Input<D> order = order_of<D>(with_ids<D>(shuffled));
        std::shuffle(shuffled.begin(), shuffled.end(), std::mt19937(3));
        const Input<D> other = order_of<D>(with_ids<D>(shuffled), tiny);
        EXPECT_TRUE(std::equal(order.begin(), order.end(), other.begin(), other.end(),
                               [](const auto &a, const auto &b) { return a.point == b.point; }));
    }
}

// Points are distributed as they come, over the domain that the first ones suggest and the rounds
// for their number.
TYPED_TEST(Staging, OrderIsTheSameWhereverTheFirstPointsLie) {
    constexpr int D = TypeParam::value;
    std::vector<Point<D>> input = points<D>(Kind::uniform, D == 2 ? 400000 : 100000);
    ASSERT_LT(Rounds<D>(15000).size(), Rounds<D>(input.size()).size());
    const auto same = [&](const Input<D> &a, const Input<D> &b) {
        return std::equal(a.begin(), a.end(), b.begin(), b.end(),
                          [](const auto &p, const auto &q) { return p.point == q.point; });
    };
    const Input<D> order = order_of<D>(with_ids<D>(input));
    EXPECT_TRUE(same(order_of<D>(with_ids<D>(input), tiny), order));
    // Within half of the domain, then everywhere.
    std::partition(input.begin(), input.end(), [](const Point<D> &p) { return p[0] < 0.5; });
    EXPECT_TRUE(same(order_of<D>(with_ids<D>(input), tiny), order));
    std::sort(input.begin(), input.end());
    EXPECT_TRUE(same(order_of<D>(with_ids<D>(input), tiny), order));
    std::reverse(input.begin(), input.end());
    EXPECT_TRUE(same(order_of<D>(with_ids<D>(input), tiny), order));
}

TYPED_TEST(Staging, EqualPointsAreAdjacentInInputOrder) {
    constexpr int D = TypeParam::value;
    for (const Kind kind : all_kinds) {
        SCOPED_TRACE(static_cast<int>(kind));
        for (const std::size_t memory : {tiny, ample}) {
            const Input<D> order = order_of<D>(with_ids<D>(points<D>(kind, 20000)), memory);
            std::set<Point<D>> seen;
            for (std::size_t i = 0; i < order.size(); ++i) {
                if (i > 0 && order[i].point == order[i - 1].point)
                    EXPECT_LT(order[i - 1].id, order[i].id);
                else
                    EXPECT_TRUE(seen.insert(order[i].point).second);
            }
        }
    }
}

TYPED_TEST(Staging, MinusZeroIsZero) {
    constexpr int D = TypeParam::value;
    Point<D> plus{}, minus{};
    minus.fill(-0.0);
    Point<D> one;
    one.fill(1);
    const Input<D> order = order_of<D>(with_ids<D>({plus, one, minus, plus}));
    for (const auto &point : order)
        for (const double x : point.point) EXPECT_FALSE(std::signbit(x));
    EXPECT_EQ(order[0].id, 0);
    EXPECT_EQ(order[1].id, 2);
    EXPECT_EQ(order[2].id, 3);
}

TYPED_TEST(Staging, RoundsGrowByTheInverseOfThePromotion) {
    constexpr int D = TypeParam::value;
    constexpr std::size_t n = 200000;
    const auto sample = points<D>(Kind::uniform, n);
    const Rounds<D> rounds(n);
    ASSERT_GE(rounds.size(), 2u);
    std::vector<double> size(rounds.size());
    for (const auto &p : sample) {
        ++size[rounds.round(p)];
        ASSERT_EQ(Rounds<D>::is_promoted(p), rounds.round(p) + 1 < rounds.size());
    }
    double expected = n * (1 - promotion<D>);
    for (std::size_t round = rounds.size(); round-- > 1; expected *= promotion<D>)
        EXPECT_NEAR(size[round], expected, 5 * std::sqrt(expected));
    EXPECT_GT(size[0], smallest_round / 2);

    // Each round is along the curve.
    const Input<D> order = order_of<D>(with_ids<D>(sample));
    std::size_t at = 0;
    for (const double in_round : size) {
        double length = 0;
        for (std::size_t i = 1; i < in_round; ++i, ++at) {
            double square = 0;
            for (int axis = 0; axis < D; ++axis)
                square += std::pow(order[at + 1].point[axis] - order[at].point[axis], 2);
            length += std::sqrt(square);
        }
        ++at;
        // A tour of n points in the unit square takes about sqrt(n), in the cube n^(2/3).
        EXPECT_LT(length, 2.5 * std::pow(in_round, 1 - 1.0 / D));
    }
    EXPECT_EQ(at, n);
}

TYPED_TEST(Staging, FewPointsAreOneRound) {
    constexpr int D = TypeParam::value;
    EXPECT_EQ(Rounds<D>(0).size(), 1u);
    EXPECT_EQ(Rounds<D>(1000).size(), 1u);
    EXPECT_LE(Rounds<D>(UINT64_MAX).size(), Rounds<D>::most);
    Point<D> p{};
    EXPECT_EQ(Rounds<D>(10).round(p), 0u);
}

TYPED_TEST(Staging, ClustersBelowTheResolutionAreInCurveOrder) {
    constexpr int D = TypeParam::value;
    // One cluster of spread 1e-12 in a domain of extent 1: the whole cluster has one code. The same
    // number of other points determine the domain.
    std::vector<Point<D>> cluster = points<D>(Kind::uniform, 5000);
    for (auto &p : cluster)
        for (double &x : p) x = 0.3 + 1e-12 * x;
    for (const auto &p : points<D>(Kind::uniform, 10000)) cluster.push_back(p);
    const Input<D> order = order_of<D>(with_ids<D>(cluster));
    double length = 0;
    for (std::size_t i = 1; i < order.size(); ++i) {
        double square = 0;
        for (int axis = 0; axis < D; ++axis)
            square += std::pow((order[i].point[axis] - order[i - 1].point[axis]) * 1e12, 2);
        if (square < 100) length += std::sqrt(square);
    }
    EXPECT_LT(length, 2.5 * std::pow(5000, 1 - 1.0 / D));
}

TYPED_TEST(Staging, AttributesTravelWithTheirPoints) {
    constexpr int D = TypeParam::value;
    for (const unsigned attributes : {1u, 7u, unsigned{ABACUS_MAX_ATTRIBUTES}}) {
        Input<D> input = with_ids<D>(points<D>(Kind::uniform, 3000));
        for (auto &point : input) {
            for (unsigned a = 0; a < attributes; ++a)
                point.attributes.push_back(
                    std::bit_cast<std::uint64_t>(static_cast<double>(point.id) + a));
            point.attributes[0] = UINT64_MAX - static_cast<std::uint64_t>(point.id); // a NaN
            point.id -= 1000; // ids may be negative
        }
        const Input<D> order = order_of<D>(input);
        expect_permutation<D>(input, order);
        EXPECT_TRUE(order_of<D>(input, tiny) == order);
    }
}

TYPED_TEST(Staging, HeaderIsBroughtUpToDate) {
    constexpr int D = TypeParam::value;
    MemoryHost host;
    abacus_error error{};
    abacus_header header = empty_header<D>();
    ASSERT_EQ(stage<D>(host, header, {}, ample, error), ABACUS_OK);
    EXPECT_EQ(header.facts.form.has_domain, 0u);
    EXPECT_EQ(header.facts.census.staged, 0u);
    EXPECT_TRUE(host.staged_pages.empty());

    Point<D> p, q;
    p.fill(-2);
    q.fill(3);
    ASSERT_EQ(stage<D>(host, header, with_ids<D>({q, p, q}), ample, error), ABACUS_OK);
    EXPECT_EQ(header.facts.form.has_domain, 1u);
    EXPECT_EQ(header.facts.census.staged, 3u);
    for (int axis = 0; axis < D; ++axis) {
        EXPECT_EQ(header.facts.form.lower[axis], -2);
        EXPECT_EQ(header.facts.form.upper[axis], 3);
    }

    // A later call continues the count and keeps the domain, even for points outside.
    Point<D> far;
    far.fill(1e9);
    ASSERT_EQ(stage<D>(host, header, with_ids<D>({far, p}), ample, error), ABACUS_OK);
    EXPECT_EQ(header.facts.census.staged, 5u);
    EXPECT_EQ(header.facts.form.upper[0], 3);
    const Input<D> order = staged<D>(host, header);
    EXPECT_EQ(order[3].point, p);
    EXPECT_EQ(order[4].point, far);

    // One point: a domain without extent.
    MemoryHost other;
    abacus_header single = empty_header<D>();
    ASSERT_EQ(stage<D>(other, single, with_ids<D>({p}), ample, error), ABACUS_OK);
    EXPECT_EQ(single.facts.form.has_domain, 1u);
    EXPECT_EQ(single.facts.form.lower[0], single.facts.form.upper[0]);
}

TYPED_TEST(Staging, GivenDomainIsKept) {
    constexpr int D = TypeParam::value;
    MemoryHost host;
    abacus_error error{};
    abacus_header header = empty_header<D>();
    header.facts.form.has_domain = 1;
    header.facts.form.lower[0] = -10;
    header.facts.form.upper[0] = 10;
    const Input<D> input = with_ids<D>(points<D>(Kind::uniform, 20000));
    ASSERT_EQ(stage<D>(host, header, input, tiny, error), ABACUS_OK);
    EXPECT_EQ(header.facts.form.lower[0], -10);
    EXPECT_EQ(header.facts.form.upper[0], 10);
    expect_permutation<D>(input, staged<D>(host, header));
}

TYPED_TEST(Staging, CoordinatesThatAreNotFiniteAreRefused) {
    constexpr int D = TypeParam::value;
    constexpr double infinity = std::numeric_limits<double>::infinity();
    for (const double bad : {infinity, -infinity, std::numeric_limits<double>::quiet_NaN()}) {
        MemoryHost host;
        abacus_error error{};
        abacus_header header = empty_header<D>();
        Point<D> p{};
        p[D - 1] = bad;
        Input<D> input = with_ids<D>({Point<D>{}, p});
        input[1].id = -42;
        EXPECT_EQ(stage<D>(host, header, input, ample, error), ABACUS_ERROR);
        EXPECT_EQ(error.kind, ABACUS_ERROR_ARGUMENT);
        EXPECT_NE(std::string(error.message).find("-42"), std::string::npos) << error.message;
        EXPECT_NE(error.hint[0], '\0');
        EXPECT_EQ(header.facts.census.staged, 0u);
        EXPECT_TRUE(host.staged_pages.empty());
        EXPECT_EQ(host.bytes, 0u);
    }
}

TYPED_TEST(Staging, EveryHostCallMayFail) {
    constexpr int D = TypeParam::value;
    for (const Kind kind : {Kind::uniform, Kind::heavy}) {
        const Input<D> input = with_ids<D>(points<D>(kind, 12000));
        bool done = false;
        for (std::uint64_t n = 1; !done; n += n < 40 ? 1 : n / 10) {
            MemoryHost host;
            host.on_progress = [&](const abacus_progress &) { host.interrupted = 1; };
            host.fail_at(n);
            abacus_error error{};
            abacus_header header = empty_header<D>();
            const abacus_status status = stage<D>(host, header, input, tiny, error, 3000);
            done = !host.failed;
            EXPECT_EQ(status, done ? ABACUS_OK : ABACUS_HOST_ERROR);
            EXPECT_EQ(header.facts.census.staged, done ? input.size() : 0);
            EXPECT_EQ(host.bytes, 0u);
            EXPECT_TRUE(host.violations.empty()) << host.violations[0];
        }
    }
}

TYPED_TEST(Staging, MemoryMayRunOut) {
    constexpr int D = TypeParam::value;
    for (const Kind kind : {Kind::uniform, Kind::heavy}) {
        const Input<D> input = with_ids<D>(points<D>(kind, 12000));
        for (std::uint64_t n = 1;; ++n) {
            MemoryHost host;
            host.fail_resize_at(n);
            abacus_error error{};
            abacus_header header = empty_header<D>();
            const abacus_status status = stage<D>(host, header, input, tiny, error);
            EXPECT_EQ(host.bytes, 0u);
            EXPECT_TRUE(host.violations.empty()) << host.violations[0];
            if (status == ABACUS_OK) break;
            EXPECT_EQ(status, ABACUS_ERROR);
            EXPECT_EQ(error.kind, ABACUS_ERROR_MEMORY);
            EXPECT_EQ(header.facts.census.staged, 0u);
        }
    }
}

TYPED_TEST(Staging, StatementsCanBeCancelledInEveryPhase) {
    constexpr int D = TypeParam::value;
    const Input<D> input = with_ids<D>(points<D>(Kind::uniform, 60000));
    for (const std::size_t memory : {tiny, ample}) {
        for (const abacus_phase phase :
             {ABACUS_PHASE_READING, ABACUS_PHASE_SORTING, ABACUS_PHASE_STAGING}) {
            MemoryHost host;
            host.on_progress = [&](const abacus_progress &progress) {
                if (progress.phase == phase) host.cancel();
            };
            abacus_error error{};
            abacus_header header = empty_header<D>();
            EXPECT_EQ(stage<D>(host, header, input, memory, error), ABACUS_HOST_ERROR);
            EXPECT_EQ(host.last_progress.phase, phase);
            EXPECT_EQ(host.bytes, 0u);
            EXPECT_TRUE(host.violations.empty()) << host.violations[0];
        }
    }
}

TYPED_TEST(Staging, MemoryAndSpoolsAreBounded) {
    constexpr int D = TypeParam::value;
    for (const Kind kind : all_kinds) {
        SCOPED_TRACE(static_cast<int>(kind));
        const Input<D> input = with_ids<D>(points<D>(kind, 200000));
        for (const std::size_t memory : {std::size_t{1} << 19, std::size_t{2} << 20}) {
            MemoryHost host;
            abacus_error error{};
            abacus_header header = empty_header<D>();
            ASSERT_EQ(stage<D>(host, header, input, memory, error), ABACUS_OK);
            EXPECT_LE(host.peak_bytes, memory);
            EXPECT_GT(host.calls.spool_create, 0u);
            EXPECT_LE(host.peak_spools, 256u);
            EXPECT_TRUE(host.spools.empty());
            EXPECT_EQ(host.last_progress.done, input.size());
            EXPECT_EQ(host.last_progress.pages_written, host.staged_pages.size());
        }
    }
}

TYPED_TEST(Staging, DamagedPagesAreFound) {
    constexpr int D = TypeParam::value;
    MemoryHost host;
    abacus_error error{};
    abacus_header header = empty_header<D>(1);
    Input<D> input = with_ids<D>(points<D>(Kind::uniform, 100));
    for (auto &point : input) point.attributes.push_back(0);
    ASSERT_EQ(stage<D>(host, header, input, ample, error), ABACUS_OK);
    const MemoryHost::Page sound = host.staged_pages.at({0, 0});

    const auto opens = [](MemoryHost::Page page, std::uint64_t first = 0) {
        try {
            VertexPage<D>(page.words.data(), page.size, 1, {first, 0});
            return true;
        } catch (const Error &e) {
            EXPECT_EQ(e.kind, ABACUS_ERROR_CORRUPTED);
            return false;
        }
    };
    EXPECT_TRUE(opens(sound));
    EXPECT_FALSE(opens(sound, 1));
    for (std::size_t size = 0; size < sound.size; ++size) {
        MemoryHost::Page page = sound;
        page.size = size;
        EXPECT_FALSE(opens(page));
    }
    for (std::size_t byte = 0; byte < sizeof(VertexPageHeader); ++byte) {
        MemoryHost::Page page = sound;
        page.bytes()[byte] ^= 0x81;
        EXPECT_FALSE(opens(page)) << byte;
    }
    for (const double bad : {std::numeric_limits<double>::infinity(), std::nan(""), -0.0}) {
        MemoryHost::Page page = sound;
        page.words[VertexPageHeader::words + 50 * (2 + D) + D] = std::bit_cast<std::uint64_t>(bad);
        EXPECT_FALSE(opens(page));
    }
}

TEST(StagingHandle, RefusesOtherDimensions) {
    MemoryHost host;
    abacus_error error{};
    abacus_header header = empty_header<2>();
    header.facts.form.dimension = 4;
    abacus_stage *handle = nullptr;
    EXPECT_EQ(abacus_stage_open(host.table(), &header.facts, ample, &handle, &error), ABACUS_ERROR);
    EXPECT_EQ(error.kind, ABACUS_ERROR_ARGUMENT);
    EXPECT_EQ(host.bytes, 0u);
}

} // namespace
} // namespace abacus
