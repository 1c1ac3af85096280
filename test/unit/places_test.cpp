// Many places located at once: the same answers as one by one, each page read about once.
#include "mesh/page_writer.hpp"
#include "support/containment.hpp"
#include "support/large_mesh.hpp"
#include "support/located_places.hpp"
#include "support/triangulations.hpp"

#include <gtest/gtest.h>

#include <limits>

namespace abacus::test {
namespace {

template <class Dimension> class Places : public testing::Test {};
using Dimensions = testing::Types<std::integral_constant<int, 2>, std::integral_constant<int, 3>>;
TYPED_TEST_SUITE(Places, Dimensions);

/// Places of all kinds, some more than once, some with another one's id.
template <int D> std::vector<InputOf<D>> places_in(Large<D> &mesh, int n) {
    constexpr double far = std::numeric_limits<double>::max();
    std::vector<InputOf<D>> places;
    for (int i = 0; i < n; ++i) {
        places.push_back({i, mesh.place(i)});
        if (i % 50 == 0) places.push_back({i / 2, places[static_cast<std::size_t>(i) / 3].point});
    }
    for (const double x : {far, -far, -0.0, 0.0}) {
        Point<D> p;
        p.fill(x);
        places.push_back({n++, p});
    }
    return places;
}

template <int D>
std::vector<LocatedPlace> one_by_one(MeshOf<D> &mesh, const std::vector<InputOf<D>> &places) {
    OpenMeshOf<D> open(mesh, ample);
    std::vector<LocatedPlace> located;
    for (const InputOf<D> &place : places) {
        abacus_simplex s;
        const abacus_status status = open.locate(place.point, s);
        EXPECT_TRUE(status == ABACUS_OK || status == ABACUS_END) << open.error.detail;
        located.push_back({place.id, status == ABACUS_OK ? std::optional(s) : std::nullopt});
    }
    return located;
}

/// The same answers, in any order.
template <int D>
void expect_answers(MeshOf<D> &mesh, const std::vector<LocatedPlace> &located,
                    const std::vector<LocatedPlace> &expected) {
    const auto answers = [](const std::vector<LocatedPlace> &places) {
        std::vector<std::pair<std::int64_t, decltype(rank<D>(*places[0].simplex))>> result;
        for (const auto &[id, simplex] : places)
            result.emplace_back(id, simplex ? rank<D>(*simplex) : decltype(rank<D>(*simplex)){});
        std::sort(result.begin(), result.end());
        return result;
    };
    EXPECT_EQ(answers(located), answers(expected));
    EXPECT_EQ(mesh.host.violations, std::vector<std::string>{});
}

TYPED_TEST(Places, HaveTheAnswersOfEach) {
    constexpr int D = TypeParam::value;
    Large<D> mesh(D == 2 ? 60000 : 12000, 1);
    const auto places = places_in(mesh, 10000);
    const auto expected = one_by_one<D>(mesh, places);
    const std::size_t bytes = mesh.host.bytes;
    std::vector<std::int64_t> order;
    for (const std::size_t cache : {std::size_t{40} << 10, mesh.tenth(), ample})
        for (const std::size_t memory : {std::size_t{1}, ample}) {
            mesh.cache_bytes = cache;
            std::vector<LocatedPlace> located;
            const auto spools = mesh.host.calls.spool_create;
            ASSERT_EQ(locate_places<D>(mesh, places, located, memory), ABACUS_OK)
                << mesh.error.detail;
            EXPECT_EQ(mesh.host.calls.spool_create > spools, memory == 1);
            EXPECT_EQ(mesh.host.bytes, bytes);
            expect_answers<D>(mesh, located, expected);
            // The order is that of the places, whatever the memory.
            std::vector<std::int64_t> ids;
            for (const LocatedPlace &place : located) ids.push_back(place.id);
            if (order.empty()) order = ids;
            EXPECT_EQ(ids, order);
        }
}

TYPED_TEST(Places, AreFoundPageByPage) {
    constexpr int D = TypeParam::value;
    Large<D> mesh(D == 2 ? 100000 : 20000);
    mesh.cache_bytes = std::size_t{4} << 20; // too little for a mesh of so many pages
    std::vector<InputOf<D>> places;
    for (int i = 0; i < 100000; ++i) places.push_back({i, unit_point<D>(mesh.random)});
    const auto calls = mesh.host.calls;
    std::vector<LocatedPlace> located;
    ASSERT_EQ(locate_places<D>(mesh, places, located), ABACUS_OK);
    const auto pages = mesh.host.pages.size();
    EXPECT_GE(mesh.host.calls.find - calls.find, pages / 2);
    EXPECT_LT(mesh.host.calls.find + mesh.host.calls.fetch - calls.find - calls.fetch,
              pages * (D == 2 ? 6 : 20));
    EXPECT_GT(places.size(), pages * 100); // a call for each would take more
}

TYPED_TEST(Places, OutsideAreReportedAsSuch) {
    constexpr int D = TypeParam::value;
    const std::vector<InputOf<D>> places{{7, Point<D>{}}, {8, Point<D>{1}}, {7, Point<D>{2}}};
    MeshOf<D> mesh;
    const auto expect_outside = [&] {
        std::vector<LocatedPlace> located;
        ASSERT_EQ(locate_places<D>(mesh, places, located), ABACUS_OK) << mesh.error.message;
        ASSERT_EQ(located.size(), 3u);
        for (const LocatedPlace &place : located) EXPECT_FALSE(place.simplex);
    };
    expect_outside(); // there is no simplex yet
    ASSERT_EQ(mesh.insert({{1, Point<D>{}}, {2, Point<D>{1}}}), ABACUS_OK);
    expect_outside(); // these do not span a simplex
    std::vector<LocatedPlace> located;
    ASSERT_EQ(locate_places<D>(mesh, {}, located), ABACUS_OK);
    EXPECT_TRUE(located.empty());
}

TYPED_TEST(Places, InAMeshThatIsNotDelaunay) {
    constexpr int D = TypeParam::value;
    Random random(3);
    std::vector<Point<D>> points;
    for (int i = 0; i < 600; ++i) points.push_back(unit_point<D>(random));
    const auto t = keeping<D>(delaunay<D>(points), [](const auto &c) {
        return std::abs(c[0] - 0.5) + std::abs(c[1] - 0.5) > 0.2; // a hole
    });
    MeshOf<D> mesh(0, std::size_t{60} << 10);
    ASSERT_EQ(mesh.load(t.vertices, t.simplices), ABACUS_OK) << mesh.error.detail;
    std::vector<InputOf<D>> places;
    for (int i = 0; i < 2000; ++i) places.push_back({i, unit_point<D>(random)});
    std::vector<LocatedPlace> located;
    ASSERT_EQ(locate_places<D>(mesh, places, located), ABACUS_OK) << mesh.error.detail;
    expect_answers<D>(mesh, located, one_by_one<D>(mesh, places));
}

TYPED_TEST(Places, EndWithTheReport) {
    constexpr int D = TypeParam::value;
    Large<D> mesh(2000);
    std::vector<LocatedPlace> located;
    const std::size_t bytes = mesh.host.bytes;
    const auto fail_at_ten = [](void *context, std::int64_t id, const abacus_simplex *s,
                                const double *labels) {
        keep_place(context, id, s, labels);
        const auto &kept = *static_cast<std::vector<LocatedPlace> *>(context);
        return kept.size() == 10 ? ABACUS_HOST_FAILED : ABACUS_HOST_OK;
    };
    EXPECT_EQ(locate_places<D>(mesh, places_in(mesh, 1000), located, ample, fail_at_ten),
              ABACUS_HOST_ERROR);
    EXPECT_EQ(located.size(), 10u);
    EXPECT_EQ(mesh.host.bytes, bytes);
}

TYPED_TEST(Places, OnVerticesAndFacetsCostNoMorePages) {
    constexpr int D = TypeParam::value;
    Large<D> mesh(D == 2 ? 60000 : 12000);
    mesh.cache_bytes = std::size_t{4} << 20;
    std::vector<InputOf<D>> places;
    for (const Point<D> &p : mesh.points_) places.push_back({1, p});
    const auto calls = mesh.host.calls;
    std::vector<LocatedPlace> located;
    ASSERT_EQ(locate_places<D>(mesh, places, located), ABACUS_OK) << mesh.error.detail;
    for (const LocatedPlace &place : located) ASSERT_TRUE(place.simplex);
    EXPECT_LT(mesh.host.calls.find + mesh.host.calls.fetch - calls.find - calls.fetch,
              mesh.host.pages.size() * (D == 2 ? 4 : 12));
}

TYPED_TEST(Places, AreReportedAsProgress) {
    constexpr int D = TypeParam::value;
    Large<D> mesh(2000);
    const auto places = places_in(mesh, 1000);
    std::vector<abacus_phase> phases;
    std::uint64_t done = 0;
    mesh.host.on_progress = [&](const abacus_progress &progress) {
        if (phases.empty() || phases.back() != progress.phase) phases.push_back(progress.phase);
        done = progress.done;
    };
    std::vector<LocatedPlace> located;
    ASSERT_EQ(locate_places<D>(mesh, places, located), ABACUS_OK);
    EXPECT_EQ(phases,
              (std::vector{ABACUS_PHASE_READING, ABACUS_PHASE_SORTING, ABACUS_PHASE_LOCATING}));
    EXPECT_EQ(done, places.size());
}

/// Damaged pages with right checksums, even with right intervals, and missing pages: any answer or
/// error, but nothing else.
TYPED_TEST(Places, SurviveSealedDamage) {
    constexpr int D = TypeParam::value;
    Large<D> mesh(D == 2 ? 20000 : 4000);
    const auto places = places_in(mesh, 4000); // enough for boxes to be made
    const auto sound = mesh.host.pages;
    for (int trial = 0; trial < 60; ++trial) {
        mesh.host.pages = sound;
        for (auto &[key, page] : mesh.host.pages) {
            if (trial % 3 != 0 && mesh.random() % 8 != 0) continue;
            // In every other trial also the header's counts and interval.
            const std::size_t from = trial % 2 == 0 ? 8 : 48;
            for (int i = 0; i < 3; ++i) {
                const std::size_t at = from + mesh.random() % (page.size - from - checksum_bytes);
                page.bytes()[at] ^= static_cast<unsigned char>(1 + mesh.random() % 255);
            }
            seal_page(page.bytes(), page.size);
        }
        if (trial % 3 == 1)
            std::erase_if(mesh.host.pages, [&](auto &) { return mesh.random() % 9 == 0; });
        std::vector<LocatedPlace> located;
        const abacus_status status = locate_places<D>(mesh, places, located);
        if (status == ABACUS_ERROR) {
            EXPECT_EQ(mesh.error.kind, ABACUS_ERROR_CORRUPTED);
        } else {
            EXPECT_EQ(located.size(), places.size());
        }
    }
    EXPECT_EQ(mesh.host.violations, std::vector<std::string>{});
}

TYPED_TEST(Places, WhoseOwnerIsGoneAreAnError) {
    constexpr int D = TypeParam::value;
    Large<D> mesh(D == 2 ? 20000 : 4000);
    const auto places = places_in(mesh, 1000);
    auto gone = mesh.host.pages.begin();
    std::advance(gone, mesh.host.pages.size() / 2);
    mesh.host.pages.erase(gone);
    std::vector<LocatedPlace> located;
    EXPECT_EQ(locate_places<D>(mesh, places, located), ABACUS_ERROR);
    EXPECT_EQ(mesh.error.kind, ABACUS_ERROR_CORRUPTED);
}

TYPED_TEST(Places, InDamagedPagesAreAnError) {
    constexpr int D = TypeParam::value;
    Large<D> mesh(D == 2 ? 30000 : 6000);
    for (auto &[key, page] : mesh.host.pages)
        page.bytes()[mesh.random() % page.size] ^=
            static_cast<unsigned char>(1 << mesh.random() % 8);
    std::vector<LocatedPlace> located;
    EXPECT_EQ(locate_places<D>(mesh, places_in(mesh, 1000), located), ABACUS_ERROR);
    EXPECT_EQ(mesh.error.kind, ABACUS_ERROR_CORRUPTED);
}

} // namespace
} // namespace abacus::test
