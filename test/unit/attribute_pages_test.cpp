// Attributes in pages of their own: compared with a map, over a store in memory.
#include "attributes/attribute_pages.hpp"
#include "attributes/attribute_reader.hpp"
#include "mesh/page_format.hpp"
#include "support/memory_host.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <map>
#include <random>
#include <set>
#include <vector>

namespace abacus {
namespace {

template <int D> Domain<D> unit_domain() {
    Point<D> lower{}, upper;
    upper.fill(1);
    return {lower, upper};
}

/// Owners in a domain of extent 1 where nothing is special, or many share a code. Vertices are
/// anywhere; simplices have corners near each other, which they share with others.
template <int D, int K> class Owners {
public:
    explicit Owners(unsigned seed, bool crowded) : random_(seed), crowded_(crowded) {}

    Owner<D, K> next() {
        if constexpr (K == 1) {
            std::uniform_real_distribution<double> unit(0, 1);
            Point<D> p;
            for (double &x : p) x = place(unit(random_));
            return p;
        } else {
            std::array<int, D> cell;
            for (int &i : cell) i = int(random_() % unsigned(cells));
            std::set<Point<D>> corners;
            while (corners.size() < K) {
                std::array<int, D> at = cell;
                for (int &i : at) i += int(random_() % 3);
                corners.insert(corner(at));
            }
            std::array<Point<D>, K> points;
            std::copy(corners.rbegin(), corners.rend(), points.begin());
            return owner_of<D, K>(points);
        }
    }

private:
    static constexpr int cells = D == 2 ? 60 : 14;

    double place(double unit) const { return crowded_ ? 0.3 + 1e-13 * unit : unit; }
    /// A point of a grid, moved by less than a cell.
    Point<D> corner(const std::array<int, D> &at) const {
        std::mt19937_64 random(std::uint64_t(at[0] * 10000 + at[1] * 100 + at[D - 1]));
        std::uniform_real_distribution<double> within(0, 1);
        Point<D> p;
        for (int i = 0; i < D; ++i) p[i] = place((at[i] + within(random)) / (cells + 2));
        return p;
    }

    std::mt19937_64 random_;
    bool crowded_;
};

template <int D, int K> class Model {
public:
    using Name = Owner<D, K>;

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
        if (K > 1 && random_() % 5 == 0) values[random_() % attributes_] = null_value;
        return values;
    }
    void put(const Name &owner) {
        known_[owner] = values();
        pages_.put(owner, code(owner), known_[owner].data());
    }
    void put_new(const Name &owner) {
        const auto given = values();
        known_.emplace(owner, given);
        pages_.put_new(owner, code(owner), given.data());
    }
    void drop(const Name &owner) {
        known_.erase(owner);
        pages_.drop(owner, code(owner));
    }
    /// In the order of the curve, as a round of insertions.
    void put_in_order(const std::vector<Name> &owners) {
        for (const Name &owner : in_order(owners)) put(owner);
    }
    std::vector<Name> in_order(std::vector<Name> owners) const {
        const auto key = [&](const Name &owner) { return attribute_key<D, K>(owner, code(owner)); };
        std::sort(owners.begin(), owners.end(),
                  [&](const Name &a, const Name &b) { return key(a) < key(b); });
        return owners;
    }
    Name any() {
        return std::next(known_.begin(), static_cast<std::ptrdiff_t>(random_() % known_.size()))
            ->first;
    }

    void flush() {
        pages_.flush();
        pages_.forget();
    }
    /// Readers find the stored values.
    void verify(std::size_t bytes = 1 << 16) {
        const auto is_same = [](double a, double b) {
            return std::bit_cast<std::uint64_t>(a) == std::bit_cast<std::uint64_t>(b);
        };
        AttributeReader<D, K> reader(host_, domain_, attributes_, bytes);
        std::vector<double> all(attributes_);
        for (const auto &[owner, values] : known_) {
            ASSERT_TRUE(reader.contains(owner));
            reader.values(owner, all.data());
            for (unsigned i = 0; i < attributes_; ++i) {
                ASSERT_TRUE(is_same(all[i], values[i]));
                ASSERT_TRUE(is_same(reader.value(owner, i), values[i]));
            }
        }
        Owners<D, K> elsewhere(77, false);
        for (int i = 0; i < 100; ++i) {
            const Name owner = elsewhere.next();
            if (known_.contains(owner)) continue;
            ASSERT_FALSE(reader.contains(owner));
            ASSERT_FALSE(reader.values_if_any(owner, all.data()));
            for (const double value : all) ASSERT_TRUE(is_same(value, null_value));
        }
        AttributeScan<D, K> scan(host_, domain_, attributes_);
        std::size_t rows = 0;
        while (scan.fetch()) {
            scan.read();
            rows += scan.page().rows();
        }
        EXPECT_EQ(rows, known_.size() * AttributeGroups(attributes_).count());
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
    const std::vector<double> &known(const Name &owner) const { return known_.at(owner); }
    std::uint64_t code(const Name &owner) const { return code_of<D, K>(domain_, owner); }
    AttributePages<D, K> &writer() { return pages_; }
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
    AttributePages<D, K> pages_;
    std::map<Name, std::vector<double>> known_;
    std::mt19937_64 random_{1};
};

template <class T> class Attributes : public testing::Test {};
/// Vertices and simplices.
template <int dimension, int points> struct Kind {
    static constexpr int D = dimension, K = points;
};
using Kinds = testing::Types<Kind<2, 1>, Kind<3, 1>, Kind<2, 3>, Kind<3, 4>>;
TYPED_TEST_SUITE(Attributes, Kinds);

TYPED_TEST(Attributes, AreFoundWhereTheyWerePut) {
    constexpr int D = TypeParam::D, K = TypeParam::K;
    for (const unsigned attributes : {1u, 5u, 33u, 100u})
        for (const bool compressible : {false, true})
            for (const bool crowded : {false, true}) {
                Model<D, K> model(attributes, compressible);
                Owners<D, K> owners(attributes, crowded);
                for (int i = 0; i < 300; ++i) model.put(owners.next()); // in random order
                std::vector<Owner<D, K>> round;
                for (int i = 0; i < 900; ++i) round.push_back(owners.next());
                model.put_in_order(round);
                model.flush();
                model.verify();
                if (testing::Test::HasFatalFailure()) return;
            }
}

TYPED_TEST(Attributes, ChangeAndGo) {
    constexpr int D = TypeParam::D, K = TypeParam::K;
    for (const unsigned attributes : {3u, 40u})
        for (const bool crowded : {false, true}) {
            Model<D, K> model(attributes);
            Owners<D, K> owners(9, crowded);
            std::mt19937_64 random(3);
            for (int i = 0; i < 3000; ++i) {
                // More and more, then less and less.
                const bool grows = random() % 3000 > static_cast<unsigned>(i);
                if (model.count() < 5 || grows)
                    model.put(owners.next());
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
    constexpr int D = TypeParam::D, K = TypeParam::K;
    for (const unsigned attributes : {4u, 60u}) {
        Model<D, K> model(attributes);
        Owners<D, K> owners(5, false);
        for (const int points : {20, 600, 12000}) {
            std::vector<Owner<D, K>> round;
            for (int i = 0; i < points; ++i) round.push_back(owners.next());
            model.put_in_order(round);
        }
        model.flush();
        model.verify();
        EXPECT_GT(model.fill(), 0.95);
    }
}

/// Only pages whose contents change are written.
TYPED_TEST(Attributes, WritesOnlyPagesThatChange) {
    constexpr int D = TypeParam::D, K = TypeParam::K;
    constexpr unsigned attributes = 100, changed = 40;
    Model<D, K> model(attributes);
    AttributePages<D, K> &pages = model.writer();
    Owners<D, K> owners(5, false);
    std::vector<Owner<D, K>> some;
    for (int i = 0; i < 500; ++i) some.push_back(owners.next());
    model.put_in_order(some);
    model.flush();
    const auto of_group = static_cast<std::uint64_t>(
        std::count_if(model.pages().begin(), model.pages().end(), [&](const auto &entry) {
            return group_of(entry.first) ==
                   first_group<K> + AttributeGroups(attributes).group_of(changed);
        }));
    ASSERT_GT(of_group, 1u);
    ASSERT_LT(of_group, model.pages().size() / 3);
    std::vector<std::uint32_t> all(attributes);
    for (std::uint32_t i = 0; i < attributes; ++i) all[i] = i;
    std::vector<double> values(attributes);
    // Unchanged; then another value of one attribute, for all; then the same by its number.
    for (const double step : {0.0, 1.0, 2.0, 3.0}) {
        pages.take_counters();
        for (const Owner<D, K> &owner : model.in_order(some)) {
            values = model.known(owner);
            if (step > 0) values[changed] = step;
            const std::uint64_t code = model.code(owner);
            if (step == 2)
                ASSERT_TRUE(pages.set(owner, code, all, values.data()));
            else if (step == 3)
                ASSERT_TRUE(pages.set(owner, code, {{changed}}, &values[changed]));
            else
                pages.put(owner, code, values.data());
        }
        model.flush();
        const abacus_counters counters = pages.take_counters();
        EXPECT_GT(counters.loads, 0u);
        EXPECT_EQ(counters.stores, step == 0 ? 0 : of_group) << step;
    }
}

/// A page with owners beyond the beginning of the next one is rejected.
TYPED_TEST(Attributes, AForgedNeighbourIsRefused) {
    constexpr int D = TypeParam::D, K = TypeParam::K;
    Model<D, K> model(3);
    Owners<D, K> owners(5, false);
    std::vector<Owner<D, K>> all;
    for (int i = 0; i < 2000; ++i) all.push_back(owners.next());
    model.put_in_order(all);
    model.flush();
    ASSERT_GT(model.pages().size(), 3u);
    const auto second = std::next(model.pages().begin()), third = std::next(second);
    second->second.words = third->second.words;
    second->second.size = third->second.size;
    AttributePages<D, K> &pages = model.writer();
    const auto shrink = [&] {
        for (const Owner<D, K> &owner : all) {
            const std::uint64_t code = model.code(owner);
            const Key key = in_group(attribute_key<D, K>(owner, code), first_group<K>);
            if (key < second->first) pages.erase(owner, code); // some are stored twice
        }
        pages.flush();
    };
    EXPECT_THROW(shrink(), Error);
}

/// Arbitrary bytes are an error, or can be read.
TYPED_TEST(Attributes, DamageIsRefused) {
    constexpr int D = TypeParam::D, K = TypeParam::K;
    Model<D, K> model(3);
    Owners<D, K> owners(5, false);
    for (int i = 0; i < 2000; ++i) model.put(owners.next());
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
            AttributeScan<D, K> scan(model.host(), model.domain(), 3);
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
    constexpr int D = TypeParam::D, K = TypeParam::K;
    Model<D, K> model(3);
    Owners<D, K> owners(5, false);
    std::vector<Owner<D, K>> all;
    for (int i = 0; i < 2000; ++i) all.push_back(owners.next());
    model.put_in_order(all);
    model.flush();
    ASSERT_GT(model.pages().size(), 3u);
    model.pages().erase(std::next(model.pages().begin()));
    AttributeReader<D, K> reader(model.host(), model.domain(), 3, 1 << 16);
    int missing = 0;
    for (const Owner<D, K> &owner : all) {
        if (reader.contains(owner)) continue;
        ++missing;
        EXPECT_THROW(reader.value(owner, 0), Error);
        double values[3];
        EXPECT_THROW(model.writer().get(owner, model.code(owner), values), Error);
        EXPECT_THROW(model.writer().drop(owner, model.code(owner)), Error);
    }
    EXPECT_GT(missing, 50);
}

/// Each kind has pages of its own, separate from the others.
template <int D> void kinds_are_apart() {
    MemoryHost memory;
    const Host host{*memory.table()};
    const Domain<D> domain = unit_domain<D>();
    AttributePages<D> vertices(host, domain, 40);
    AttributePages<D, D + 1> labels(host, domain, 40), markers(host, domain, D + 1, marker_group);
    std::map<Owner<D, 1>, double> of_vertices;
    std::map<Owner<D, D + 1>, double> of_labels, of_markers;
    const auto fill = [&]<int K>(AttributePages<D, K> &pages, std::map<Owner<D, K>, double> &known,
                                 int more) {
        Owners<D, K> owners(K, false); // labels and markers have the same ones
        for (int i = 0; i < 1000; ++i) known[owners.next()] = i + more;
        std::vector<double> values(40);
        std::vector<Owner<D, K>> along; // in the order of the curve
        for (const auto &[owner, value] : known) along.push_back(owner);
        const auto code = [&](const auto &owner) { return code_of<D, K>(domain, owner); };
        std::sort(along.begin(), along.end(),
                  [&](const auto &x, const auto &y) { return code(x) < code(y); });
        for (const auto &owner : along) {
            values[0] = known[owner];
            pages.put(owner, code(owner), values.data());
        }
        pages.flush();
    };
    fill.template operator()<D + 1>(labels, of_labels, 0);
    fill.template operator()<1>(vertices, of_vertices, 0);
    fill.template operator()<D + 1>(markers, of_markers, 10000);
    const auto verify = [&]<int K>(const std::map<Owner<D, K>, double> &known, unsigned count,
                                   unsigned first) {
        AttributeReader<D, K> reader(host, domain, count, 1 << 20, first);
        for (const auto &[owner, value] : known) ASSERT_EQ(reader.value(owner, 0), value);
        AttributeScan<D, K> scan(host, domain, count, first);
        std::size_t rows = 0;
        while (scan.fetch()) {
            scan.read();
            rows += scan.page().rows();
        }
        EXPECT_EQ(rows, known.size() * AttributeGroups(count).count());
    };
    verify.template operator()<1>(of_vertices, 40, first_group<1>);
    verify.template operator()<D + 1>(of_labels, 40, first_group<D + 1>);
    verify.template operator()<D + 1>(of_markers, D + 1, marker_group);
    for (const auto &[owner, value] : of_markers)
        ASSERT_TRUE(markers.erase(owner, code_of<D, D + 1>(domain, owner)));
    for (const auto &[owner, value] : of_markers)
        ASSERT_FALSE(markers.erase(owner, code_of<D, D + 1>(domain, owner)));
    markers.flush();
    verify.template operator()<1>(of_vertices, 40, first_group<1>);
    verify.template operator()<D + 1>(of_labels, 40, first_group<D + 1>);
    verify.template operator()<D + 1>({}, D + 1, marker_group);
}

TEST(AttributeKinds, AreApart) {
    kinds_are_apart<2>();
    kinds_are_apart<3>();
}

/// If few owners have attributes, asking for all owners reads each page once.
TEST(AttributeKinds, ThoseWithoutAttributesCostNoReading) {
    Model<3, 4> model(1);
    Owners<3, 4> owners(1, false);
    std::vector<Owner<3, 4>> all;
    for (int i = 0; i < 30000; ++i) all.push_back(owners.next());
    std::sort(all.begin(), all.end(),
              [&](const auto &a, const auto &b) { return model.code(a) < model.code(b); });
    for (std::size_t i = 0; i < all.size(); i += 10) model.put(all[i]);
    model.flush();
    ASSERT_GT(model.pages().size(), 4u);
    AttributeReader<3, 4> reader(model.host(), model.domain(), 1, 1 << 16);
    std::size_t found = 0;
    for (const auto &owner : all) found += reader.contains(owner);
    EXPECT_GE(found, all.size() / 10);
    EXPECT_LT(found, all.size() / 2);
    EXPECT_EQ(reader.pages_read(), model.pages().size());
}

/// A number that few have takes as many bits as it needs, and one more for each owner without it.
TEST(AttributeKinds, NullTakesABit) {
    const auto bytes = [](bool some_are_null) {
        MemoryHost memory;
        const Host host{*memory.table()};
        AttributePages<2, 3> pages(host, unit_domain<2>(), 1);
        Owners<2, 3> owners(1, false);
        for (int i = 0; i < 150; ++i) {
            const auto owner = owners.next();
            const double value = some_are_null && i % 3 == 0 ? null_value : i % 2;
            pages.put(owner, code_of<2, 3>(unit_domain<2>(), owner), &value);
        }
        pages.flush();
        EXPECT_EQ(memory.attribute_pages.size(), 1u);
        return memory.attribute_pages.begin()->second.size;
    };
    EXPECT_LE(bytes(true), bytes(false) + 150 / 8 + 1);
}

} // namespace
} // namespace abacus
