// Damaged pages of repeated points.
#include "fuzz/fuzz_mesh.hpp"

using namespace abacus::fuzz;

extern "C" int LLVMFuzzerInitialize(int *argc, char ***argv) {
    auto seeds = page_seeds(sound_mesh(2).host.repeated_pages, {2});
    for (auto &seed : page_seeds(sound_mesh(3).host.repeated_pages, {3})) seeds.push_back(seed);
    write_seeds(*argc, *argv, seeds);
    return 0;
}

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t *data, std::size_t size) {
    Bytes input(data, size);
    const int dimension = input.next<std::uint8_t>() % 2 == 0 ? 2 : 3;
    with_copy(dimension, 1 << 20, [&](Mesh &mesh) {
        damage(mesh.host.repeated_pages, input);
        mesh.vertex_scan();
        mesh.check();
        mesh.build(); // repeats points again
        mesh.check();
        mesh.remove(80, 1); // the repeated ones
        mesh.check();
        require(mesh.host.bytes == 0, "memory is not given back");
    });
    return 0;
}
