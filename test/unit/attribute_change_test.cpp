// All points get other attributes: more, fewer, or the same in pages of their own.
#include "points/record.hpp"
#include "support/point_model.hpp"

#include <gtest/gtest.h>

#include <numeric>
#include <random>

namespace abacus::test {
namespace {

constexpr std::size_t little = 60 << 10, ample = 64 << 20;

template <int D> class Changing {
public:
    Changing(int count, std::size_t cache_bytes, bool apart) : mesh(count, cache_bytes) {
        mesh.header.facts.columns.apart = apart;
    }

    std::vector<double> values(std::size_t n) {
        std::vector<double> values(n);
        for (double &x : values) x = double(random() % 1000) / 8;
        return values;
    }
    /// Points of a kind: 0 uniform, 1 few places, 2 on a line.
    std::vector<InputOf<D>> fresh(std::size_t n, int kind) {
        std::vector<InputOf<D>> points;
        for (; points.size() < n; ++next_id_) {
            Point<D> p;
            for (double &x : p)
                x = kind == 1 ? double(random() % 5)
                              : std::uniform_real_distribution<double>(0, 1)(random);
            if (kind == 2) p.fill(double(next_id_));
            points.push_back({next_id_, p, values(mesh.header.facts.columns.attributes)});
        }
        return points;
    }
    void insert(const std::vector<InputOf<D>> &points) {
        model.insert(points);
        ASSERT_EQ(mesh.insert(points), ABACUS_OK) << mesh.error.detail;
    }
    abacus_status run(const std::vector<std::uint32_t> &source) {
        return mesh.with_build([&](abacus_build *build) {
            return abacus_build_change_attributes(build, source.data(), source.size(), 1 << 20,
                                                  &mesh.header, &mesh.error);
        });
    }
    void change(const std::vector<std::uint32_t> &source) {
        ASSERT_EQ(run(source), ABACUS_OK) << mesh.error.message << ' ' << mesh.error.detail;
        EXPECT_EQ(mesh.header.facts.columns.attributes, source.size());
        model.change_attributes(source);
        model.expect(mesh);
    }
    void add() {
        std::vector<std::uint32_t> source = same();
        source.push_back(ABACUS_NO_ATTRIBUTE);
        change(source);
        std::snprintf(mesh.header.names[source.size() - 1], ABACUS_NAME_BYTES, "more");
    }
    void drop(std::size_t which) {
        std::vector<std::uint32_t> source = same();
        source.erase(source.begin() + static_cast<std::ptrdiff_t>(which));
        change(source);
    }
    std::vector<std::uint32_t> same() const {
        std::vector<std::uint32_t> source(mesh.header.facts.columns.attributes);
        std::iota(source.begin(), source.end(), 0u);
        return source;
    }
    /// What was added has a value.
    void update_last() {
        const std::uint32_t last = mesh.header.facts.columns.attributes - 1;
        std::vector<InputOf<D>> points = model.points();
        for (InputOf<D> &p : points) p.attributes = values(1);
        model.update(points, {last});
        abacus_header shape = mesh.header;
        shape.facts.columns.attributes = 1;
        abacus_stage *stage = nullptr;
        abacus_status status =
            abacus_stage_open(mesh.host.table(), &shape.facts, 1 << 20, &stage, &mesh.error);
        for (const InputOf<D> &p : points) {
            std::array<std::uint64_t, 2 + D> record;
            fill_record<D>(record.data(), p.id, p.point, p.attributes.data(), 1);
            if (status == ABACUS_OK)
                status = abacus_stage_add(stage, record.data(), 1, &mesh.error);
        }
        if (status == ABACUS_OK)
            status = mesh.with_build([&](abacus_build *build) {
                std::uint64_t updated = 0;
                abacus_named_place missing;
                return abacus_build_update(build, stage, &last, 1, 0, &mesh.header, &updated,
                                           &missing, &mesh.error);
            });
        abacus_stage_close(stage);
        ASSERT_EQ(status, ABACUS_OK) << mesh.error.detail;
    }

    MeshOf<D> mesh;
    PointModel<D> model;
    std::mt19937_64 random{3};

private:
    std::int64_t next_id_ = 0;
};

template <class Dimension> class AttributeChange : public testing::Test {};
using Dimensions = testing::Types<std::integral_constant<int, 2>, std::integral_constant<int, 3>>;
TYPED_TEST_SUITE(AttributeChange, Dimensions);

TYPED_TEST(AttributeChange, OneByOneFromNoneToManyAndBack) {
    // Attributes of vertices, of points equal to one, and of waiting points.
    constexpr int D = TypeParam::value;
    for (const int kind : {0, 1, 2})
        for (const std::size_t cache : {little, ample}) {
            SCOPED_TRACE(kind);
            Changing<D> changing(0, cache, false);
            changing.insert(changing.fresh(500, kind));
            for (std::uint32_t n = 1; n <= 7; ++n) {
                changing.add();
                EXPECT_EQ(changing.mesh.header.facts.columns.apart, abacus_are_apart(D, n));
                changing.update_last();
                changing.insert(changing.fresh(60, kind));
                if (this->HasFatalFailure()) return;
            }
            changing.model.expect(changing.mesh);
            for (std::uint32_t n = 7; n > 0; --n) {
                changing.drop(n / 2);
                EXPECT_EQ(changing.mesh.header.facts.columns.apart, n > 1);
                changing.insert(changing.fresh(20, kind));
                std::uint64_t deleted = 0;
                auto points = changing.model.points();
                points.resize(points.size() / 10);
                ASSERT_EQ(changing.mesh.remove(points, deleted), ABACUS_OK);
                changing.model.remove(points);
                if (this->HasFatalFailure()) return;
            }
            changing.model.expect(changing.mesh);
            EXPECT_TRUE(changing.mesh.host.attribute_pages.empty());
        }
}

TYPED_TEST(AttributeChange, OverTheBorderOfGroups) {
    constexpr int D = TypeParam::value;
    Changing<D> changing(31, little, true);
    changing.insert(changing.fresh(400, 0));
    for (int i = 0; i < 3; ++i) {
        changing.add();
        changing.update_last();
        changing.model.expect(changing.mesh);
    }
    for (const std::size_t which : {0, 33, 16})
        changing.drop(
            std::min<std::size_t>(which, changing.mesh.header.facts.columns.attributes - 1));
    changing.insert(changing.fresh(200, 0));
    changing.model.expect(changing.mesh);
}

TYPED_TEST(AttributeChange, NamesGoWithTheirAttributes) {
    constexpr int D = TypeParam::value;
    Changing<D> changing(3, ample, false);
    changing.insert(changing.fresh(50, 0));
    changing.change({2, 0});
    EXPECT_STREQ(changing.mesh.header.names[0], "a2");
    EXPECT_STREQ(changing.mesh.header.names[1], "a0");
    changing.change({ABACUS_NO_ATTRIBUTE, 1, 0});
    EXPECT_STREQ(changing.mesh.header.names[0], "");
    EXPECT_STREQ(changing.mesh.header.names[1], "a0");
    EXPECT_STREQ(changing.mesh.header.names[2], "a2");
}

TYPED_TEST(AttributeChange, ManyLeaveTheSimplexPages) {
    // A mesh of format 3 becomes one of format 4. Its first pages are filled by guess, so only a
    // larger mesh has nearly as few pages as a new one.
    constexpr int D = TypeParam::value;
    for (const std::size_t cache : {little, ample}) {
        Changing<D> changing(60, cache, false);
        changing.insert(changing.fresh(D == 2 ? 1500 : 400, 0));
        const std::size_t before = changing.mesh.host.pages.size();
        changing.change(changing.same());
        EXPECT_EQ(changing.mesh.header.facts.columns.apart, 1u);
        EXPECT_LT(changing.mesh.host.pages.size(), before / 2);
        Changing<D> bare(0, cache, false);
        bare.insert(bare.fresh(D == 2 ? 1500 : 400, 0));
        EXPECT_LT(changing.mesh.host.pages.size(), 2 * bare.mesh.host.pages.size() + 3);
        changing.insert(changing.fresh(100, 0));
        changing.model.expect(changing.mesh);
    }
}

TYPED_TEST(AttributeChange, EndsWellWhateverFails) {
    constexpr int D = TypeParam::value;
    for (const bool apart : {false, true})
        for (const bool memory : {false, true})
            for (std::uint64_t n = 1, failures = 1; failures > 0; n += 1 + n / 4) {
                Changing<D> changing(apart ? 40 : D == 2 ? 4 : 2, little, apart);
                changing.insert(changing.fresh(300, 1));
                std::vector<std::uint32_t> source = changing.same();
                source.push_back(ABACUS_NO_ATTRIBUTE);
                MemoryHost &host = changing.mesh.host;
                memory ? host.fail_resize_at(n) : host.fail_at(n);
                failures = changing.run(source) == ABACUS_OK ? 0 : 1;
                EXPECT_EQ(host.violations, std::vector<std::string>{});
                EXPECT_EQ(host.bytes, 0u);
            }
}

} // namespace
} // namespace abacus::test
