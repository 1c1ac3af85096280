// Pages that threads ask for at the session's desk.
#include "host/crew.hpp"
#include "keys/key.hpp"
#include "support/point_sets.hpp"
#include "support/triangulations.hpp"

#include <gtest/gtest.h>

#include <cstring>

namespace abacus::test {
namespace {

/// Whatever is in a page that is to be found, bytes of a former one perhaps.
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

} // namespace
} // namespace abacus::test
