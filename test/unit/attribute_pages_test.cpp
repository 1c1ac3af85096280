// Attributes in pages of their own: against a map, over a store in memory.
#include "attributes/attribute_pages.hpp"
#include "attributes/attribute_reader.hpp"
#include "mesh/page_format.hpp"
#include "support/memory_host.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <map>
#include <random>
#include <vector>

namespace abacus {
namespace {

template <int D> Domain<D> unit_domain() {
    Point<D> lower{}, upper;
    upper.fill(1);
    return {lower, upper};
}

/// Points of a domain of 1 in which nothing is special, or many share a code.
template <int D> class Places {
public:
    explicit Places(unsigned seed, bool crowded) : random_(seed), crowded_(crowded) {}

    Point<D> next() {
        std::uniform_real_distribution<double> unit(0, 1);
        Point<D> p;
        for (double &x : p) x = crowded_ ? 0.3 + 1e-13 * unit(random_) : unit(random_);
        return p;
    }

private:
    std::mt19937_64 random_;
    bool crowded_;
};

template <int D> class Model {
public:
    explicit Model(unsigned attributes, bool compressible = false)
        : attributes_(attributes), compressible_(compressible), pages_(host_, domain_, attributes) {
    }

    std::vector<double> values() {
        std::vector<double> values(attributes_);
        std::normal_distribution<double> normal;
        for (double &value : values)
            value = compressible_ ? double(random_() % 4) : normal(random_) * 1e3;
        if (random_() % 50 == 0) values[random_() % attributes_] = NAN;
        if (random_() % 50 == 0) values[random_() % attributes_] = -0.0;
        return values;
    }
    void put(const Point<D> &p) {
        known_[p] = values();
        pages_.put(p, domain_.code(p), known_[p].data());
    }
    void put_new(const Point<D> &p) {
        const auto given = values();
        known_.emplace(p, given);
        pages_.put_new(p, domain_.code(p), given.data());
    }
    void drop(const Point<D> &p) {
        known_.erase(p);
        pages_.drop(p, domain_.code(p));
    }
    /// In the order of the curve, as a round of insertions.
    void put_in_order(const std::vector<Point<D>> &points) {
        for (const Point<D> &p : in_order(points)) put(p);
    }
    std::vector<Point<D>> in_order(std::vector<Point<D>> points) const {
        std::sort(points.begin(), points.end(), [&](const Point<D> &a, const Point<D> &b) {
            return domain_.code(a) < domain_.code(b);
        });
        return points;
    }
    Point<D> any() {
        return std::next(known_.begin(), static_cast<std::ptrdiff_t>(random_() % known_.size()))
            ->first;
    }

    void flush() {
        pages_.flush();
        pages_.forget();
    }
    /// What readers find is what has been put.
    void verify(std::size_t bytes = 1 << 16) {
        const auto is_same = [](double a, double b) {
            return std::bit_cast<std::uint64_t>(a) == std::bit_cast<std::uint64_t>(b);
        };
        AttributeReader<D> reader(host_, domain_, attributes_, bytes);
        std::vector<double> all(attributes_);
        for (const auto &[p, values] : known_) {
            ASSERT_TRUE(reader.contains(p));
            reader.values(p, all.data());
            for (unsigned i = 0; i < attributes_; ++i) {
                ASSERT_TRUE(is_same(all[i], values[i]));
                ASSERT_TRUE(is_same(reader.value(p, i), values[i]));
            }
        }
        Places<D> elsewhere(77, false);
        for (int i = 0; i < 100; ++i) ASSERT_FALSE(reader.contains(elsewhere.next()));
        AttributeScan<D> scan(host_, domain_, attributes_);
        std::size_t vertices = 0;
        while (scan.fetch()) {
            scan.read();
            vertices += scan.vertices();
        }
        EXPECT_EQ(vertices, known_.size() * AttributeGroups(attributes_).count());
        EXPECT_EQ(host_.violations(), std::vector<std::string>{});
    }
    double fill() const {
        std::size_t bytes = 0;
        for (const auto &[key, page] : pages()) bytes += page.size;
        return double(bytes) / (double(pages().size()) * ABACUS_PAGE_BYTES);
    }
    const MemoryHost::Pages &pages() const { return memory_.attribute_pages; }
    MemoryHost::Pages &pages() { return memory_.attribute_pages; }
    std::size_t count() const { return known_.size(); }
    const std::vector<double> &known(const Point<D> &p) const { return known_.at(p); }
    AttributePages<D> &writer() { return pages_; }
    const Domain<D> &domain() const { return domain_; }
    const Host &host() const { return host_.host; }

private:
    struct TestHost {
        MemoryHost &memory;
        Host host{*memory.table()};
        operator const Host &() const { return host; }
        std::vector<std::string> violations() const { return memory.violations; }
    };

    MemoryHost memory_;
    TestHost host_{memory_};
    Domain<D> domain_ = unit_domain<D>();
    unsigned attributes_;
    bool compressible_;
    AttributePages<D> pages_;
    std::map<Point<D>, std::vector<double>> known_;
    std::mt19937_64 random_{1};
};

template <class T> class Attributes : public testing::Test {};
using Dimensions = testing::Types<std::integral_constant<int, 2>, std::integral_constant<int, 3>>;
TYPED_TEST_SUITE(Attributes, Dimensions);

TYPED_TEST(Attributes, AreFoundWhereTheyWerePut) {
    constexpr int D = TypeParam::value;
    for (const unsigned attributes : {1u, 5u, 33u, 100u})
        for (const bool compressible : {false, true})
            for (const bool crowded : {false, true}) {
                Model<D> model(attributes, compressible);
                Places<D> places(attributes, crowded);
                for (int i = 0; i < 300; ++i) model.put(places.next()); // in no order
                std::vector<Point<D>> round;
                for (int i = 0; i < 900; ++i) round.push_back(places.next());
                model.put_in_order(round);
                model.flush();
                model.verify();
                if (testing::Test::HasFatalFailure()) return;
            }
}

TYPED_TEST(Attributes, ChangeAndGo) {
    constexpr int D = TypeParam::value;
    for (const unsigned attributes : {3u, 40u})
        for (const bool crowded : {false, true}) {
            Model<D> model(attributes);
            Places<D> places(9, crowded);
            std::mt19937_64 random(3);
            for (int i = 0; i < 3000; ++i) {
                // More and more, then less and less.
                const bool grows = random() % 3000 > static_cast<unsigned>(i);
                if (model.count() < 5 || grows)
                    model.put(places.next());
                else if (random() % 4 == 0)
                    model.put(model.any());
                else if (random() % 4 == 0)
                    model.put_new(model.any());
                else
                    model.drop(model.any());
                if (i % 600 == 599) {
                    model.flush();
                    model.verify(i % 1200 == 599 ? 0 : 1 << 20);
                    if (testing::Test::HasFatalFailure()) return;
                }
            }
            const std::size_t most = model.pages().size();
            while (model.count() > 1) model.drop(model.any());
            model.flush();
            model.verify();
            EXPECT_LE(model.pages().size(), std::max<std::size_t>(2, most / 4));
            model.drop(model.any());
            model.flush();
            EXPECT_TRUE(model.pages().empty());
        }
}

TYPED_TEST(Attributes, RoundsAlongTheCurveLeaveFullPages) {
    constexpr int D = TypeParam::value;
    for (const unsigned attributes : {4u, 60u}) {
        Model<D> model(attributes);
        Places<D> places(5, false);
        for (const int points : {20, 600, 12000}) {
            std::vector<Point<D>> round;
            for (int i = 0; i < points; ++i) round.push_back(places.next());
            model.put_in_order(round);
        }
        model.flush();
        model.verify();
        EXPECT_GT(model.fill(), 0.95);
    }
}

/// Pages are written if what they hold changes, and only these.
TYPED_TEST(Attributes, WritesOnlyPagesThatChange) {
    constexpr int D = TypeParam::value;
    constexpr unsigned attributes = 100, changed = 40;
    Model<D> model(attributes);
    AttributePages<D> &pages = model.writer();
    Places<D> places(5, false);
    std::vector<Point<D>> points;
    for (int i = 0; i < 500; ++i) points.push_back(places.next());
    model.put_in_order(points);
    model.flush();
    const auto of_group = static_cast<std::uint64_t>(
        std::count_if(model.pages().begin(), model.pages().end(), [&](const auto &entry) {
            return group_of(entry.first) == AttributeGroups(attributes).group_of(changed);
        }));
    ASSERT_GT(of_group, 1u);
    ASSERT_LT(of_group, model.pages().size() / 3);
    std::vector<std::uint32_t> all(attributes);
    for (std::uint32_t i = 0; i < attributes; ++i) all[i] = i;
    std::vector<double> values(attributes);
    // As it is; then another value of one attribute, by all; then the same by its number.
    for (const double step : {0.0, 1.0, 2.0, 3.0}) {
        pages.take_counters();
        for (const Point<D> &p : model.in_order(points)) {
            values = model.known(p);
            if (step > 0) values[changed] = step;
            const std::uint64_t code = model.domain().code(p);
            if (step == 2)
                ASSERT_TRUE(pages.set(p, code, all, values.data()));
            else if (step == 3)
                ASSERT_TRUE(pages.set(p, code, {{changed}}, &values[changed]));
            else
                pages.put(p, code, values.data());
        }
        model.flush();
        const abacus_counters counters = pages.take_counters();
        EXPECT_GT(counters.loads, 0u);
        EXPECT_EQ(counters.stores, step == 0 ? 0 : of_group) << step;
    }
}

/// A page with vertices behind the beginning of the next one is not taken in.
TYPED_TEST(Attributes, AForgedNeighbourIsRefused) {
    constexpr int D = TypeParam::value;
    Model<D> model(3);
    Places<D> places(5, false);
    std::vector<Point<D>> all;
    for (int i = 0; i < 2000; ++i) all.push_back(places.next());
    model.put_in_order(all);
    model.flush();
    ASSERT_GT(model.pages().size(), 3u);
    const auto second = std::next(model.pages().begin()), third = std::next(second);
    second->second.words = third->second.words;
    second->second.size = third->second.size;
    AttributePages<D> &pages = model.writer();
    const auto shrink = [&] {
        for (const Point<D> &p : all) {
            const std::uint64_t code = model.domain().code(p);
            if (attribute_key<D>(p, code) < second->first) pages.drop(p, code);
        }
        pages.flush();
    };
    EXPECT_THROW(shrink(), Error);
}

/// Bytes of any kind are an error, or are read as something.
TYPED_TEST(Attributes, DamageIsRefused) {
    constexpr int D = TypeParam::value;
    Model<D> model(3);
    Places<D> places(5, false);
    for (int i = 0; i < 2000; ++i) model.put(places.next());
    model.flush();
    std::mt19937_64 random(1);
    const MemoryHost::Pages sound = model.pages();
    int refused = 0;
    for (int i = 0; i < 1500; ++i) {
        auto damaged =
            std::next(model.pages().begin(), static_cast<std::ptrdiff_t>(random() % sound.size()));
        const std::size_t at = i % 2 == 0 ? random() % 120 : random() % damaged->second.size;
        damaged->second.bytes()[at] ^= static_cast<unsigned char>(1 + random() % 255);
        if (i % 3 != 0) seal_page(damaged->second.bytes(), damaged->second.size);
        try {
            AttributeScan<D> scan(model.host(), model.domain(), 3);
            while (scan.fetch()) scan.read();
        } catch (const Error &error) {
            ++refused;
            EXPECT_EQ(error.kind, ABACUS_ERROR_CORRUPTED);
        }
        model.pages() = sound;
    }
    EXPECT_GT(refused, 500);
}

TYPED_TEST(Attributes, AMissingPageIsNoticed) {
    constexpr int D = TypeParam::value;
    Model<D> model(3);
    Places<D> places(5, false);
    std::vector<Point<D>> all;
    for (int i = 0; i < 2000; ++i) all.push_back(places.next());
    model.put_in_order(all);
    model.flush();
    ASSERT_GT(model.pages().size(), 3u);
    model.pages().erase(std::next(model.pages().begin()));
    AttributeReader<D> reader(model.host(), model.domain(), 3, 1 << 16);
    int missing = 0;
    for (const Point<D> &p : all) {
        if (reader.contains(p)) continue;
        ++missing;
        EXPECT_THROW(reader.value(p, 0), Error);
        double values[3];
        EXPECT_THROW(model.writer().get(p, model.domain().code(p), values), Error);
        EXPECT_THROW(model.writer().drop(p, model.domain().code(p)), Error);
    }
    EXPECT_GT(missing, 50);
}

} // namespace
} // namespace abacus
