// Pages of octrees, the cache over them, the counters, and damaged pages or a failing host.
#include "octree/octree_load.hpp"
#include "support/octrees.hpp"

#include <set>

namespace abacus::test {
namespace {

template <class T> class OctreePages : public testing::Test {};
TYPED_TEST_SUITE(OctreePages, Dimensions);

/// The additional memory that an act takes at its peak.
template <class Act> std::size_t peak_of(MemoryHost &host, Act act) {
    const std::size_t before = host.bytes;
    host.peak_bytes = before;
    act();
    return host.peak_bytes - before;
}

TYPED_TEST(OctreePages, take_no_more_memory_than_they_are_given) {
    constexpr int D = TypeParam::value;
    constexpr std::size_t block = LeafBlocks<D>::slots * sizeof(Leaf<D>);
    Coded<D> octree;
    ASSERT_GT(octree.host->pages.size(), 16u);
    std::vector<Octant<D>> some;
    for (const Octant<D> &leaf : octree.model.list())
        if (leaf.code % 8 == 0) some.push_back(leaf);
    const auto merge = [&] { octree.merge(some, 1); };
    EXPECT_LT(peak_of(*octree.host, merge), 8 * block + octree.memory / 2) << "nothing to merge";

    // Places that are already fine enough, on every page.
    constexpr std::size_t memory = 12 * block;
    const auto refine = [&] {
        const Host h = octree.host->host();
        Growth<D> growth(h, octree.header, memory);
        for (std::uint64_t i = 0; i < octree.header.facts.census.leaves / 512; ++i)
            growth.add(octree.place(octree.random() % domain_cells<D>), 0);
        growth.to_levels(octree.header);
    };
    EXPECT_LT(peak_of(*octree.host, refine), memory) << "nothing to split";

    StoredOctree<D> empty;
    empty.spread_root(64);
    const auto find = [&] {
        const Host h = empty.host->host();
        OctreeReader<D> reader(h, empty.header, 1);
        EXPECT_EQ(reader.cache().octant(reader.find(domain_cells<D> - 1)), Octant<D>{});
    };
    EXPECT_LT(peak_of(*empty.host, find), 8 * block) << "a walk over empty pages";
    empty.host->cancel();
    EXPECT_THROW(find(), HostFailure) << "... that can be cancelled";
}

TYPED_TEST(OctreePages, keep_the_pages_that_are_read_again) {
    constexpr int D = TypeParam::value;
    constexpr std::size_t block = LeafBlocks<D>::slots * sizeof(Leaf<D>);
    Coded<D> octree;
    const Host h = octree.host->host();
    OctreeReader<D> reader(h, octree.header, 8 * block);
    for (const auto &[key, page] : octree.host->pages) {
        reader.find(key.code);
        reader.find(0);
    }
    EXPECT_EQ(reader.cache().counters.loads, octree.host->pages.size());
    EXPECT_GT(reader.cache().counters.evictions, 0u);
}

TYPED_TEST(OctreePages, count_what_they_do_and_tell_how_far_they_are) {
    constexpr int D = TypeParam::value;
    Coded<D> octree;
    std::set<int> phases;
    octree.host->on_progress = [&](const abacus_progress &progress) {
        phases.insert(progress.phase);
        if (progress.total > 0) {
            EXPECT_LE(progress.done, progress.total);
        }
    };
    const auto tells = [&](std::set<int> expected) {
        EXPECT_THAT(phases, testing::IsSupersetOf(expected));
        phases.clear();
        const abacus_counters &counters = octree.header.counters;
        EXPECT_EQ(counters.created - counters.deleted, octree.header.facts.census.leaves);
        EXPECT_GE(counters.stores, counters.rewrites);
        EXPECT_GT(counters.bytes_written, octree.host->pages.size());
    };
    octree.balance(D);
    tells({ABACUS_PHASE_SCANNING, ABACUS_PHASE_SORTING, ABACUS_PHASE_FLUSHING});
    octree.merge({Octant<D>{}.child(1)});
    tells({ABACUS_PHASE_LOCATING});
    octree.split_to_points({1, 2, 3}, 1);
    tells({ABACUS_PHASE_SCANNING, ABACUS_PHASE_FLUSHING});
    octree.split_to({{domain_cells<D> / 2, finest_level<D>}});
    tells({ABACUS_PHASE_LOCATING});
    SizesAsked sizes;
    const Host h = octree.host->host();
    Growth<D>(h, octree.header, octree.memory)
        .to_sizes(size_near_center<D>, &sizes, 1, octree.header);
    tells({ABACUS_PHASE_SCANNING, ABACUS_PHASE_READING, ABACUS_PHASE_FLUSHING});
    octree.merge({{}});
    OctreeLoad<D> load(h, octree.header, octree.memory);
    const double values[2] = {1, 2};
    for (int i = 0; i < Octant<D>::children; ++i) load.add(Octant<D>{}.child(i).code, 1, values);
    load.write(octree.header);
    tells({ABACUS_PHASE_FLUSHING});
}

TYPED_TEST(OctreePages, do_not_depend_on_order_and_memory) {
    constexpr int D = TypeParam::value;
    std::mt19937_64 random(7);
    auto cells = random_cells<D>(random, 4000, D == 2 ? 11 : 8);
    StoredOctree<D> a, b;
    a.split_to(cells);
    std::shuffle(cells.begin(), cells.end(), random);
    b.split_to(cells);
    a.balance(D, std::size_t{64} << 20);
    b.balance(D, 1); // the least memory of a sort
    EXPECT_EQ(a.list(), b.list());
    EXPECT_TRUE(b.host->spools.empty());
    ASSERT_EQ(a.host->pages.size(), b.host->pages.size());
    // At most one byte for each leaf.
    std::size_t bytes = 0;
    for (const auto &[key, page] : a.host->pages) bytes += page.size;
    EXPECT_LE(bytes, a.header.facts.census.leaves);
}

TYPED_TEST(OctreePages, do_not_trust_their_pages) {
    constexpr int D = TypeParam::value;
    const Coded<D> octree;
    std::mt19937_64 random(8);
    int refused = 0;
    for (int round = 0; round < 120; ++round) {
        StoredOctree<D> forged(2);
        forged.host->restore(*octree.host);
        forged.header = octree.header;
        auto page = std::next(forged.host->pages.begin(),
                              static_cast<long>(random() % forged.host->pages.size()));
        for (std::uint64_t n = 1 + random() % 3; n > 0; --n)
            page->second.bytes()[random() % (round % 2 ? page->second.size : 60)] ^=
                static_cast<unsigned char>(1u << random() % 8);
        if (round % 4 != 0) seal_page(page->second.bytes(), page->second.size);
        try {
            const Host h = forged.host->host();
            OctreeReader<D> reader(h, forged.header, 1);
            const std::uint64_t begin = page->first.code;
            for (int i = 0; i < 20; ++i)
                reader.find(
                    std::min(begin + random() % (domain_cells<D> >> 6), domain_cells<D> - 1));
            forged.balance(D);
        } catch (const Error &error) {
            ASSERT_EQ(error.kind, ABACUS_ERROR_CORRUPTED) << error.what();
            EXPECT_STREQ(error.what(), "octree is corrupted");
            ++refused;
        }
    }
    EXPECT_GT(refused, 60);
}

TYPED_TEST(OctreePages, are_checked_behind_a_full_list_of_faults) {
    constexpr int D = TypeParam::value;
    const Coded<D> octree;
    StoredOctree<D> forged(2);
    forged.host->restore(*octree.host);
    forged.header = octree.header;
    ASSERT_GT(forged.host->pages.size(), 2u);
    for (auto &[key, page] : forged.host->pages) page.bytes()[page.size / 2] ^= 1;
    const Host h = forged.host->host();
    OctreeCheck<D> check(h, forged.header, 1);
    abacus_fault fault;
    int faults = 0;
    while (check.next(fault)) ++faults;
    EXPECT_EQ(faults, 1);
}

TYPED_TEST(OctreePages, survive_failures_of_the_host) {
    constexpr int D = TypeParam::value;
    const Coded<D> octree;
    for (std::uint64_t n = 1;; n += 1 + n / 4) {
        StoredOctree<D> failing(2);
        failing.host->restore(*octree.host);
        failing.header = octree.header;
        failing.host->fail_at(n);
        bool failed = false;
        try {
            failing.balance(D, 1);
            const Host h = failing.host->host();
            OctreeEdit<D> edit(h, failing.header, 1, 1);
            for (int i = 0; i < 50; ++i)
                edit.merge_at(
                    failing.place(
                        octree.model.find(static_cast<std::uint64_t>(i) * (domain_cells<D> / 50))
                            .code),
                    3);
            edit.merge(failing.header);
        } catch (const HostFailure &) {
            failed = true;
        }
        ASSERT_THAT(failing.host->violations, testing::IsEmpty());
        if (!failed) {
            EXPECT_GT(n, 20u);
            break;
        }
    }
}

} // namespace
} // namespace abacus::test
