// Pages that threads request at the session's desk.
#include "host/crew.hpp"
#include "keys/key.hpp"
#include "support/point_sets.hpp"
#include "support/triangulations.hpp"

#include <gtest/gtest.h>

#include <cstring>

namespace abacus::test {
namespace {

/// Arbitrary contents in a page to be found, perhaps bytes of a former one.
abacus_page left_over() {
    abacus_page page;
    std::memset(&page, 0xff, sizeof page);
    return page;
}

class Reading final : public Crew::Work {
public:
    void piece(std::size_t, const Host &host) override {
        abacus_page page = left_over();
        EXPECT_TRUE(host.next(ABACUS_SIMPLEX_PAGES, nullptr, page));
        EXPECT_TRUE(page.key == first_key);
        const abacus_key first = page.key;
        page = left_over();
        EXPECT_TRUE(host.find(ABACUS_SIMPLEX_PAGES, first, page));
        EXPECT_TRUE(page.key == first_key);
        EXPECT_TRUE(host.fetch(ABACUS_SIMPLEX_PAGES, page));
        page = left_over();
        EXPECT_TRUE(host.next(ABACUS_SIMPLEX_PAGES, &first, page));
        EXPECT_FALSE(page.key == first_key);
        page = left_over();
        EXPECT_FALSE(host.find(ABACUS_REPEATED_PAGES, first, page));
    }
};

TEST(Crew, FindsPagesWhateverWasThereBefore) {
    Random random(5);
    std::vector<Point<2>> points(3000);
    for (Point<2> &p : points)
        for (double &x : p) x = unit(random);
    MeshOf<2> mesh(0);
    ASSERT_EQ(mesh.stage(number<2>(points)), ABACUS_OK);
    ASSERT_EQ(mesh.build(), ABACUS_OK);
    const Host host(*mesh.host.table());
    Crew crew(host);
    Reading work;
    EXPECT_TRUE(crew.run(2, 20, work));
}

/// Stores pages, each more than once, and reports where they were put.
class Storing final : public Crew::Work {
public:
    explicit Storing(bool fails = false) : fails_(fails) {}

    void piece(std::size_t number, const Host &host) override {
        const std::array<std::uint64_t, 2> words{number, 0};
        abacus_page page{{number, 0}, reinterpret_cast<const unsigned char *>(words.data()), 16, 0};
        for (int i = 0; i < 100; ++i) host.put(ABACUS_SIMPLEX_PAGES, page);
        if (fails_) throw Error(ABACUS_ERROR_INTERNAL, "it fails");
        host.erase(ABACUS_SIMPLEX_PAGES, page);
    }

private:
    const bool fails_;
};

TEST(Crew, KeepsNothingOfEarlierRuns) {
    MemoryHost store;
    const Host host = store.host();
    Crew crew(host);
    Storing work;
    ASSERT_TRUE(crew.run(1, 10, work));
    const std::size_t used = crew.memory().used();
    for (int i = 0; i < 20; ++i) ASSERT_TRUE(crew.run(1, 10, work));
    EXPECT_EQ(crew.memory().used(), used);
    EXPECT_TRUE(store.pages.empty());
    EXPECT_EQ(store.violations, std::vector<std::string>{});
}

TEST(Crew, WorksAfterAFailure) {
    MemoryHost store;
    const Host host = store.host();
    Crew crew(host);
    for (int i = 0; i < 20; ++i) {
        Storing fails(true), works;
        EXPECT_THROW(crew.run(2, 4, fails), Error);
        store.pages.clear(); // the transaction has ended
        EXPECT_TRUE(crew.run(2, 4, works));
        EXPECT_TRUE(store.pages.empty());
    }
    EXPECT_EQ(store.violations, std::vector<std::string>{});
}

} // namespace
} // namespace abacus::test
