// Damaged simplex pages.
#include "fuzz/fuzz_mesh.hpp"

using namespace abacus::fuzz;

extern "C" int LLVMFuzzerInitialize(int *argc, char ***argv) {
    auto seeds = page_seeds(sound_mesh(2).host.pages, {0});
    for (auto &seed : page_seeds(sound_mesh(3).host.pages, {2})) seeds.push_back(seed);
    write_seeds(*argc, *argv, seeds);
    return 0;
}

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t *data, std::size_t size) {
    Bytes input(data, size);
    const auto kind = input.next<std::uint8_t>();
    const std::size_t cache_bytes = kind & 1 ? 30 << 10 : 1 << 20;
    with_copy(kind & 2 ? 3 : 2, cache_bytes, [&](Mesh &mesh) {
        damage(mesh.host.pages, input);
        if (!(kind & 4)) seal(mesh.host.pages);
        mesh.do_everything();
    });
    return 0;
}
