// The simplex page: written data can be read again, and anything else is refused.
#include "mesh/page_writer.hpp"
#include "support/memory_host.hpp"
#include "support/patient.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <random>
#include <vector>

namespace abacus::test {
namespace {

using Words = std::vector<std::uint64_t>;

/// The words after writing and reading a column; checks its size.
Words through_a_column(const Words &words) {
    const ColumnPlan plan(words.data(), words.size());
    std::vector<unsigned char> bytes(plan.size() + 16, 0xaa);
    unsigned char *const deltas = plan.write_head(bytes.data());
    unsigned char *const end = plan.write_deltas(words.data(), deltas);
    EXPECT_EQ(static_cast<std::size_t>(end - bytes.data()), plan.size());
    bytes.resize(plan.size() + 8); // the bytes of a page after its columns
    const unsigned char *at = bytes.data();
    Column column;
    EXPECT_TRUE(column.read_head(at, deltas));
    EXPECT_EQ(at, deltas);
    EXPECT_TRUE(column.read_deltas(at, end, words.size()));
    EXPECT_EQ(at, end);
    const unsigned char *cut = bytes.data();
    Column none;
    EXPECT_FALSE(none.read_head(cut, deltas - 1));
    if (deltas != end) {
        cut = deltas;
        none = column;
        EXPECT_FALSE(none.read_deltas(cut, end - 1, words.size()));
    }
    Words result;
    for (std::size_t i = 0; i < words.size(); ++i) result.push_back(column[i]);
    return result;
}

TEST(Column, GivesBackWordsOfEveryWidthAndShift) {
    std::mt19937_64 random(1);
    for (int width = 0; width <= 64; ++width)
        for (const int shift : {0, 1, 7, 31, 63}) {
            if (width + shift > 64) continue;
            for (const std::uint64_t base : {std::uint64_t(0), std::uint64_t(1), random()}) {
                Words words;
                for (int i = 0; i < 70; ++i)
                    words.push_back(base + ((width == 0 ? 0 : random() >> (64 - width)) << shift));
                ASSERT_EQ(through_a_column(words), words) << width << " << " << shift;
            }
        }
    EXPECT_EQ(through_a_column({}), Words{});
    EXPECT_EQ(through_a_column({~0ull}), Words{~0ull});
    EXPECT_EQ(through_a_column({0, ~0ull, 1}), (Words{0, ~0ull, 1}));
}

TEST(Column, TakesNoMoreBitsThanWordsDifferIn) {
    Words words;
    for (std::uint64_t i = 0; i < 256; ++i) words.push_back((1ull << 60) + (i << 20));
    EXPECT_EQ(ColumnPlan(words.data(), words.size()).size(), 2u + 8u + 256u);
    const Words same(1000, 12345);
    EXPECT_EQ(ColumnPlan(same.data(), same.size()).size(), 2u + 8u);
    const Words zero(1000, 0);
    EXPECT_EQ(ColumnPlan(zero.data(), zero.size()).size(), 2u);
}

TEST(Column, OrdersDoublesAsTheyAre) {
    const double inf = std::numeric_limits<double>::infinity();
    const std::vector<double> ascending{-inf, -1e300, -1, -5e-324, 0, 5e-324, 1, 1.5, 1e300, inf};
    for (std::size_t i = 0; i < ascending.size(); ++i) {
        EXPECT_EQ(from_ordered(ordered(ascending[i])), ascending[i]);
        if (i > 0) {
            EXPECT_LT(ordered(ascending[i - 1]), ordered(ascending[i]));
        }
    }
    EXPECT_TRUE(std::signbit(from_ordered(ordered(-0.0))));
    const auto payload = std::bit_cast<double>(0xfff8123456789abcull);
    EXPECT_EQ(std::bit_cast<std::uint64_t>(from_ordered(ordered(payload))), 0xfff8123456789abcull);
}

TEST(Column, ComparesWordsByTheirPrefixes) {
    std::mt19937_64 random(2);
    for (int width = 0; width <= 64; ++width)
        for (const int shift : {0, 3, 40}) {
            if (width + shift > 60 && shift > 0) continue;
            const std::uint64_t base = shift > 0 ? random() >> 4 : 0;
            Words words;
            for (int i = 0; i < 90; ++i)
                words.push_back(base + ((width == 0 ? 0 : random() >> (64 - width)) << shift));
            const ColumnPlan plan(words.data(), words.size());
            std::vector<unsigned char> bytes(plan.size() + 16);
            const unsigned char *at = bytes.data();
            plan.write_deltas(words.data(), plan.write_head(bytes.data()));
            Column column;
            ASSERT_TRUE(column.read_head(at, bytes.data() + plan.size()));
            ASSERT_TRUE(column.read_deltas(at, bytes.data() + plan.size(), words.size()));
            for (std::size_t i = 0; i < words.size(); ++i) {
                ASSERT_EQ(column.prefix_at(i), column.prefix(words[i]));
                ASSERT_EQ(plan.prefix(words[i]), column.prefix(words[i]));
            }
            std::vector<Column::Prefix> prefixes(80);
            column.prefixes(10, 90, prefixes.data());
            for (const std::uint64_t other :
                 Words{words[3], words[40] + 1, base - 1, base, random(), ~0ull}) {
                const Column::Prefix prefix = column.prefix(other);
                for (std::size_t i = 10; i < 90; ++i) {
                    if (prefixes[i - 10] != prefix) {
                        ASSERT_EQ(prefixes[i - 10] < prefix, words[i] < other);
                    }
                    if (words[i] == other) {
                        ASSERT_EQ(prefixes[i - 10], prefix);
                    }
                }
            }
        }
}

// The child has the facet, the apex opposite, and the other orientation. If the apex took the place
// of the corner that it replaces, the two orders would differ by an odd permutation.
template <int D, class Word> void expect_children_beyond_their_facets() {
    using Number = std::remove_cvref_t<decltype(Word{}[0])>;
    constexpr Number infinity = 100;
    for (const bool is_ghost : {false, true})
        for (int f = 0; f <= D; ++f)
            for (const Number apex : {Number{50}, infinity}) {
                if (apex == infinity && is_ghost && f != D) continue; // it would occur twice
                Word parent = Word{} + no_vertex;
                for (int i = 0; i <= D; ++i) parent[i] = static_cast<Number>(10 + i);
                if (is_ghost) parent[D] = infinity;
                const Word everywhere = Word{} + apex;
                const bool is_first_ghost = apex == infinity && f != D;
                const Word child = is_first_ghost ? ghost_across<D>(parent, f, everywhere)
                                                  : child_across(parent, f, everywhere);
                EXPECT_EQ(child[is_first_ghost ? D : facet_back(f)], apex);
                if (is_ghost && f != D) {
                    EXPECT_EQ(child[D], infinity);
                }

                Word replaced = parent;
                replaced[f] = apex;
                int moved = 0; // an exchange moves two, and is odd
                for (int i = 0; i <= D; ++i) moved += child[i] != replaced[i];
                EXPECT_EQ(moved, 2);
                for (int i = 0; i < lanes; ++i) {
                    int times = 0;
                    for (int j = 0; j < lanes; ++j) times += child[j] == replaced[i];
                    EXPECT_EQ(times, 1);
                }
            }
}

TEST(PageTree, ChildrenLieBeyondTheirFacets) {
    expect_children_beyond_their_facets<2, Lanes>();
    expect_children_beyond_their_facets<2, WideLanes>();
    expect_children_beyond_their_facets<3, Lanes>();
    expect_children_beyond_their_facets<3, WideLanes>();
}

/// A square of four vertices in two triangles, with a link across each of its sides.
class Square : public testing::Test {
protected:
    Square() : host_(memory_.host()), writer_(host_) {}

    const PageView<2> &write(bool told) {
        VertexHeap<2> vertices(host_, 1);
        const Point<2> points[] = {{0, 0}, {1, 0}, {1, 1}, {0, 1}};
        for (std::size_t v = 0; v < 4; ++v) {
            const double height = 0.5 * static_cast<double>(v);
            vertices.create(points[v], 10 * v, 100 + static_cast<std::int64_t>(v), &height);
        }
        const Link side = told ? absent : PageWriter<2>::untold;
        const Simplex<2> slots[] = {
            {{VertexIndex{1}, VertexIndex{2}, VertexIndex{3}},
             {side, told ? make_link(Handle{1}, 1) : side, side}},
            {{VertexIndex{3}, VertexIndex{4}, VertexIndex{1}},
             {side, told ? make_link(Handle{0}, 1) : side, side}},
        };
        VertexHeap<2>::Numbering numbered(host_);
        Arena<Link> border(host_);
        writer_.order(slots, 2, Handle{}, vertices, numbered, border);
        EXPECT_EQ(border.size(), told ? 4u : 0u);
        writer_.expect_links(4);
        for (std::size_t i = 0; i < 4; ++i) writer_.set_link(i, {i < 2 ? 10 * i : 1000 + i, 0});
        const bool on_border[] = {true, true, true, true};
        EXPECT_TRUE(writer_.finish({5, 6}, {7, 8}, vertices, numbered, on_border));
        view_.read(writer_.bytes(), writer_.size(), 1);
        return view_;
    }
    abacus_error_kind kind_of(const std::vector<unsigned char> &bytes, std::string &detail) {
        try {
            view_.read(bytes.data(), bytes.size(), 1);
        } catch (const Error &error) {
            detail = error.detail;
            return error.kind;
        }
        return ABACUS_ERROR_INTERNAL;
    }
    std::vector<unsigned char> bytes() const {
        return {writer_.bytes(), writer_.bytes() + writer_.size()};
    }

    MemoryHost memory_;
    Host host_;
    PageWriter<2> writer_;
    PageView<2> view_;
};

TEST_F(Square, IsReadAsItWasWritten) {
    for (const bool told : {false, true}) {
        const PageView<2> &page = write(told);
        EXPECT_TRUE((page.lower() == Key{5, 6}));
        EXPECT_TRUE((page.upper() == Key{7, 8}));
        ASSERT_EQ(page.simplices(), 2);
        ASSERT_EQ(page.vertices(), 4);
        EXPECT_EQ(page.box(0), 0);
        EXPECT_EQ(page.box(3), 1);
        std::vector<std::int64_t> ids;
        for (int v = 0; v < 4; ++v) {
            const auto i = page.id(v) - 100;
            ids.push_back(i);
            EXPECT_EQ(page.point(v), (Point<2>{i == 1 || i == 2 ? 1.0 : 0.0, i > 1 ? 1.0 : 0.0}));
            EXPECT_EQ(page.attribute(v, 0), 0.5 * static_cast<double>(i));
        }
        for (int s = 0; s < 2; ++s) { // counterclockwise
            const auto p = [&](int i) { return page.point(page.corner(s, i)); };
            EXPECT_GT((p(1)[0] - p(0)[0]) * (p(2)[1] - p(0)[1]) -
                          (p(1)[1] - p(0)[1]) * (p(2)[0] - p(0)[0]),
                      0);
        }
        EXPECT_EQ(page.parent(0), PageView<2>::no_link);
        EXPECT_EQ(page.parent(1), told ? page_link(0, 1) : PageView<2>::no_link);
        // Two links lead to codes of vertices in the page, two to other codes.
        ASSERT_EQ(page.links(), 4);
        std::vector<std::uint64_t> codes;
        for (int i = 0; i < 4; ++i) {
            const int v = page.link_vertex(i);
            codes.push_back(v < 4 ? static_cast<std::uint64_t>(10 * ids[v]) : page.foreign_code(v));
        }
        std::sort(codes.begin(), codes.end());
        EXPECT_EQ(codes, (Words{0, 10, 1002, 1003}));
        EXPECT_FALSE(page.has_parts());
    }
}

TEST_F(Square, IsSmallerWhenNeighboursAreTold) {
    write(false);
    const std::size_t untold = writer_.size();
    write(true);
    EXPECT_LT(writer_.size(), untold);
}

TEST_F(Square, IsRefusedAfterAnyChange) {
    write(true);
    const auto sound = bytes();
    std::string detail;
    for (std::size_t bit = 0; bit < 8 * sound.size(); ++bit) {
        auto changed = sound;
        changed[bit / 8] ^= static_cast<unsigned char>(1 << bit % 8);
        ASSERT_EQ(kind_of(changed, detail), ABACUS_ERROR_CORRUPTED) << bit;
    }
    for (std::size_t size = 0; size < sound.size(); ++size)
        ASSERT_EQ(kind_of({sound.begin(), sound.begin() + std::ptrdiff_t(size)}, detail),
                  ABACUS_ERROR_CORRUPTED);
}

TEST_F(Square, IsReadWithoutItsChecksumIfSoWished) {
    write(true);
    auto changed = bytes();
    changed.back() ^= 1;
    EXPECT_FALSE(page_is_sealed(changed.data(), changed.size()));
    view_.read(changed.data(), changed.size(), 1, PageView<2>::Checksum::ignore);
    EXPECT_EQ(view_.simplices(), 2);
    seal_page(changed.data(), changed.size());
    EXPECT_EQ(changed, bytes());
}

TEST_F(Square, OfAnotherFormatVersionIsToldApart) {
    write(true);
    auto changed = bytes();
    changed[4] = 1;
    seal_page(changed.data(), changed.size());
    std::string detail;
    EXPECT_EQ(kind_of(changed, detail), ABACUS_ERROR_CORRUPTED);
    EXPECT_EQ(detail, "A simplex page has format version 1, not 3.");
}

TEST(Pages, WithoutSimplicesAreWrittenToo) {
    MemoryHost memory;
    const Host host = memory.host();
    VertexHeap<2> vertices(host, 0);
    VertexHeap<2>::Numbering numbered(host);
    Arena<Link> border(host);
    PageWriter<2> writer(host); // its first page
    writer.order(nullptr, 0, Handle{}, vertices, numbered, border);
    ASSERT_TRUE(writer.finish({5, 6}, {7, 8}, vertices, numbered, nullptr));
    PageView<2> view;
    view.read(writer.bytes(), writer.size(), 0);
    EXPECT_EQ(view.simplices(), 0);
    EXPECT_TRUE((view.lower() == Key{5, 6}));
}

TEST(Pages, AreWellFilled) {
    // Enough for the core to learn how many simplices fit into a page.
    Mesh mesh(0, std::size_t(64) << 20);
    ASSERT_EQ(mesh.stage(random_points(60000, 0)), ABACUS_OK);
    ASSERT_EQ(mesh.build(), ABACUS_OK);
    std::size_t bytes = 0;
    for (const auto &[key, page] : mesh.host.pages) bytes += page.size;
    EXPECT_GT(bytes, mesh.host.pages.size() * ABACUS_PAGE_BYTES * 85 / 100);
    EXPECT_LT(bytes, mesh.header.facts.census.simplices * 12);
}

TEST(Pages, HoldMoreOfWhatLiesOnAGrid) {
    const auto bytes_of = [](bool grid) {
        std::vector<Input> points = random_points(4000, 1);
        for (std::size_t i = 0; grid && i < points.size(); ++i) {
            points[i].point = {double(i % 64), double(i / 64)};
            points[i].attributes[0] = double(i % 7);
        }
        Mesh mesh(1, std::size_t(64) << 20);
        EXPECT_EQ(mesh.stage(points), ABACUS_OK);
        EXPECT_EQ(mesh.build(), ABACUS_OK);
        EXPECT_EQ(mesh.check(), std::vector<std::string>{});
        std::size_t bytes = 0;
        for (const auto &[key, page] : mesh.host.pages) bytes += page.size;
        return bytes;
    };
    EXPECT_LT(2 * bytes_of(true), bytes_of(false));
}

} // namespace
} // namespace abacus::test
