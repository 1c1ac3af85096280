// abacus_check finds every kind of damage. Each test builds a sound mesh, spoils one thing in it,
// and expects a fault.
#include "geometry/predicates.hpp"
#include "points/vertex_page.hpp"
#include "support/patient.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <random>

namespace abacus::test {
namespace {

/// Whether the quadrilateral around the edge opposite corner i of simplex s can be flipped; if so,
/// sets the two triangles after the flip.
bool flip(const PageEditor &page, int s, int i, std::array<int, 3> &first,
          std::array<int, 3> &second) {
    const int n = page.neighbour(s, i);
    if (n < 0 || page.is_ghost(s) || page.is_ghost(n)) return false;
    const int top = page.simplices[s][i];
    const int a = page.simplices[s][(i + 1) % 3], b = page.simplices[s][(i + 2) % 3];
    int bottom = 0;
    for (const int v : page.simplices[n])
        if (v != a && v != b) bottom = v;
    first = {top, a, bottom};
    second = {top, bottom, b};
    const auto area = [&](const std::array<int, 3> &t) {
        return orientation(page.points[t[0]], page.points[t[1]], page.points[t[2]]);
    };
    return area(first) > 0 && area(second) > 0;
}

TEST(Check, KnowsHowMuchIsLeftOnceThePagesAreCounted) {
    auto points = number(unit_square_points(60000, 1));
    for (const bool apart : {false, true}) {
        const std::uint64_t passes = apart ? 3 : 2;
        for (Input &p : points) p.attributes.assign(apart, p.point[0]);
        Mesh mesh(apart);
        mesh.header.facts.columns.apart = apart;
        ASSERT_EQ(mesh.insert(points), ABACUS_OK);
        const std::uint64_t pages = mesh.host.pages.size();
        ASSERT_GT(pages, 128u);
        std::vector<abacus_progress> reports;
        mesh.host.on_progress = [&](const abacus_progress &p) {
            if (p.phase == ABACUS_PHASE_CHECKING) reports.push_back(p);
        };
        EXPECT_TRUE(mesh.check().empty());
        ASSERT_GE(reports.size(), 2 * passes);
        EXPECT_EQ(reports.front().total, 0u);
        EXPECT_EQ(reports.back().total, passes * pages);
        EXPECT_GT(reports.back().done, (passes - 1) * pages);
        std::uint64_t before = 0;
        for (const abacus_progress &p : reports) {
            EXPECT_GT(p.done, before);
            EXPECT_EQ(p.total, p.done <= pages ? 0 : passes * pages);
            EXPECT_LE(p.done, passes * pages);
            before = p.done;
        }
    }
}

TEST(Check, FindsGeometricDamageInsideAPage) {
    Patient small(60, 0);
    ASSERT_EQ(small.mesh.host.pages.size(), 1u);
    for (const bool ghost : {false, true})
        small.expect_fault("an exchange of corners", ghost ? "link" : "orientation", [&] {
            small.edit(small.page(), [&](PageEditor &page) {
                int s = 0;
                while (page.is_ghost(s) != ghost) ++s;
                std::swap(page.simplices[s][0], page.simplices[s][1]);
            });
        });
    small.expect_fault("all triangles turned over", "orientation", [&] {
        small.edit(small.page(), [](PageEditor &page) {
            for (auto &t : page.simplices) std::swap(t[0], t[1]);
        });
    });
    small.expect_fault("a flipped edge", "delaunay", [&] {
        small.edit(small.page(), [](PageEditor &page) {
            std::array<int, 3> first, second;
            for (int s = 0;; ++s)
                for (int i = 0; i < 3; ++i)
                    if (flip(page, s, i, first, second)) {
                        page.simplices[page.neighbour(s, i)] = second;
                        page.simplices[s] = first;
                        return;
                    }
        });
    });
    small.expect_fault("a dent in the hull", "hull", [&] {
        small.edit(small.page(), [](PageEditor &page) {
            const auto on_hull = [&](int v) {
                for (const auto &c : page.simplices)
                    if (c[2] == PageEditor::infinity && (c[0] == v || c[1] == v)) return true;
                return false;
            };
            for (int g = 0;; ++g) {
                if (!page.is_ghost(g)) continue;
                const int s = page.neighbour(g, 2);
                const int q = page.simplices[g][0], p = page.simplices[g][1];
                int r = 0;
                for (const int v : page.simplices[s])
                    if (v != p && v != q) r = v;
                if (on_hull(r)) continue;
                page.simplices[g] = {q, r, PageEditor::infinity};
                page.simplices[s] = {r, p, PageEditor::infinity};
                return;
            }
        });
        --small.mesh.header.facts.census.simplices;
        ++small.mesh.header.facts.census.ghosts;
    });
    small.expect_fault("a vertex moved far", "orientation", [&] {
        small.edit_vertex(small.input[30].point,
                          [](PageEditor &page, int v) { page.points[v][0] += 0.7; });
    });
    small.expect_fault("a minus zero", "page", [&] {
        small.edit_vertex(small.input[30].point,
                          [](PageEditor &page, int v) { page.points[v][0] = -0.0; });
    });
}

TEST(Check, FindsBoxesThatDoNotFit) {
    Patient small(200, 1);
    for (int i = 0; i < 4; ++i)
        small.expect_fault("a box", "page", [&] {
            MemoryHost::Page &page = small.page();
            std::uint16_t bound; // of the first patch: least and greatest on each axis
            unsigned char *const at = page.bytes() + sizeof(PageHeader) + 4 + 2 * i;
            std::memcpy(&bound, at, sizeof bound);
            bound ^= 1;
            std::memcpy(at, &bound, sizeof bound);
            seal_page(page.bytes(), page.size);
        });
}

TEST(Check, FindsWhatPagesDisagreeAbout) {
    for (const std::size_t cache : {std::size_t(40) << 10, std::size_t(64) << 20}) {
        Patient big(2500, 2, cache);
        ASSERT_GT(big.mesh.host.pages.size(), 10u);
        const auto shared = [&] { // a vertex that several pages have
            PageEditor page(big.middle(), big.mesh.header);
            return page.points[page.vertex(true)];
        }();
        const auto in_one_page = [&](auto change) {
            return [&, change] {
                big.edit(big.middle(),
                         [&](PageEditor &page) { change(page, page.number_of(shared)); });
            };
        };
        const auto id = [](PageEditor &page, int v) { page.ids[v] = 7; };
        const auto attribute = [](PageEditor &page, int v) { page.attributes[v][1] += 1e-9; };
        const auto point = [](PageEditor &page, int v) {
            page.points[v][1] = std::nextafter(page.points[v][1], 2.0);
        };
        big.expect_fault("an id in one page", "link", in_one_page(id));
        big.expect_fault("an attribute in one page", "link", in_one_page(attribute));
        big.expect_fault("a point in one page", "link", in_one_page(point));
    }
}

TEST(Check, FindsWrongLinksAndPlaces) {
    Patient big(2500, 0);
    big.expect_fault("a wrong link", "link", [&] {
        big.edit(big.middle(), [](PageEditor &page) { page.links[3].code += 1u << 20; });
    });
    big.expect_fault("a link to the end of the curve", "link", [&] {
        big.edit(big.middle(), [](PageEditor &page) { page.links[0].code = key_word_end - 1; });
    });
    big.expect_fault("a link that says nothing", "link", [&] {
        big.edit(big.middle(), [](PageEditor &page) { page.links[3].code = unknown_code; });
    });
    big.expect_fault("a part where there is none", "link", [&] {
        big.edit(big.smallest(), [](PageEditor &page) { page.links[3].part = 1; });
    });
    big.expect_fault("exchanged links", "link", [&] {
        big.edit(big.middle(), [](PageEditor &page) {
            const auto other =
                std::find_if(page.links.begin(), page.links.end(),
                             [&](const Key &key) { return key.code != page.links[0].code; });
            std::swap(page.links[0], *other);
        });
    });
    big.expect_fault("a link too few", "link", [&] {
        big.edit(big.middle(), [](PageEditor &page) { page.links.pop_back(); });
    });
    big.expect_fault("a link too many", "link", [&] {
        big.edit(big.middle(), [](PageEditor &page) { page.links.push_back(page.links[0]); });
    });
    big.expect_fault("a vertex without triangles", "page", [&] {
        big.edit(big.middle(), [](PageEditor &page) {
            page.ids.push_back(1);
            page.points.push_back({0.5, 0.5});
            page.attributes.emplace_back();
        });
    });
    big.expect_fault("a dropped triangle", "count", [&] {
        big.edit(big.middle(), [](PageEditor &page) { page.simplices.pop_back(); });
    });
    big.expect_fault("a dropped triangle that is not counted", "euler", [&] {
        big.edit(big.middle(), [](PageEditor &page) {
            int s = 0;
            while (page.is_ghost(s)) ++s;
            page.simplices.erase(page.simplices.begin() + s);
        });
        --big.mesh.header.facts.census.simplices;
    });
    big.expect_fault("a triangle twice in a page", "count", [&] {
        big.edit(big.smallest(),
                 [](PageEditor &page) { page.simplices.push_back(page.simplices[0]); });
    });
    big.expect_fault("a triangle in another page too", "key", [&] {
        PageEditor from(big.page(2), big.mesh.header);
        big.edit(big.middle(), [&](PageEditor &page) {
            std::array<int, 3> copy;
            int s = 0;
            while (from.is_ghost(s)) ++s;
            for (int i = 0; i < 3; ++i) {
                const int v = from.simplices[s][i];
                copy[i] = static_cast<int>(page.ids.size());
                page.ids.push_back(from.ids[v]);
                page.points.push_back(from.points[v]);
                page.attributes.push_back(from.attributes[v]);
            }
            page.simplices.push_back(copy);
        });
    });
}

TEST(Check, FindsPagesMissingOrOutOfPlace) {
    Patient big(2500, 0);
    auto &pages = big.mesh.host.pages;
    for (std::size_t i = 0; i < pages.size(); ++i)
        big.expect_fault("a missing page", "interval",
                         [&] { pages.erase(std::next(pages.begin(), std::ptrdiff_t(i))); });
    big.expect_fault("all pages missing", "count", [&] { pages.clear(); });
    big.expect_fault("a page stored twice", "interval", [&] {
        const auto at = std::next(pages.begin(), 3);
        pages[{at->first.code + 1, 0}] = at->second;
    });
    big.expect_fault("a page under another's key", "interval", [&] {
        std::swap(std::next(pages.begin(), 3)->second, std::next(pages.begin(), 4)->second);
    });
    const auto border = [&](int lower_by, int upper_by) {
        return [&, lower_by, upper_by] {
            const auto at = std::next(pages.begin(), 4);
            PageEditor page(at->second, big.mesh.header);
            page.lower.code += static_cast<std::uint64_t>(lower_by);
            page.upper.code += static_cast<std::uint64_t>(upper_by);
            MemoryHost::Page changed = at->second;
            page.write(changed);
            pages.erase(at);
            pages[page.lower] = changed;
        };
    };
    big.expect_fault("a gap below", "interval", border(1, 0));
    big.expect_fault("an overlap below", "interval", border(-1, 0));
    big.expect_fault("an overlap above", "interval", border(0, 1));
    big.expect_fault("a gap above", "interval", border(0, -1));
    big.expect_fault("a border in another place", "key", [&] {
        // Both pages agree, but triangles lie on the wrong side.
        const auto at = std::next(pages.begin(), 4);
        const Key lower = at->first, moved{lower.code + (lower.code >> 4), 0};
        PageEditor before(std::prev(at)->second, big.mesh.header),
            after(at->second, big.mesh.header);
        before.upper = after.lower = moved;
        before.write(std::prev(at)->second);
        MemoryHost::Page changed;
        after.write(changed);
        pages.erase(at);
        pages[moved] = changed;
    });
}

TEST(Check, FindsDamageOfThePointsThatWait) {
    Patient big(300, 1);
    ASSERT_EQ(big.mesh.stage(random_points(2500, 1, 2)), ABACUS_OK);
    big.keep();
    auto &pages = big.mesh.host.staged_pages;
    ASSERT_GT(pages.size(), 3u);
    for (std::size_t i = 0; i < pages.size(); ++i)
        big.expect_fault("a missing vertex page", "point",
                         [&] { pages.erase(std::next(pages.begin(), std::ptrdiff_t(i))); });
    big.expect_fault("a page among others", "point", [&] {
        const auto [key, page] = *std::next(pages.begin());
        pages[{key.code + 1, 0}] = page;
    });
    big.expect_fault("an x that is no number", "point", [&] {
        auto &page = std::next(pages.begin())->second;
        page.words[VertexPageHeader::words + 1] = ~std::uint64_t(0);
    });
    for (const std::int64_t step : {-1, 1}) {
        big.expect_fault("fewer or more", step < 0 ? "count" : "point",
                         [&] { big.mesh.header.facts.census.staged += 200 * step; });
        big.expect_fault("others", step < 0 ? "point" : "count",
                         [&] { big.mesh.header.facts.census.inserted += step < 0 ? -200 : 400; });
    }
    big.expect_fault("points that were inserted", "count", [&] {
        big.mesh.header.facts.census.inserted = big.mesh.header.facts.census.staged;
    });
}

TEST(Check, FindsDamageOfRepeatedPoints) {
    std::vector<Input> points = random_points(600, 1);
    for (int i = 0; i < 400; ++i) points.push_back({5000 + i, points[i].point, {0.5}});
    Patient patient(points);
    ASSERT_EQ(patient.mesh.header.facts.census.duplicates, 400u);
    auto &pages = patient.mesh.host.repeated_pages;
    ASSERT_GT(pages.size(), 2u);
    const auto second = [&]() -> MemoryHost::Page & { return std::next(pages.begin())->second; };
    patient.expect_fault("a missing page", "count", [&] { pages.erase(pages.begin()); });
    patient.expect_fault("an empty page", "count", [&] { // after its header: nothing
        second().words[1] = 0;
        second().size = 16;
    });
    patient.expect_fault("a page under another key", "point", [&] {
        pages[{key_word_end - 1, 0}] = second();
        pages.erase(std::next(pages.begin()));
    });
    patient.expect_fault("a serial number", "count", [&] { second().words[2] = 400; });
    patient.expect_fault("another place", "point", [&] { second().words[5] ^= 1; });
    for (std::size_t word = 0; word < 2; ++word)
        patient.expect_fault("its header", "point", [&] { ++second().words[word]; });
    for (const int step : {-1, 1})
        patient.expect_fault("their number", "count",
                             [&] { patient.mesh.header.facts.census.duplicates += step; });
}

TEST(Check, FindsEveryWrongCountOfTheHeader) {
    Patient big(800, 0);
    using Field = std::uint64_t abacus_census::*;
    for (const Field field :
         {&abacus_census::duplicates, &abacus_census::simplices, &abacus_census::ghosts})
        for (const std::uint64_t value : {std::uint64_t(0), std::uint64_t(1) << 40})
            big.expect_fault("a count", "count", [&] {
                big.mesh.header.facts.census.*field =
                    value == big.mesh.header.facts.census.*field ? 1 : value;
            });
    for (const int step : {-1, 1}) {
        big.expect_fault("vertices", "euler",
                         [&] { big.mesh.header.facts.census.vertices += step; });
        big.expect_fault("triangles and ghosts", "count", [&] {
            big.mesh.header.facts.census.simplices += step;
            big.mesh.header.facts.census.ghosts -= step;
        });
    }
    big.expect_fault("a domain", "key", [&] { big.mesh.header.facts.form.upper[0] *= 2; });
    big.expect_fault("attributes", "page", [&] { big.mesh.header.facts.columns.attributes = 1; });
}

} // namespace
} // namespace abacus::test
