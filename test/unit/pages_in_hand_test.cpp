// Pages in hand are found beside stored ones, and stored once.
#include "host/pages_in_hand.hpp"
#include "support/memory_host.hpp"

#include <abacus/page_kinds.h>
#include <gtest/gtest.h>

#include <array>

namespace abacus::test {
namespace {

constexpr abacus_page_kind kind = ABACUS_SIMPLEX_PAGES;

class PagesInHandTest : public testing::Test {
protected:
    /// A page whose bytes show what it is.
    static abacus_page page(std::uint64_t code, unsigned char mark, std::uint64_t location = 0) {
        static std::array<unsigned char, 4096> bytes;
        bytes.fill(mark);
        return {{code, 0}, bytes.data(), 100 + mark % 8u, location};
    }
    std::uint64_t stored(std::uint64_t code, unsigned char mark) {
        abacus_page p = page(code, mark);
        host.put(kind, p);
        return p.location;
    }
    struct Kept {
        std::uint64_t code;
        unsigned char mark;
        std::uint64_t location = 0; ///< of a version that is stored
    };
    void keep(const std::vector<Kept> &pages, std::size_t most_bytes = 1 << 20) {
        const Host keeping(host, in_hand);
        in_hand.begin(kind, most_bytes);
        for (const Kept &kept : pages) {
            abacus_page p = page(kept.code, kept.mark, kept.location);
            keeping.put(kind, p);
        }
        in_hand.end(host);
    }
    /// The code and the mark of the page that owns a code, or zeros.
    std::pair<std::uint64_t, unsigned char> find(std::uint64_t code) {
        abacus_page p{};
        if (!in_hand.find(host, kind, {code, 0}, p)) return {0, 0};
        location = p.location;
        EXPECT_EQ(p.size, 100 + p.bytes[0] % 8u);
        EXPECT_EQ(p.bytes[p.size - 1], p.bytes[0]);
        return {p.key.code, p.bytes[0]};
    }
    using Found = std::pair<std::uint64_t, unsigned char>;

    MemoryHost memory;
    const Host host = memory.host();
    PagesInHand in_hand{host};
    std::uint64_t location = 0; // of what was found last
};

TEST_F(PagesInHandTest, AreFoundAndStoredOnce) {
    keep({{20, 2}, {0, 1}, {10, 3}});
    EXPECT_TRUE(memory.pages.empty());
    EXPECT_EQ(find(5), Found(0, 1));
    EXPECT_EQ(find(10), Found(10, 3));
    EXPECT_EQ(find(99), Found(20, 2));
    EXPECT_EQ(memory.calls.find, 0u); // nothing is stored, and nobody has changed them
    abacus_page changed = page(20, 7, location);
    in_hand.put(host, kind, changed);
    EXPECT_EQ(memory.pages.size(), 1u);
    EXPECT_EQ(find(99), Found(20, 7));
    EXPECT_EQ(in_hand.stored_first(), 1u);
    abacus_page added = page(30, 8);
    in_hand.put(host, kind, added);
    EXPECT_EQ(find(99), Found(30, 8));
    const PagesInHand::Count rest = in_hand.store(host);
    EXPECT_EQ(rest.pages, 2u);
    EXPECT_EQ(rest.new_versions, 0u);
    EXPECT_TRUE(in_hand.empty());
    EXPECT_EQ(memory.pages.size(), 4u);
    EXPECT_EQ(find(15), Found(10, 3));
    EXPECT_EQ(memory.violations, std::vector<std::string>{});
}

TEST_F(PagesInHandTest, HideTheVersionsThatAreStored) {
    const std::uint64_t first = stored(0, 1), second = stored(10, 2);
    stored(20, 3);
    keep({{10, 4, second}, {15, 5}});
    EXPECT_EQ(find(3), Found(0, 1));
    EXPECT_EQ(location, first);
    EXPECT_EQ(find(12), Found(10, 4));
    EXPECT_EQ(find(17), Found(15, 5));
    EXPECT_EQ(find(25), Found(20, 3));
    abacus_page next{};
    std::vector<std::uint64_t> codes;
    for (bool more = in_hand.next(host, kind, nullptr, next); more;
         more = in_hand.next(host, kind, &next.key, next))
        codes.push_back(next.key.code);
    EXPECT_EQ(codes, (std::vector<std::uint64_t>{0, 10, 15, 20}));
    find(12);
    abacus_page changed = page(10, 6, location);
    in_hand.put(host, kind, changed);
    EXPECT_EQ(in_hand.stored_first(), 0u); // a new version
    EXPECT_EQ(memory.pages.size(), 3u);
    EXPECT_EQ(find(12), Found(10, 6));
}

TEST_F(PagesInHandTest, MayBeErased) {
    const std::uint64_t old = stored(0, 1);
    keep({{0, 2, old}, {10, 3}});
    EXPECT_EQ(find(10), Found(10, 3));
    in_hand.erase(host, kind, {{10, 0}, nullptr, 0, location});
    EXPECT_EQ(memory.calls.erase, 0u); // it was never stored
    EXPECT_EQ(find(10), Found(0, 2));
    in_hand.erase(host, kind, {{0, 0}, nullptr, 0, location});
    EXPECT_TRUE(memory.pages.empty());
    EXPECT_EQ(find(10), Found(0, 0));
    abacus_page gone{{0, 0}, nullptr, 0, location};
    EXPECT_THROW(in_hand.fetch(host, kind, gone), Error);
    EXPECT_EQ(in_hand.store(host).pages, 0u);
}

TEST_F(PagesInHandTest, TakeNoMoreThanTheirShare) {
    keep({{0, 0}, {10, 0}, {20, 0}}, 250); // 104 bytes each
    EXPECT_EQ(memory.pages.size(), 1u);
    EXPECT_EQ(in_hand.kept().pages, 2u);
    EXPECT_LE(in_hand.bytes(), 250u);
    EXPECT_EQ(find(25).first, 20u);
    EXPECT_EQ(find(15).first, 10u);
}

TEST_F(PagesInHandTest, AreOfOneKind) {
    keep({{0, 1}});
    abacus_page other{};
    EXPECT_FALSE(in_hand.find(host, ABACUS_ATTRIBUTE_PAGES, {5, 0}, other));
    other = page(0, 9);
    in_hand.put(host, ABACUS_ATTRIBUTE_PAGES, other);
    EXPECT_EQ(memory.attribute_pages.size(), 1u);
    EXPECT_EQ(find(5), Found(0, 1));
}

} // namespace
} // namespace abacus::test
