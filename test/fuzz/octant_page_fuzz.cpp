// Damaged octant pages: an octree is read, asked, checked, drawn, changed and extracted, whatever
// its pages say.
#include "fuzz/fuzz_mesh.hpp"
#include "octree/octree_check.hpp"
#include "octree/octree_interpolation.hpp"
#include "octree/octree_nearest.hpp"
#include "octree/octree_portrait.hpp"
#include "octree/octree_scan.hpp"
#include "octree/octree_simplices.hpp"
#include "support/octree_model.hpp"

using namespace abacus;
using namespace abacus::fuzz;

namespace {

constexpr int attributes = 5;

template <int D> using Octree = test::StoredOctree<D>;

/// Five attributes make small pages. Some leaves are merged across their borders.
template <int D> const Octree<D> &sound_octree() {
    static const Octree<D> sound = [] {
        Octree<D> octree(attributes);
        std::mt19937_64 random(1);
        octree.header.facts.form.levels = D == 2 ? 9 : 6;
        octree.split_to(test::random_cells<D>(random, 150, D == 2 ? 9 : 6));
        const Host host = octree.host->host();
        OctreeEdit<D> edit(host, octree.header, octree.memory, octree.memory);
        for (const Octant<D> &leaf : octree.list()) {
            double values[attributes];
            for (double &value : values) value = static_cast<double>(random()) / 3;
            edit.set_at(leaf.code, values);
        }
        edit.set(octree.header);
        octree.merge({Octant<D>{}.child(1), Octant<D>{}.child(2).child(0)}, 1);
        fuzz::require(octree.host->pages.size() >= 4, "the sound octree has few pages");
        OctreeCheck<D> check(host, octree.header, 1);
        abacus_fault fault;
        fuzz::require(!check.next(fault), "the sound octree is not sound");
        return octree;
    }();
    return sound;
}

/// Whatever the pages say, an act ends well, or with an error about stored bytes.
template <class Act> void attempt(MemoryHost &host, Act act) {
    try {
        act();
        fuzz::require(host.violations.empty(), "the host was used wrongly");
        fuzz::require(host.spools.empty(), "a spool is not closed");
    } catch (const Error &error) {
        fuzz::require(error.kind == ABACUS_ERROR_CORRUPTED || error.kind == ABACUS_ERROR_STATE ||
                          error.kind == ABACUS_ERROR_LIMIT,
                      error.what());
        fuzz::require(host.violations.empty(), "the host was used wrongly");
    } catch (const HostFailure &) {
        // If pages overlap, a database refuses a second one under the same key.
        fuzz::require(host.violations.size() == 1 &&
                          host.violations[0] == "a second page is put under one key",
                      "a host error without a cause");
    }
    host.violations.clear();
    host.recover();
    fuzz::require(host.bytes == 0, "memory is not given back");
}

template <int D> void ask_places(Octree<D> &octree, std::size_t cache_bytes) {
    MemoryHost &host = *octree.host;
    const Host h = host.host();
    attempt(host, [&] {
        Point<D> center;
        center.fill(0.4);
        OctreeScan<D> scan(h, octree.header, Ball<D>{center, 0.25}, cache_bytes);
        Octant<D> leaf;
        for (const double *values; scan.next(leaf, values);) {
        }
    });
    for (const double at : {0.1, 0.5, 1.5})
        attempt(host, [&] {
            OctreeReader<D> reader(h, octree.header, cache_bytes);
            Point<D> place;
            place.fill(at);
            std::uint64_t last = 0;
            OctreeNearest<D>(reader).find(place, 20, [&](std::uint64_t rank, Handle, double) {
                fuzz::require(rank == ++last, "ranks do not count");
            });
        });
    for (int i = 0; i < 8; ++i)
        attempt(host, [&] {
            OctreeReader<D> reader(h, octree.header, cache_bytes);
            const std::uint32_t wanted[] = {4, 0};
            OctreeInterpolation<D> between(reader, wanted, 2);
            Point<D> place;
            for (int axis = 0; axis < D; ++axis) place[axis] = 0.13 * i + 0.01 * axis;
            double values[2];
            fuzz::require(between.values(place, values), "a place in the domain has no leaf");
        });
}

/// A quadtree as a map, an octree cut by a plane.
template <int D> void draw(Octree<D> &octree) {
    const Host h = octree.host->host();
    abacus_drawing drawing{};
    drawing.width = 32;
    drawing.height = 32;
    drawing.attribute = 1;
    if constexpr (D == 2) {
        draw_octree(h, octree.header, drawing);
    } else {
        const abacus_section section{{0.3, 0.4, 0.5}, {1, 2, 3}, 1};
        draw_octree_section(h, octree.header, section, drawing);
    }
}

template <int D> void read_everything(Octree<D> &octree, std::size_t cache_bytes) {
    MemoryHost &host = *octree.host;
    const Host h = host.host();
    attempt(host, [&] {
        OctreeReader<D> reader(h, octree.header, cache_bytes);
        for (std::uint64_t i = 0; i < 40; ++i) reader.find(domain_cells<D> / 40 * i + 12345);
    });
    for (std::uint64_t i = 0; i < 4; ++i)
        attempt(host, [&] {
            OctreeReader<D> reader(h, octree.header, cache_bytes);
            int found = 0;
            reader.neighbours(domain_cells<D> / 4 * i + 5, [&](int, int, Handle) { ++found; });
        });
    attempt(host, [&] {
        Point<D> lower, upper;
        lower.fill(0.2);
        upper.fill(0.6);
        OctreeScan<D> scan(h, octree.header, Box<D>(lower, upper), cache_bytes);
        Octant<D> leaf;
        for (const double *values; scan.next(leaf, values);) {
        }
    });
    attempt(host, [&] { octree.list(); });
    attempt(host, [&] {
        OctreeCheck<D> check(h, octree.header, 20);
        for (abacus_fault fault; check.next(fault);) {
        }
    });
    attempt(host, [&] {
        OctreeNodes<D> nodes(h, octree.header, octree.memory);
        for (typename OctreeNodes<D>::Node node; nodes.next(node);) {
        }
    });
    attempt(host, [&] {
        OctreeElements<D> elements(h, octree.header, octree.memory);
        for (std::array<std::uint64_t, Octant<D>::children> corners; elements.next(corners);) {
        }
    });
    attempt(host, [&] {
        OctreeSimplices<D> simplices(h, octree.header, octree.memory);
        std::uint64_t element;
        for (std::array<std::uint64_t, D + 1> nodes; simplices.next(element, nodes);) {
        }
    });
    ask_places(octree, cache_bytes);
    attempt(host, [&] { draw(octree); });
}

/// Each change works on the pages that the one before has left, with their header.
template <int D> void change_everything(Octree<D> &octree, std::size_t cache_bytes) {
    MemoryHost &host = *octree.host;
    const Host h = host.host();
    attempt(host, [&] { octree.split_to({{domain_cells<D> / 3, 6}}); });
    attempt(host, [&] {
        OctreeEdit<D> edit(h, octree.header, 1, cache_bytes);
        const double values[attributes] = {1, 2, 3, 4, 5};
        for (std::uint64_t i = 0; i < 20; ++i) edit.set_at(domain_cells<D> / 20 * i, values);
        edit.set(octree.header);
    });
    attempt(host, [&] {
        octree.merge({Octant<D>{}.child(0).child(1), Octant<D>{}.child(3)}, cache_bytes);
    });
    attempt(host, [&] { octree.balance(D); });
    attempt(host, [&] {
        octree.split_to_points({1, 2, 3, domain_cells<D> / 2, domain_cells<D> / 2 + 1}, 1);
    });
    attempt(host, [&] { octree.merge({{}}, cache_bytes); });
}

template <int D> void use_damaged(std::uint8_t kind, Bytes &input) {
    Octree<D> octree(attributes);
    octree.header = sound_octree<D>().header;
    octree.host->restore(*sound_octree<D>().host);
    damage(octree.host->pages, input);
    if (!(kind & 4)) seal(octree.host->pages);
    const std::size_t cache_bytes = kind & 1 ? 1 : 1 << 20;
    read_everything(octree, cache_bytes);
    change_everything(octree, cache_bytes);
    read_everything(octree, cache_bytes);
}

} // namespace

extern "C" int LLVMFuzzerInitialize(int *argc, char ***argv) {
    auto seeds = page_seeds(sound_octree<2>().host->pages, {0});
    for (auto &seed : page_seeds(sound_octree<3>().host->pages, {2})) seeds.push_back(seed);
    write_seeds(*argc, *argv, seeds);
    return 0;
}

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t *data, std::size_t size) {
    Bytes input(data, size);
    const auto kind = input.next<std::uint8_t>();
    kind & 2 ? use_damaged<3>(kind, input) : use_damaged<2>(kind, input);
    return 0;
}
