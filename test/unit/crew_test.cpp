// Pages that threads request at the session's desk.
#include "host/crew.hpp"
#include "keys/key.hpp"
#include "support/point_sets.hpp"
#include "support/triangulations.hpp"

#include <gtest/gtest.h>

#include <atomic>
#include <cstring>
#include <thread>

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

TEST(Crew, WorksBesideTheSessionsThread) {
    MemoryHost store;
    const Host host = store.host();
    Crew crew(host);
    Storing work;
    for (int i = 0; i < 20; ++i) {
        ASSERT_TRUE(crew.begin(2, 10, work));
        EXPECT_TRUE(crew.has_begun());
        while (crew.serve()) std::this_thread::yield();
        crew.finish();
        EXPECT_FALSE(crew.has_begun());
    }
    EXPECT_TRUE(store.pages.empty());
    Storing fails(true);
    ASSERT_TRUE(crew.begin(2, 10, fails));
    EXPECT_THROW(crew.finish(), Error);
    EXPECT_FALSE(crew.has_begun());
    EXPECT_EQ(store.violations, std::vector<std::string>{});
}

// While the session waits for the second crew, threads of the first one get their pages.
TEST(Crew, IsServedWhileAnotherOneRuns) {
    MemoryHost store;
    const Host host = store.host();
    Crew first(host), second(host);
    std::atomic<bool> has_ended = false;
    class Watched final : public Crew::Work {
    public:
        explicit Watched(std::atomic<bool> &has_ended) : has_ended_(has_ended) {}
        void piece(std::size_t number, const Host &host) override {
            Storing().piece(number, host);
            abacus_page page = left_over();
            EXPECT_FALSE(host.find(ABACUS_SIMPLEX_PAGES, {number, 0}, page));
            has_ended_ = true;
        }

    private:
        std::atomic<bool> &has_ended_;
    } work(has_ended);
    ASSERT_TRUE(first.begin(1, 1, work));
    EXPECT_TRUE(second.run_each(1, 1, [&](std::size_t, const Host &) {
        while (!has_ended) std::this_thread::yield();
    }));
    first.finish();
    EXPECT_TRUE(store.pages.empty());
    EXPECT_EQ(store.violations, std::vector<std::string>{});
}

// A thread that waits for anything but a page ends when the crew is stopped, or goes.
TEST(Crew, GivesUp) {
    class Waiting final : public Crew::Work {
    public:
        void piece(std::size_t, const Host &) override { gives_up_.wait(false); }
        void give_up() noexcept override {
            gives_up_ = true;
            gives_up_.notify_all();
        }

    private:
        std::atomic<bool> gives_up_ = false;
    };
    MemoryHost store;
    const Host host = store.host();
    for (int i = 0; i < 3; ++i) {
        Waiting work; // outlives the crew
        Crew crew(host);
        ASSERT_TRUE(crew.begin(3, 3, work));
        if (i == 0) crew.stop();
        if (i == 1) Crew::stop_all();
    }
    EXPECT_EQ(store.bytes, 0u);
}

} // namespace
} // namespace abacus::test
