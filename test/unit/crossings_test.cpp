// Segments that cross, against all pairs compared in rational numbers.
#include "support/memory_host.hpp"
#include "support/point_sets.hpp"

#include <CGAL/Exact_rational.h>
#include <abacus/crossings.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <set>
#include <tuple>

namespace abacus::test {
namespace {

using Rational = CGAL::Exact_rational;
using Segments = std::vector<abacus_line_segment>;
using Pair = std::tuple<std::int64_t, std::int64_t, std::int64_t, std::int64_t>;

struct Found {
    Pair pair;
    double x, y;
    bool is_exact;

    bool operator==(const Found &) const = default;
};
using Crossings = std::vector<Found>;

constexpr std::size_t plenty = 64 << 20, little = 1 << 20, tiny = 0;

/// Checks that nothing is left in the host.
Crossings found_by(const Segments &segments, std::size_t memory, MemoryHost &store) {
    Crossings result;
    abacus_error error{};
    abacus_crossings *crossings = nullptr;
    EXPECT_EQ(abacus_crossings_open(store.table(), memory, &crossings, &error), ABACUS_OK);
    EXPECT_EQ(abacus_crossings_add(crossings, segments.data(), segments.size(), &error), ABACUS_OK)
        << error.message;
    std::uint64_t count = 0;
    EXPECT_EQ(abacus_crossings_count(crossings, &count, &error), ABACUS_OK) << error.message;
    abacus_crossing c;
    while (abacus_crossings_next(crossings, &c, &error) == ABACUS_OK)
        result.push_back({{c.line[0], c.position[0], c.line[1], c.position[1]},
                          c.place[0],
                          c.place[1],
                          c.is_exact != 0});
    EXPECT_EQ(count, result.size());
    abacus_crossings_close(crossings);
    EXPECT_EQ(store.violations, std::vector<std::string>{});
    EXPECT_EQ(store.bytes, 0u);
    EXPECT_TRUE(store.spools.empty());
    return result;
}
Crossings found_by(const Segments &segments, std::size_t memory = plenty) {
    MemoryHost store;
    return found_by(segments, memory, store);
}

struct Exact {
    Rational x, y;
    explicit Exact(const double *p) : x(p[0]), y(p[1]) {}
    Exact(Rational x, Rational y) : x(std::move(x)), y(std::move(y)) {}
};
Rational area(const Exact &a, const Exact &b, const Exact &c) {
    return (b.x - a.x) * (c.y - a.y) - (b.y - a.y) * (c.x - a.x);
}
int side(const Exact &a, const Exact &b, const Exact &c) { return CGAL::sign(area(a, b, c)); }

/// Whether no double is nearer to x.
bool is_nearest(double rounded, const Rational &x) {
    const auto distance = [&](double d) { return CGAL::abs(Rational(d) - x); };
    return distance(rounded) <= distance(std::nextafter(rounded, INFINITY)) &&
           distance(rounded) <= distance(std::nextafter(rounded, -INFINITY));
}

/// Compares what was found with all pairs.
void expect_right(Segments segments, const Crossings &found) {
    std::sort(segments.begin(), segments.end(), [](const auto &a, const auto &b) {
        return std::tie(a.line, a.position) < std::tie(b.line, b.position);
    });
    std::set<std::pair<Rational, Rational>> ends;
    for (const auto &s : segments) {
        ends.emplace(s.a[0], s.a[1]);
        ends.emplace(s.b[0], s.b[1]);
    }
    const auto is_end = [&](const Exact &p) { return ends.count({p.x, p.y}) > 0; };
    std::size_t at = 0;
    for (std::size_t i = 0; i < segments.size(); ++i)
        for (std::size_t k = i + 1; k < segments.size(); ++k) {
            const auto &s = segments[i], &t = segments[k];
            const auto lies_before = [](const auto &one, const auto &other, int axis) {
                return std::max(one.a[axis], one.b[axis]) < std::min(other.a[axis], other.b[axis]);
            };
            if (lies_before(s, t, 0) || lies_before(t, s, 0) || lies_before(s, t, 1) ||
                lies_before(t, s, 1))
                continue;
            const Exact a(s.a), b(s.b), c(t.a), d(t.b);
            if (side(a, b, c) * side(a, b, d) >= 0 || side(c, d, a) * side(c, d, b) >= 0) continue;
            const Rational from_c = area(a, b, c), from_d = area(a, b, d);
            const Rational along = from_c / (from_c - from_d);
            const Exact place(c.x + along * (d.x - c.x), c.y + along * (d.y - c.y));
            if (is_end(place)) continue;
            ASSERT_LT(at, found.size());
            const Found &f = found[at++];
            ASSERT_EQ(f.pair, Pair(s.line, s.position, t.line, t.position));
            EXPECT_TRUE(is_nearest(f.x, place.x) && is_nearest(f.y, place.y));
            EXPECT_EQ(f.is_exact, Rational(f.x) == place.x && Rational(f.y) == place.y);
        }
    EXPECT_EQ(at, found.size());
}

class CrossingSegments : public testing::Test {
protected:
    double number() { return unit(random); }
    std::int64_t whole(int n) { return static_cast<std::int64_t>(number() * n); }
    void add(double ax, double ay, double bx, double by) {
        const auto n = static_cast<std::int64_t>(segments.size());
        segments.push_back({n % 7 - 3, n, {ax, ay}, {bx, by}});
    }
    /// Compares with all pairs, then shuffled and in less memory.
    void expect_right_whatever_the_order() {
        const Crossings found = found_by(segments);
        expect_right(segments, found);
        for (const std::size_t memory : {plenty, little, tiny}) {
            std::shuffle(segments.begin(), segments.end(), random);
            EXPECT_EQ(found_by(segments, memory), found) << memory;
        }
    }

    Random random{56};
    Segments segments;
};

TEST_F(CrossingSegments, NoneAndOne) {
    EXPECT_TRUE(found_by({}).empty());
    add(0, 0, 2, 2);
    EXPECT_TRUE(found_by(segments).empty());
    add(0, 2, 2, 0);
    const Crossings found = found_by(segments);
    ASSERT_EQ(found.size(), 1u);
    EXPECT_EQ(found[0], (Found{{-3, 0, -2, 1}, 1, 1, true}));
}

TEST_F(CrossingSegments, ContactsAreNone) {
    add(0, 0, 4, 0);
    add(4, 0, 6, 3);  // in an end
    add(1, 0, 1, 5);  // T
    add(2, 0, 9, 0);  // along a stretch
    add(0, 0, 4, 0);  // the same
    add(4, 0, 0, 0);  // ... the other way
    add(3, 0, 3, 0);  // of length 0
    add(-2, 0, 0, 0); // one after the other
    EXPECT_TRUE(found_by(segments).empty());
    add(3.5, -1, 3.5, 1);
    EXPECT_EQ(found_by(segments).size(), 4u);
    add(3, -1, 3, 1); // at the end of others
    EXPECT_EQ(found_by(segments).size(), 4u);
    expect_right_whatever_the_order();
}

TEST_F(CrossingSegments, AtRandom) {
    for (int i = 0; i < 150; ++i) add(number(), number(), number(), number());
    expect_right_whatever_the_order();
}

TEST_F(CrossingSegments, ShortOnes) {
    for (int i = 0; i < 3000; ++i) {
        const double x = number(), y = number();
        add(x, y, x + 0.05 * (number() - 0.5), y + 0.05 * (number() - 0.5));
    }
    expect_right_whatever_the_order();
}

TEST_F(CrossingSegments, OnAGrid) {
    for (int i = 0; i < 250; ++i)
        add(static_cast<double>(whole(9)), static_cast<double>(whole(9)),
            static_cast<double>(whole(9)), static_cast<double>(whole(9)));
    expect_right_whatever_the_order();
}

TEST_F(CrossingSegments, OfAStar) {
    for (int i = 0; i < 200; ++i) {
        const double x = number() - 0.5, y = number() - 0.5;
        if (i % 2 == 0)
            add(0, 0, x, y);
        else
            add(-x, -y, x, y); // through its middle
    }
    expect_right_whatever_the_order();
}

TEST_F(CrossingSegments, LongDiagonals) {
    for (int i = 0; i < 400; ++i) add(number() * 0.01, i, 100 + number() * 0.01, i + 100);
    for (int i = 0; i < 5; ++i) add(10 * i, 500, 10 * i + number(), 0);
    expect_right_whatever_the_order();
}

TEST_F(CrossingSegments, Vertical) {
    for (int i = 0; i < 500; ++i) {
        const double y = number();
        add(0.5, y, 0.5, y + 0.01);
    }
    for (int i = 0; i < 100; ++i) add(0.4, number(), 0.6, number());
    expect_right_whatever_the_order();
}

TEST_F(CrossingSegments, HardlyApart) {
    const double step = 1e-15;
    for (int i = 0; i < 300; ++i)
        add(0.1 + static_cast<double>(whole(4)) * step, 0.1 + static_cast<double>(whole(4)) * step,
            0.9 + static_cast<double>(whole(4)) * step, 0.9 + static_cast<double>(whole(4)) * step);
    for (int i = 0; i < 100; ++i) {
        const double at = 0.5 + static_cast<double>(whole(20)) * step;
        add(at, at, at + static_cast<double>(whole(7) - 3) * step,
            at + static_cast<double>(whole(7) - 3) * step);
    }
    expect_right_whatever_the_order();
}

TEST_F(CrossingSegments, LargeAndSmallNumbers) {
    for (int i = 0; i < 100; ++i) {
        const double size = std::ldexp(1.0, static_cast<int>(whole(2000)) - 1000);
        add(size * (number() - 0.5), size * (number() - 0.5), size * (number() - 0.5),
            size * (number() - 0.5));
    }
    expect_right_whatever_the_order();
}

// Many more are held than there is room for.
TEST_F(CrossingSegments, InLittleMemory) {
    for (int i = 0; i < 2500; ++i) {
        const double y = number(), length = number() < 0.7 ? 1 : 0.01, x = number();
        add(x, y, x + length, y + 0.001 * (number() - 0.5));
    }
    const Crossings found = found_by(segments);
    expect_right(segments, found);
    MemoryHost store;
    EXPECT_EQ(found_by(segments, tiny, store), found);
    EXPECT_GT(store.calls.spool_create, 0u);
    EXPECT_LT(store.peak_bytes, 2u << 20);
}

TEST_F(CrossingSegments, CornersOfLines) {
    MemoryHost store;
    abacus_error error{};
    abacus_crossings *crossings = nullptr;
    std::vector<std::array<std::uint64_t, 5>> corners;
    const auto corner = [&](std::int64_t line, std::int64_t position, double x, double y,
                            std::uint64_t part = 0) {
        corners.push_back({static_cast<std::uint64_t>(line), static_cast<std::uint64_t>(position),
                           std::bit_cast<std::uint64_t>(x), std::bit_cast<std::uint64_t>(y), part});
    };
    corner(7, 50, 0.5, 3, 1); // another part, which is not joined to the first
    corner(7, 60, 0.5, 4, 1);
    corner(7, 30, 1, 3); // crosses itself
    corner(7, -5, 0, 0);
    corner(7, 20, 4, 2);
    corner(7, 40, 3, -1);
    corner(-1, 1, 0, 0);
    ASSERT_EQ(abacus_crossings_open(store.table(), tiny, &crossings, &error), ABACUS_OK);
    ASSERT_EQ(abacus_crossings_add_corners(crossings, corners[0].data(), corners.size(), &error),
              ABACUS_OK);
    abacus_crossing c;
    ASSERT_EQ(abacus_crossings_next(crossings, &c, &error), ABACUS_OK) << error.message;
    EXPECT_EQ(c.position[0], -5);
    EXPECT_EQ(c.position[1], 30);
    EXPECT_EQ(c.place[0], 2);
    EXPECT_EQ(c.place[1], 1);
    EXPECT_EQ(c.is_exact, 1);
    EXPECT_EQ(abacus_crossings_next(crossings, &c, &error), ABACUS_END);
    abacus_crossings_close(crossings);

    corner(7, 20, 9, 9);
    ASSERT_EQ(abacus_crossings_open(store.table(), tiny, &crossings, &error), ABACUS_OK);
    ASSERT_EQ(abacus_crossings_add_corners(crossings, corners[0].data(), corners.size(), &error),
              ABACUS_OK);
    EXPECT_EQ(abacus_crossings_next(crossings, &c, &error), ABACUS_ERROR);
    EXPECT_STREQ(error.message, "line 7 has position 20 twice");
    abacus_crossings_close(crossings);
    EXPECT_EQ(store.bytes, 0u);
}

TEST_F(CrossingSegments, OfNoNumbers) {
    MemoryHost store;
    abacus_error error{};
    abacus_crossings *crossings = nullptr;
    ASSERT_EQ(abacus_crossings_open(store.table(), tiny, &crossings, &error), ABACUS_OK);
    const abacus_line_segment bad{1, 2, {0, 0}, {NAN, 1}};
    EXPECT_EQ(abacus_crossings_add(crossings, &bad, 1, &error), ABACUS_ERROR);
    EXPECT_EQ(error.kind, ABACUS_ERROR_ARGUMENT);
    abacus_crossings_close(crossings);
}

// Whatever fails, and a cancelled statement.
TEST_F(CrossingSegments, Failures) {
    for (int i = 0; i < 3000; ++i) {
        const double x = number(), y = number();
        add(x, y, x + 0.1 * number(), y + 0.1 * number());
    }
    MemoryHost counting;
    found_by(segments, tiny, counting);
    const std::uint64_t calls = counting.calls.fallible();
    for (std::uint64_t n = 1; n <= calls; n += 1 + calls / 20) {
        MemoryHost store;
        store.fail_at(n);
        abacus_error error{};
        abacus_crossings *crossings = nullptr;
        ASSERT_EQ(abacus_crossings_open(store.table(), tiny, &crossings, &error), ABACUS_OK);
        abacus_status status =
            abacus_crossings_add(crossings, segments.data(), segments.size(), &error);
        abacus_crossing c;
        while (status == ABACUS_OK) status = abacus_crossings_next(crossings, &c, &error);
        EXPECT_EQ(status, ABACUS_HOST_ERROR) << n;
        abacus_crossings_close(crossings);
        EXPECT_EQ(store.bytes, 0u);
        EXPECT_EQ(store.violations, std::vector<std::string>{});
    }
    MemoryHost store;
    store.cancel();
    abacus_error error{};
    abacus_crossings *crossings = nullptr;
    ASSERT_EQ(abacus_crossings_open(store.table(), plenty, &crossings, &error), ABACUS_OK);
    abacus_crossings_add(crossings, segments.data(), segments.size(), &error);
    std::uint64_t count;
    EXPECT_EQ(abacus_crossings_count(crossings, &count, &error), ABACUS_HOST_ERROR);
    abacus_crossings_close(crossings);
}

// As many as contour lines have; more than a pair in ten thousand compared would take minutes.
TEST_F(CrossingSegments, AHundredThousand) {
    for (int i = 0; i < 100000; ++i) {
        const double x = number(), y = number();
        add(x, y, x + 0.002 * (number() - 0.5), y + 0.002 * (number() - 0.5));
    }
    const Crossings found = found_by(segments);
    EXPECT_EQ(found_by(segments, little), found);
    EXPECT_GT(found.size(), 1000u);
}

} // namespace
} // namespace abacus::test
