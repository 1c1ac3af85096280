// Damaged vertex pages.
#include "fuzz/fuzz_mesh.hpp"

using namespace abacus::fuzz;

extern "C" int LLVMFuzzerInitialize(int *argc, char ***argv) {
    auto seeds = page_seeds(sound_mesh(2).host.staged_pages, {2});
    for (auto &seed : page_seeds(sound_mesh(3).host.staged_pages, {3})) seeds.push_back(seed);
    write_seeds(*argc, *argv, seeds);
    return 0;
}

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t *data, std::size_t size) {
    Bytes input(data, size);
    const int dimension = input.next<std::uint8_t>() % 2 == 0 ? 2 : 3;
    for (const bool alone : {false, true}) // beside a mesh, and as all there is
        with_copy(dimension, 1 << 20, [&](Mesh &mesh) {
            Bytes again = input;
            damage(mesh.host.staged_pages, again);
            if (alone) {
                mesh.host.pages.clear();
                mesh.header.vertices = mesh.header.simplices = mesh.header.ghosts = 0;
            }
            mesh.vertex_scan();
            mesh.check();
            mesh.build();
            mesh.check();
            require(mesh.host.bytes == 0, "memory is not given back");
        });
    return 0;
}
