// Damaged pages of attributes that are apart. Except in tests of checksums, pages are sealed again.
#include "fuzz/fuzz_mesh.hpp"

using namespace abacus::fuzz;

extern "C" int LLVMFuzzerInitialize(int *argc, char ***argv) {
    auto seeds = page_seeds(sound_mesh(2, Carried::apart).host.attribute_pages, {2, 0});
    for (auto &seed : page_seeds(sound_mesh(3, Carried::apart).host.attribute_pages, {3, 1}))
        seeds.push_back(seed);
    write_seeds(*argc, *argv, seeds);
    return 0;
}

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t *data, std::size_t size) {
    Bytes input(data, size);
    const int dimension = input.next<std::uint8_t>() % 2 == 0 ? 2 : 3;
    const bool sealed = input.next<std::uint8_t>() % 4 != 0;
    with_copy(
        dimension, 1 << 20,
        [&](Mesh &mesh) {
            damage(mesh.host.attribute_pages, input);
            if (sealed) seal(mesh.host.attribute_pages);
            mesh.vertex_scan();
            mesh.check();
            mesh.draw();
            mesh.build();
            mesh.check();
            mesh.remove(80, 1);
            mesh.check();
            require(mesh.host.bytes == 0, "memory is not given back");
        },
        Carried::apart);
    return 0;
}
