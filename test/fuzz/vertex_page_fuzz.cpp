// Damaged vertex pages.
#include "fuzz/fuzz_mesh.hpp"

using namespace abacus::fuzz;

extern "C" int LLVMFuzzerInitialize(int *argc, char ***argv) {
    std::vector<std::vector<std::uint8_t>> seeds;
    for (const std::uint8_t choice : {2, 3, 2 | many, 3 | many})
        for (auto &seed : page_seeds(
                 sound_mesh(dimension_of(choice), carried_by(choice)).host.staged_pages, {choice}))
            seeds.push_back(seed);
    write_seeds(*argc, *argv, seeds);
    return 0;
}

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t *data, std::size_t size) {
    Bytes input(data, size);
    const auto choice = input.next<std::uint8_t>();
    for (const bool alone : {false, true}) { // beside a mesh, and without one
        const auto act = [&](Mesh &mesh) {
            Bytes again = input;
            damage(mesh.host.staged_pages, again);
            if (alone) {
                mesh.host.pages.clear();
                mesh.header.facts.census.vertices = mesh.header.facts.census.simplices =
                    mesh.header.facts.census.ghosts = 0;
            }
            mesh.vertex_scan();
            mesh.check();
            mesh.build();
            mesh.check();
            require(mesh.host.bytes == 0, "memory is not given back");
        };
        with_copy(dimension_of(choice), 1 << 20, act, carried_by(choice));
    }
    return 0;
}
