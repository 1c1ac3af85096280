// Damaged pages of repeated points.
#include "fuzz/fuzz_mesh.hpp"

using namespace abacus::fuzz;

extern "C" int LLVMFuzzerInitialize(int *argc, char ***argv) {
    std::vector<std::vector<std::uint8_t>> seeds;
    for (const std::uint8_t choice : {2, 3, 2 | many, 3 | many})
        for (auto &seed :
             page_seeds(sound_mesh(dimension_of(choice), carried_by(choice)).host.repeated_pages,
                        {choice}))
            seeds.push_back(seed);
    write_seeds(*argc, *argv, seeds);
    return 0;
}

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t *data, std::size_t size) {
    Bytes input(data, size);
    const auto choice = input.next<std::uint8_t>();
    const auto act = [&](Mesh &mesh) {
        damage(mesh.host.repeated_pages, input);
        mesh.vertex_scan();
        mesh.check();
        mesh.build(); // repeats points again
        mesh.check();
        mesh.remove(80, 1); // the repeated ones
        mesh.check();
        require(mesh.host.bytes == 0, "memory is not given back");
    };
    with_copy(dimension_of(choice), 1 << 20, act, carried_by(choice));
    return 0;
}
