// Places located in the bytes of pages: the same answers as by a walk in memory, with few searches
// of the host, even if it has moved its pages.
#include "mesh/page_writer.hpp"
#include "support/containment.hpp"
#include "support/large_mesh.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <numeric>
#include <set>

namespace abacus::test {
namespace {

template <int D> void expect_same_answers(Large<D> &mesh, OpenMeshOf<D> &one, int rounds) {
    OpenMeshOf<D> other(mesh, ample);
    for (int round = 0; round < rounds; ++round) {
        const Point<D> p = mesh.place(round);
        abacus_simplex a{}, b{};
        const abacus_status status = other.locate(p, b);
        ASSERT_EQ(one.locate(p, a), status) << one.error.detail;
        if (status != ABACUS_OK) continue;
        ASSERT_EQ(rank<D>(a), rank<D>(b));
        for (int i = 0; i <= D; ++i)
            ASSERT_TRUE(std::equal(a.corner[i], a.corner[i] + D, b.corner[i]));
    }
    EXPECT_EQ(mesh.host.violations, std::vector<std::string>{});
}

template <class Dimension> class Glance : public testing::Test {};
using Dimensions = testing::Types<std::integral_constant<int, 2>, std::integral_constant<int, 3>>;
TYPED_TEST_SUITE(Glance, Dimensions);

TYPED_TEST(Glance, GivesTheAnswersOfAWalk) {
    constexpr int D = TypeParam::value;
    Large<D> mesh(D == 2 ? 60000 : 12000, 1);
    OpenMeshOf<D> open(mesh, mesh.tenth());
    expect_same_answers<D>(mesh, open, 4000);
}

TYPED_TEST(Glance, KnowsWherePagesAre) {
    constexpr int D = TypeParam::value;
    Large<D> mesh(D == 2 ? 200000 : 40000);
    OpenMeshOf<D> open(mesh, mesh.tenth());
    abacus_simplex simplex;
    const auto locate_some = [&] {
        for (int round = 0; round < 10000; ++round)
            ASSERT_NE(open.locate(unit_point<D>(mesh.random), simplex), ABACUS_ERROR);
    };
    locate_some();
    const auto calls = mesh.host.calls;
    const auto loads = open.counters().loads;
    locate_some();
    // Some pages are still loaded: those that are used twice, and those around remote places.
    EXPECT_LT(open.counters().loads - loads, 10000u / (D == 2 ? 5 : 2));
    EXPECT_LT(mesh.host.calls.find - calls.find, 10000u / (D == 2 ? 4 : 1));
    const auto fetches = mesh.host.calls.fetch - calls.fetch;
    EXPECT_GT(fetches, 8000u);
    EXPECT_LT(fetches, 10000u * (D == 2 ? 12 : 16) / 10); // few pages for each place
}

TYPED_TEST(Glance, FindsPagesThatHaveBeenMoved) {
    constexpr int D = TypeParam::value;
    Large<D> mesh(D == 2 ? 60000 : 12000);
    OpenMeshOf<D> open(mesh, mesh.tenth());
    expect_same_answers<D>(mesh, open, 2000);
    const Host host = mesh.host.host();
    for (auto &[key, stored] : MemoryHost::Pages(mesh.host.pages)) {
        if (mesh.random() % 2 == 0) continue;
        abacus_page page{key, stored.bytes(), stored.size, stored.location};
        host.put(ABACUS_SIMPLEX_PAGES, page);
    }
    expect_same_answers<D>(mesh, open, 2000);
}

/// A host that has exchanged some pages.
const abacus_host *sound_host;
abacus_host_status fetch_another(void *context, abacus_page_kind kind, abacus_page *page) {
    page->location = page->location / 2 + 1;
    return sound_host->fetch(context, kind, page);
}

TYPED_TEST(Glance, IsNotMisledByAnotherPage) {
    constexpr int D = TypeParam::value;
    Large<D> mesh(D == 2 ? 60000 : 12000);
    sound_host = mesh.host.table();
    abacus_host table = *sound_host;
    table.fetch = fetch_another;
    abacus_mesh *handle = nullptr;
    ASSERT_EQ(abacus_mesh_open(&table, &mesh.header.facts, mesh.tenth(), &handle, &mesh.error),
              ABACUS_OK);
    OpenMeshOf<D> other(mesh, ample);
    for (int round = 0; round < 2000; ++round) {
        const Point<D> p = mesh.place(round);
        abacus_simplex a{}, b{};
        const abacus_status status = other.locate(p, b);
        ASSERT_EQ(abacus_mesh_locate(handle, p.data(), &a, &mesh.error), status);
        if (status == ABACUS_OK) {
            ASSERT_EQ(rank<D>(a), rank<D>(b));
        }
    }
    abacus_mesh_close(handle);
}

TYPED_TEST(Glance, RefusesDamagedPages) {
    constexpr int D = TypeParam::value;
    Large<D> mesh(D == 2 ? 30000 : 6000);
    for (auto &[key, page] : mesh.host.pages)
        page.bytes()[mesh.random() % page.size] ^=
            static_cast<unsigned char>(1 << mesh.random() % 8);
    OpenMeshOf<D> open(mesh, mesh.tenth());
    abacus_simplex simplex;
    EXPECT_EQ(open.locate(mesh.place(0), simplex), ABACUS_ERROR);
    EXPECT_EQ(open.error.kind, ABACUS_ERROR_CORRUPTED);
}

/// Damaged pages with right checksums: any answer or error, but nothing else.
TYPED_TEST(Glance, SurvivesSealedDamage) {
    constexpr int D = TypeParam::value;
    Large<D> mesh(D == 2 ? 30000 : 6000);
    const auto sound = mesh.host.pages;
    for (int trial = 0; trial < 60; ++trial) {
        mesh.host.pages = sound;
        OpenMeshOf<D> open(mesh, mesh.tenth());
        abacus_simplex simplex;
        for (int i = 0; i < 200; ++i) open.locate(unit_point<D>(mesh.random), simplex);
        for (auto &[key, page] : mesh.host.pages)
            for (int i = 0; i < 3; ++i) {
                const std::size_t at = 48 + mesh.random() % (page.size - 48 - checksum_bytes);
                page.bytes()[at] ^= static_cast<unsigned char>(1 + mesh.random() % 255);
                seal_page(page.bytes(), page.size);
            }
        abacus_status status = ABACUS_OK;
        for (int i = 0; i < 50 && status != ABACUS_ERROR; ++i)
            status = open.locate(unit_point<D>(mesh.random), simplex);
        if (status == ABACUS_ERROR) {
            EXPECT_EQ(open.error.kind, ABACUS_ERROR_CORRUPTED);
        }
    }
    EXPECT_EQ(mesh.host.violations, std::vector<std::string>{});
}

TYPED_TEST(Glance, ReadsPatchesByThemselves) {
    constexpr int D = TypeParam::value;
    Large<D> mesh(D == 2 ? 30000 : 6000);
    PageView<D> whole, parts;
    for (auto &[key, page] : mesh.host.pages) {
        whole.read(page.bytes(), page.size, 0);
        parts.open(page.bytes(), page.size, 0);
        std::vector<int> order(static_cast<std::size_t>(parts.patches()));
        std::iota(order.begin(), order.end(), 0);
        std::shuffle(order.begin(), order.end(), mesh.random);
        for (const int patch : order) {
            parts.read_patch(patch);
            std::set<int> vertices;
            for (int s = parts.simplices_of(patch).begin; s < parts.simplices_of(patch).end; ++s)
                for (int i = 0; i <= D; ++i) {
                    ASSERT_EQ(parts.corner(s, i), whole.corner(s, i));
                    vertices.insert(parts.corner(s, i));
                }
            // The vertex data of a patch are correct.
            std::set<int> told;
            for (int v = parts.fresh_of(patch).begin; v < parts.fresh_of(patch).end; ++v)
                told.insert(v);
            for (int i = parts.named_of(patch).begin; i < parts.named_of(patch).end; ++i)
                told.insert(parts.named(i));
            ASSERT_EQ(told, vertices);
            vertices.erase(parts.vertices());
            for (int axis = 0; axis < D; ++axis) {
                const auto prefix = [&](int v) {
                    return parts.ranks(axis).prefix_at(static_cast<std::size_t>(v));
                };
                const auto before = [&](int v, int w) { return prefix(v) < prefix(w); };
                const auto ends = std::minmax_element(vertices.begin(), vertices.end(), before);
                ASSERT_EQ(parts.patch(patch).least[axis], prefix(*ends.first));
                ASSERT_EQ(parts.patch(patch).greatest[axis], prefix(*ends.second));
            }
        }
        for (int v = 0; v < parts.vertices(); ++v) {
            parts.read_point(v);
            ASSERT_EQ(parts.point(v), whole.point(v));
        }
    }
}

} // namespace
} // namespace abacus::test
