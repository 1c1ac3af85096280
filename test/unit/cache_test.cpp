// The computational cache: probing, parts, attributes, budget, handles, counters.
#include "delaunay/insertion.hpp"
#include "mesh/cache.hpp"
#include "support/oracle.hpp"
#include "support/page_editor.hpp"
#include "support/sanitized.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <map>
#include <random>

namespace abacus::test {
namespace {

using Random = std::mt19937_64;

constexpr std::size_t little = 40 << 10, ample = 64 << 20;

// Inputs that take long under a sanitizer are smaller there.
const int scale = sanitized ? 10 : 1;

double unit(Random &random) { return std::uniform_real_distribution<double>(0, 1)(random); }

/// Inserts points with a cache of these options into a mesh, as a build does.
abacus_counters insert(Mesh &mesh, const std::vector<Point<2>> &points,
                       const CacheOptions &options) {
    mesh.header.facts.form.has_domain = 1;
    mesh.header.facts.form.upper[0] = mesh.header.facts.form.upper[1] = 1;
    const Host host = mesh.host.host();
    Cache<2> cache(host, Domain<2>({0, 0}, {1, 1}), 0, options);
    Delaunay<2> delaunay(host, cache, 0, 0);
    Insertion<2> insertion(delaunay);
    std::array<VertexIndex, 3> first;
    for (int i = 0; i < 3; ++i) first[i] = cache.create_vertex(points[i], i, nullptr);
    insertion.start(first);
    for (std::size_t i = 3; i < points.size(); ++i)
        EXPECT_TRUE(insertion.insert(points[i], static_cast<std::int64_t>(i), nullptr));
    cache.flush();
    mesh.header.facts.census.vertices = points.size();
    mesh.header.facts.census.simplices = static_cast<std::uint64_t>(delaunay.simplices());
    mesh.header.facts.census.ghosts = static_cast<std::uint64_t>(delaunay.ghosts());
    return cache.counters;
}

/// Removes the neighbours' keys from all links of the stored pages.
void forget_links(Mesh &mesh) {
    for (auto &[key, page] : mesh.host.pages) {
        PageEditor editor(page, mesh.header);
        for (Key &link : editor.links) link = {unknown_code, 0};
        editor.write(page);
    }
}

TEST(Probing, GivesTheSameMeshAsStoredLinks) {
    const auto points = unit_square_points(1500, 1);
    Mesh stored, probed;
    const auto with = insert(stored, points, {.budget = little});
    const auto without = insert(probed, points, {.budget = little, .stored_links = false});
    EXPECT_EQ(stored.positions(), cgal_simplices<2>(points));
    EXPECT_EQ(probed.positions(), stored.positions());
    EXPECT_GT(with.link_probes, 0u);
    EXPECT_EQ(with.quick_probes + with.ray_probes + with.concentric_probes, 0u);
    EXPECT_EQ(without.link_probes, 0u);
    EXPECT_GT(without.quick_probes, 0u);
    EXPECT_GT(without.ray_probes, 0u);
    EXPECT_EQ(probed.host.violations, std::vector<std::string>{});
}

TEST(Probing, FindsDistantNeighboursInEveryPage) {
    // Long thin triangles: the vertex that gives a neighbour its key is often far from the
    // facet.
    Random random(2);
    std::vector<Point<2>> points;
    for (int i = 0; i < 3000; ++i)
        points.push_back({i % 2 ? 0.01 * unit(random) : 1 - 0.01 * unit(random), unit(random)});
    Mesh mesh;
    const auto counters = insert(mesh, points, {.budget = little, .stored_links = false});
    EXPECT_EQ(mesh.positions(), cgal_simplices<2>(points));
    EXPECT_GT(counters.concentric_probes, 0u);
}

TEST(Probing, ServesLinksWithoutAKey) {
    auto points = unit_square_points(2500, 3);
    Mesh mesh(0, little);
    ASSERT_EQ(mesh.stage(number(points)), ABACUS_OK);
    ASSERT_EQ(mesh.build(), ABACUS_OK);
    const auto triangles = mesh.simplices(false);
    forget_links(mesh);
    OpenMesh open(mesh, little);
    for (std::size_t i = 0; i < triangles.size(); i += 7) {
        const auto &s = triangles[i];
        abacus_simplex found;
        const Point<2> middle{(s.corner[0][0] + s.corner[1][0] + s.corner[2][0]) / 3,
                              (s.corner[0][1] + s.corner[1][1] + s.corner[2][1]) / 3};
        ASSERT_EQ(open.locate(middle, found), ABACUS_OK) << open.error.detail;
        EXPECT_EQ(found.id[0], s.id[0]);
        // A page alone may be enough to find a place, but not what lies across its facets.
        for (int facet = 0; facet < 3; ++facet)
            ASSERT_NE(open.walk(s, facet, found), ABACUS_ERROR) << open.error.detail;
    }
    // An evicted page is found again by its former key; the others need probing.
    const abacus_counters &counters = open.counters();
    EXPECT_GT(counters.quick_probes, 0u);
    EXPECT_GT(counters.ray_probes, 0u);
    EXPECT_GT(counters.link_probes, 0u);
    // And such a mesh can grow.
    const auto more = unit_square_points(500, 4);
    ASSERT_EQ(mesh.stage(number(more)), ABACUS_OK);
    ASSERT_EQ(mesh.build(), ABACUS_OK) << mesh.error.detail;
    points.insert(points.end(), more.begin(), more.end());
    EXPECT_EQ(mesh.positions(), cgal_simplices<2>(points));
}

TEST(Cache, TellsALinkToTheWrongPlaceFromAMissingOne) {
    Mesh mesh(0, ample);
    ASSERT_EQ(mesh.stage(number(unit_square_points(2500, 5))), ABACUS_OK);
    ASSERT_EQ(mesh.build(), ABACUS_OK);
    for (auto &[key, page] : mesh.host.pages) {
        PageEditor editor(page, mesh.header);
        for (Key &link : editor.links) link.code = 0;
        editor.write(page);
    }
    OpenMesh open(mesh, ample);
    abacus_status status = ABACUS_OK;
    for (const auto &s : mesh.simplices(false)) {
        abacus_simplex found;
        for (int i = 0; i < 3 && status != ABACUS_ERROR; ++i) status = open.walk(s, i, found);
        if (status == ABACUS_ERROR) break;
    }
    EXPECT_EQ(status, ABACUS_ERROR);
    EXPECT_EQ(open.error.kind, ABACUS_ERROR_CORRUPTED);
}

/// Moves the border between two consecutive pages up among the keys of the second, whose simplices
/// stay where they are. Returns a point for each of those that its page still owns.
std::vector<Input> forge_border(Mesh &mesh, const abacus_key &first, const abacus_key &second) {
    MemoryHost::Pages &pages = mesh.host.pages;
    PageEditor before(pages.at(first), mesh.header), page(pages.at(second), mesh.header);
    std::vector<std::uint64_t> codes;
    for (const auto &simplex : page.simplices) {
        codes.push_back(0);
        for (const int v : simplex)
            if (v != PageEditor::infinity)
                codes.back() = std::max(codes.back(), page.domain.code(page.points[v]));
    }
    std::vector<std::uint64_t> sorted = codes;
    std::sort(sorted.begin(), sorted.end());
    before.upper = page.lower = {sorted[sorted.size() * 7 / 10], 0};
    MemoryHost::Page forged[2];
    before.write(forged[0]);
    page.write(forged[1]);
    const abacus_host *const host = mesh.host.table();
    const auto put = [&](const Key &key, MemoryHost::Page &forgery, std::uint64_t location) {
        abacus_page stored{key, forgery.bytes(), forgery.size, location};
        EXPECT_EQ(host->put(host->context, ABACUS_SIMPLEX_PAGES, &stored), 0);
    };
    const abacus_page old{second, nullptr, 0, pages.at(second).location};
    EXPECT_EQ(host->erase(host->context, ABACUS_SIMPLEX_PAGES, &old), 0);
    put(first, forged[0], pages.at(first).location);
    put(page.lower, forged[1], 0);

    std::vector<Input> inside;
    for (std::size_t s = 0; s < codes.size(); ++s) {
        if (page.is_ghost(static_cast<int>(s)) || codes[s] < page.lower.code) continue;
        Point<2> middle{};
        for (const int v : page.simplices[s])
            for (int i = 0; i < 2; ++i) middle[i] += page.points[v][i] / 3;
        const Key key{page.domain.code(middle), 0};
        if (page.lower <= key && key < page.upper)
            inside.push_back({100000 + static_cast<std::int64_t>(s), middle});
    }
    return inside;
}

TEST(Cache, CutsNoPageWhoseSimplicesLieOutsideOfIt) {
    Mesh mesh(0, ample);
    ASSERT_EQ(mesh.insert(number(unit_square_points(6000, 1))), ABACUS_OK);
    std::vector<abacus_key> keys;
    for (const auto &[key, page] : mesh.host.pages) keys.push_back(key);
    int forged = 0;
    for (std::size_t i = 1; i < keys.size(); ++i) {
        if (mesh.host.pages.at(keys[i]).size < 0.85 * ABACUS_PAGE_BYTES) continue;
        Mesh other(0, ample);
        other.header = mesh.header;
        other.host.restore(mesh.host);
        const auto more = forge_border(other, keys[i - 1], keys[i]);
        EXPECT_EQ(other.insert(more), ABACUS_ERROR);
        EXPECT_EQ(other.error.kind, ABACUS_ERROR_CORRUPTED);
        EXPECT_EQ(other.host.bytes, 0u);
        ++forged;
    }
    EXPECT_GT(forged, 3);
}

TEST(Cache, SplitsACodeIntoParts) {
    // Clusters far below the resolution of the codes, more than a page at each.
    Random random(6);
    std::vector<Point<2>> points = unit_square_points(100, 7);
    for (int i = 0; i < 3000; ++i) {
        const double centre = i % 2 ? 0.3 : 0.6;
        points.push_back({centre + unit(random) * 1e-13, centre + unit(random) * 1e-13});
    }
    for (const std::size_t cache : {little, ample}) {
        Mesh mesh(0, cache);
        ASSERT_EQ(mesh.stage(number(points)), ABACUS_OK);
        ASSERT_EQ(mesh.build(), ABACUS_OK) << mesh.error.message << mesh.error.detail;
        EXPECT_EQ(mesh.positions(), cgal_simplices<2>(points));
        EXPECT_EQ(mesh.check(), std::vector<std::string>{});
        const auto parts = std::count_if(mesh.host.pages.begin(), mesh.host.pages.end(),
                                         [](const auto &page) { return page.first.part != 0; });
        EXPECT_GT(parts, 3);
        // Walking finds simplices by their code, regardless of the part.
        OpenMesh open(mesh, cache);
        const auto all = mesh.simplices(false);
        for (std::size_t i = 0; i < all.size(); i += 7) {
            abacus_simplex found;
            ASSERT_NE(open.walk(all[i], 0, found), ABACUS_ERROR) << open.error.message;
        }
    }
}

TEST(Cache, CarriesAttributesThroughPagesBitForBit) {
    for (const int attributes : {1, 3, 17, ABACUS_MAX_PAGE_ATTRIBUTES}) {
        Random random(8);
        const auto points =
            unit_square_points(attributes == ABACUS_MAX_PAGE_ATTRIBUTES ? 150 : 600, 9);
        std::vector<Input> inputs = number(points);
        for (Input &input : inputs) {
            input.id = std::bit_cast<std::int64_t>(random());
            for (int i = 0; i < attributes; ++i) {
                std::uint64_t bits = random();
                // NaNs with payloads, infinities and both zeros.
                if (bits % 3 == 0) bits |= 0x7ff8ull << 48;
                if (bits % 7 == 0) bits = (bits & 1) << 63 | (bits & 2 ? 0x7ffull << 52 : 0);
                input.attributes.push_back(std::bit_cast<double>(bits));
            }
        }
        std::map<Point<2>, const Input *> expected;
        for (const Input &input : inputs) expected[input.point] = &input;
        Mesh mesh(attributes, little);
        ASSERT_EQ(mesh.stage(inputs), ABACUS_OK);
        ASSERT_EQ(mesh.build(), ABACUS_OK) << mesh.error.message;
        EXPECT_EQ(mesh.check(), std::vector<std::string>{});
        EXPECT_EQ(mesh.positions(), cgal_simplices<2>(points));
        EXPECT_GT(mesh.header.counters.rewrites, 0u);
        for (const auto &[key, page] : mesh.host.pages) {
            const PageEditor editor(page, mesh.header);
            for (std::size_t v = 0; v < editor.ids.size(); ++v) {
                const Input &input = *expected.at(editor.points[v]);
                EXPECT_EQ(editor.ids[v], input.id);
                for (int i = 0; i < attributes; ++i)
                    ASSERT_EQ(std::bit_cast<std::uint64_t>(editor.attributes[v][i]),
                              std::bit_cast<std::uint64_t>(input.attributes[i]));
            }
        }
    }
}

TEST(Cache, KeepsToItsBudget) {
    const std::vector<Input> points = number(unit_square_points(60000 / scale, 10));
    for (const std::size_t budget : {128u << 10, 512u << 10, 2048u << 10}) {
        Mesh mesh(0, budget);
        ASSERT_EQ(mesh.stage(points), ABACUS_OK);
        mesh.host.peak_bytes = 0;
        ASSERT_EQ(mesh.build(), ABACUS_OK);
        // One operation may load more, and is not interrupted because of that.
        EXPECT_LE(mesh.header.counters.peak_bytes, budget + (512 << 10));
        // Arrays and tables grow by steps.
        EXPECT_LE(mesh.host.peak_bytes, budget + budget / 2 + (1024 << 10));
        EXPECT_EQ(mesh.host.bytes, 0u);
        // Points that are already there change no page, but load them all.
        ASSERT_EQ(mesh.insert(points), ABACUS_OK);
        EXPECT_LE(mesh.header.counters.peak_bytes, budget + (512 << 10));
    }
}

TEST(Cache, InTheLastRoundFinishedBlocksLeave) {
    // All pages would take some 45 MB, the rounds before the last one less than 2.
    Mesh mesh(0, std::size_t{1} << 30);
    ASSERT_EQ(mesh.insert(number(unit_square_points(400000, 12))), ABACUS_OK);
    const abacus_counters &c = mesh.header.counters;
    EXPECT_LE(c.peak_bytes, 20u << 20);
    EXPECT_GE(c.peak_bytes, 16u << 20);
    EXPECT_LE(c.loads, c.stores / 4); // hardly any page is needed again
    EXPECT_EQ(mesh.header.facts.census.simplices + mesh.header.facts.census.ghosts,
              2 * mesh.header.facts.census.vertices - 2);
}

TEST(Cache, CountsWhatItDoes) {
    Mesh mesh(0, 100 << 10);
    // Without vertex pages in between: all calls are for simplex pages.
    ASSERT_EQ(mesh.insert(number(unit_square_points(8000, 11))), ABACUS_OK);
    const MemoryHost::Calls &calls = mesh.host.calls;
    const abacus_counters &c = mesh.header.counters;
    std::size_t stored_bytes = 0;
    for (const auto &[key, page] : mesh.host.pages) stored_bytes += page.size;
    EXPECT_EQ(c.insertions, mesh.header.facts.census.vertices - 3);
    EXPECT_EQ(c.created - c.deleted,
              mesh.header.facts.census.simplices + mesh.header.facts.census.ghosts);
    EXPECT_EQ(c.stores, calls.put);
    EXPECT_EQ(c.stores - c.rewrites - calls.erase, mesh.host.pages.size());
    EXPECT_EQ(c.splits - c.merges, mesh.host.pages.size() - 1);
    EXPECT_EQ(c.loads, calls.find);
    EXPECT_EQ(c.link_probes, c.misses); // one look-up a miss
    EXPECT_GE(c.misses, c.loads / 2);
    EXPECT_GT(c.evictions, 0u);
    EXPECT_LE(c.eviction_batches, c.evictions);
    EXPECT_GE(c.bytes_written, stored_bytes);
    EXPECT_LE(c.bytes_read, c.loads * ABACUS_PAGE_BYTES);
    EXPECT_EQ(c.incircle_tests, c.insertions);
    EXPECT_EQ(c.incircle_hits + c.walks, c.incircle_tests);
    EXPECT_GT(c.steps, c.created);
    EXPECT_GT(c.total_ns, c.translation_ns);
    EXPECT_GT(c.translation_ns, 0u);
    // A second build that changes nothing writes nothing and adds nothing.
    const abacus_counters sum = c;
    ASSERT_EQ(mesh.build(), ABACUS_OK);
    EXPECT_EQ(mesh.header.counters.stores, sum.stores);
    EXPECT_EQ(mesh.header.counters.insertions, sum.insertions);
}

TEST(Cache, KeepsAnOverfullBlockUntilTheOperationIsOver) {
    MemoryHost memory;
    const Host host = memory.host();
    Cache<2> cache(host, Domain<2>({0, 0}, {1, 1}), 0, {.budget = ample});
    cache.create_first_block();
    Random random(13);
    const std::size_t n = cache.capacity() + 20; // of block_slots<2>
    std::vector<Handle> made;
    const auto make = [&] {
        std::array<VertexIndex, 3> v;
        for (auto &vertex : v)
            vertex = cache.create_vertex({unit(random), unit(random)}, 0, nullptr);
        made.push_back(cache.create(v));
        for (int i = 0; i < 3; ++i) // a link to itself: it has a page's links
            cache.point_at(made.back(), i, make_link(made.back(), i));
    };
    while (made.size() < cache.capacity()) make();
    EXPECT_FALSE(cache.settle(0)); // grows as needed
    while (made.size() < n) make();
    EXPECT_EQ(cache.cached_blocks(), 1u); // all are in slots of their own block
    for (const Handle h : made) EXPECT_TRUE(cache.is_home(h));
    EXPECT_TRUE(cache.settle(0));
    EXPECT_GT(cache.cached_blocks(), 1u);
    EXPECT_FALSE(cache.settle(0));
}

TEST(Cache, MovesSimplicesHomeAndTellsWhere) {
    MemoryHost memory;
    const Host host = memory.host();
    Cache<2> cache(host, Domain<2>({0, 0}, {1, 1}), 0, {.budget = ample});
    cache.create_first_block();
    // Pairs of triangles back to back: many more than a block takes, in one operation.
    Random random(12);
    std::map<Handle, std::array<VertexIndex, 3>> made;
    for (int pair = 0; pair < 1000; ++pair) {
        std::array<VertexIndex, 3> v;
        for (auto &vertex : v)
            vertex = cache.create_vertex({unit(random), unit(random)}, 0, nullptr);
        const Handle front = cache.create(v);
        made[front] = v;
        std::swap(v[0], v[1]);
        const Handle back = cache.create(v);
        made[back] = v;
        constexpr std::array<int, 3> opposite{1, 0, 2};
        for (int i = 0; i < 3; ++i)
            cache.connect(make_link(front, i), make_link(back, opposite[i]));
    }
    EXPECT_TRUE(cache.settle(1ull << 61));
    EXPECT_FALSE(cache.settle(0));
    EXPECT_GT(cache.cached_blocks(), 4u);
    // A handle from before leads to the new place, unless its slot has been used again.
    std::size_t told = 0;
    for (const auto &[handle, vertices] : made) {
        const Handle now = cache.follow(handle);
        told += now != no_handle && cache.simplex(now).vertex == vertices;
    }
    EXPECT_GT(told, made.size() / 2);
    // All are present, at home and linked as before.
    std::size_t found = 0;
    for (Key key = first_key; key < end_key;)
        key = cache.visit(key, [&](Handle h) {
            ++found;
            EXPECT_TRUE(cache.is_home(h));
            for (int i = 0; i < 3; ++i) {
                const Link across = cache.cross(h, i);
                EXPECT_EQ(cache.cross(link_simplex(across), link_facet(across)), make_link(h, i));
                EXPECT_TRUE(cache.is_live(link_simplex(across)));
            }
        });
    EXPECT_EQ(found, made.size());
}

TEST(Cache, TakesAHubLargerThanItself) {
    // The centre of a circle, inserted last, is joined to all of its points.
    const int n = 100000 / scale;
    std::vector<Point<2>> points(n);
    Random random(13);
    for (auto &p : points) {
        const double angle = 2 * M_PI * unit(random);
        p = {std::cos(angle), std::sin(angle)};
    }
    Mesh mesh(0, 256 << 10);
    ASSERT_EQ(mesh.stage(number(points)), ABACUS_OK);
    ASSERT_EQ(mesh.build(), ABACUS_OK) << mesh.error.message;
    ASSERT_EQ(mesh.stage({{n, {0, 0}}}), ABACUS_OK);
    ASSERT_EQ(mesh.build(), ABACUS_OK) << mesh.error.message;
    EXPECT_GE(mesh.header.facts.census.simplices, mesh.header.facts.census.vertices - 1);
    points.push_back({0, 0});
    EXPECT_EQ(mesh.positions(), cgal_simplices<2>(points));
    EXPECT_EQ(mesh.host.violations, std::vector<std::string>{});
    // Afterwards it continues within its budget.
    ASSERT_EQ(mesh.stage({{n + 1, {0.1, 0.2}}, {n + 2, {0.1, 0.3}}}), ABACUS_OK);
    ASSERT_EQ(mesh.build(), ABACUS_OK) << mesh.error.message;
    EXPECT_EQ(mesh.check(), std::vector<std::string>{});
}

} // namespace
} // namespace abacus::test
