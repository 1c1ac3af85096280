// Points with as many attributes as possible, even if one of them fills a page: they wait, repeat,
// spill, go through threads, leave, and get new attributes.
#include "points/record.hpp"
#include "support/point_model.hpp"
#include "support/running_threads.hpp"
#include "support/sanitized.hpp"

#include <gtest/gtest.h>

#include <cstring>
#include <numeric>
#include <random>
#include <set>

namespace abacus::test {
namespace {

constexpr std::size_t little = 60 << 10, ample = 64 << 20;

template <int D> class Wide {
public:
    explicit Wide(int count, std::size_t cache_bytes = ample) : mesh(count, cache_bytes) {
        mesh.header.facts.columns.apart = 1;
    }

    /// Incompressible values, NaN among them.
    std::vector<double> values() {
        std::vector<double> values(mesh.header.facts.columns.attributes);
        for (double &x : values) {
            x = std::uniform_real_distribution<double>(-1, 1)(random);
            if (random() % 50 == 0) x = std::numeric_limits<double>::quiet_NaN();
        }
        return values;
    }
    /// On a coarse grid if `repeat`.
    std::vector<InputOf<D>> fresh(std::size_t n, bool repeat) {
        std::vector<InputOf<D>> points;
        for (; points.size() < n; ++next_id_) {
            Point<D> p;
            for (double &x : p)
                x = repeat ? double(random() % 4)
                           : std::uniform_real_distribution<double>(0, 1)(random);
            points.push_back({next_id_, p, values()});
        }
        return points;
    }
    std::vector<InputOf<D>> some(std::size_t n) {
        std::vector<InputOf<D>> points = model.points();
        std::shuffle(points.begin(), points.end(), random);
        points.resize(std::min(n, points.size()));
        return points;
    }
    void insert(std::size_t n, bool repeat, abacus_on_duplicate on_duplicate = ABACUS_KEEP,
                std::size_t memory = 16 << 20) {
        auto points = fresh(n, repeat);
        if (on_duplicate == ABACUS_REPLACE) {
            std::set<Point<D>> places; // each place once
            std::erase_if(points, [&](const auto &p) { return !places.insert(p.point).second; });
            model.replace(points);
        } else {
            model.insert(points);
        }
        ASSERT_EQ(mesh.insert(points, memory, on_duplicate), ABACUS_OK) << mesh.error.detail;
        model.expect(mesh);
    }
    void stage(std::size_t n, bool repeat, std::size_t memory = 16 << 20) {
        const auto points = fresh(n, repeat);
        model.stage(points);
        ASSERT_EQ(mesh.stage(points, memory), ABACUS_OK) << mesh.error.detail;
        model.expect(mesh);
    }
    void remove(std::size_t n) {
        const auto points = some(n);
        const std::uint64_t expected = model.remove(points);
        std::uint64_t deleted = 0;
        ASSERT_EQ(mesh.remove(points, deleted), ABACUS_OK) << mesh.error.detail;
        EXPECT_EQ(deleted, expected);
        model.expect(mesh);
    }
    void change(const std::vector<std::uint32_t> &source) {
        ASSERT_EQ(mesh.with_build([&](abacus_build *build) {
            return abacus_build_change_attributes(build, source.data(), source.size(), 1 << 20,
                                                  &mesh.header, &mesh.error);
        }),
                  ABACUS_OK)
            << mesh.error.detail;
        for (std::uint32_t i = 0; i < mesh.header.facts.columns.attributes; ++i)
            std::snprintf(mesh.header.names[i], ABACUS_NAME_BYTES, "a%u", i);
        model.change_attributes(source);
        model.expect(mesh);
    }
    /// Other values of the first attribute, the last and one in the middle.
    void update(std::size_t n) {
        const std::uint32_t count = mesh.header.facts.columns.attributes;
        const std::vector<std::uint32_t> which{count - 1, 0, count / 2};
        auto points = some(n);
        for (InputOf<D> &p : points) p.attributes = {1, double(p.id), 3};
        abacus_header shape = mesh.header;
        shape.facts.columns.attributes = static_cast<std::uint32_t>(which.size());
        abacus_stage *stage = nullptr;
        abacus_status status =
            abacus_stage_open(mesh.host.table(), &shape.facts, 1 << 20, &stage, &mesh.error);
        for (const InputOf<D> &p : points) {
            std::array<std::uint64_t, record_words(D, 3)> record;
            fill_record<D>(record.data(), p.id, p.point, p.attributes.data(), 3);
            if (status == ABACUS_OK)
                status = abacus_stage_add(stage, record.data(), 1, &mesh.error);
        }
        std::uint64_t updated = 0;
        abacus_named_place missing;
        if (status == ABACUS_OK)
            status = mesh.with_build([&](abacus_build *build) {
                return abacus_build_update(build, stage, which.data(), which.size(), 0,
                                           &mesh.header, &updated, &missing, &mesh.error);
            });
        abacus_stage_close(stage);
        ASSERT_EQ(status, ABACUS_OK) << mesh.error.detail;
        EXPECT_EQ(updated, points.size());
        model.update(points, which);
        model.expect(mesh);
    }

    MeshOf<D> mesh;
    PointModel<D> model;
    std::mt19937_64 random{5};

private:
    std::int64_t next_id_ = 0;
};

template <class Dimension> class WidePoints : public testing::Test {};
using Dimensions = testing::Types<std::integral_constant<int, 2>, std::integral_constant<int, 3>>;
TYPED_TEST_SUITE(WidePoints, Dimensions);

/// Around the number of attributes from which on a waiting or repeated point takes a page of its
/// own, and with one page larger than others.
TYPED_TEST(WidePoints, ComeAndGo) {
    constexpr int D = TypeParam::value;
    for (const int count : {100, 101, 490, 980, 989, 990, int{ABACUS_MAX_ATTRIBUTES}})
        for (const std::size_t cache : {little, ample}) {
            SCOPED_TRACE(count);
            Wide<D> wide(count, cache);
            wide.stage(D, false); // span no simplex
            wide.update(D);
            wide.remove(1);
            wide.insert(60, false);
            wide.insert(40, true);
            wide.insert(40, true); // most equal a vertex
            wide.update(30);
            wide.stage(20, true);
            wide.update(50);
            wide.remove(30);
            wide.insert(20, true, ABACUS_REPLACE);
            wide.remove(1000);
            wide.stage(3, false);
            if (this->HasFatalFailure() || sanitized) return;
        }
}

TYPED_TEST(WidePoints, SpillWithLittleMemory) {
    constexpr int D = TypeParam::value;
    Wide<D> wide(ABACUS_MAX_ATTRIBUTES, little);
    wide.stage(300, true, 64 << 10);
    wide.insert(300, false, ABACUS_KEEP, 64 << 10);
    wide.insert(100, true, ABACUS_REPLACE, 64 << 10);
    wide.remove(300);
}

TYPED_TEST(WidePoints, GoThroughThreads) {
    constexpr int D = TypeParam::value;
    for (const unsigned threads : {2, 5}) {
        Wide<D> wide(ABACUS_MAX_ATTRIBUTES);
        wide.mesh.host.set_threads(threads, true);
        wide.insert(300, false);
        wide.insert(100, true);
        wide.insert(100, true, ABACUS_REPLACE);
        wide.update(100);
        wide.remove(200);
        EXPECT_TRUE(all_threads_ended());
    }
}

TYPED_TEST(WidePoints, GetOneMoreAndOneLess) {
    constexpr int D = TypeParam::value;
    for (const bool repeat : {false, true})
        for (const std::uint32_t count : {100u, 980u, ABACUS_MAX_ATTRIBUTES - 1u}) {
            Wide<D> wide(static_cast<int>(count), little);
            wide.insert(50, repeat);
            wide.stage(10, repeat);
            std::vector<std::uint32_t> source(count);
            std::iota(source.begin(), source.end(), 0u);
            source.push_back(ABACUS_NO_ATTRIBUTE);
            wide.change(source);
            wide.update(20);
            source.back() = count;
            source.erase(source.begin() + 3);
            wide.change(source);
            wide.remove(20);
            if (this->HasFatalFailure()) return;
        }
}

/// A page larger than full ones can only be read if one point takes it.
TYPED_TEST(WidePoints, DamagedPagesAreRefused) {
    constexpr int D = TypeParam::value;
    Wide<D> wide(ABACUS_MAX_ATTRIBUTES);
    wide.stage(D, false);
    auto &page = wide.mesh.host.staged_pages.begin()->second;
    EXPECT_GT(page.size, std::size_t{ABACUS_PAGE_BYTES});
    page.size -= 8;
    EXPECT_NE(wide.mesh.check(), std::vector<std::string>{});
    page.size += 8;
    EXPECT_EQ(wide.mesh.check(), std::vector<std::string>{});
}

} // namespace
} // namespace abacus::test
