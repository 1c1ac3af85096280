// Damaged simplex pages.
#include "fuzz/fuzz_mesh.hpp"

using namespace abacus::fuzz;

extern "C" int LLVMFuzzerInitialize(int *argc, char ***argv) {
    write_seeds(*argc, *argv, page_seeds(sound_mesh().host.pages, {0}));
    return 0;
}

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t *data, std::size_t size) {
    Bytes input(data, size);
    const std::size_t cache_bytes = input.next<std::uint8_t>() % 2 ? 30 << 10 : 1 << 20;
    with_copy(cache_bytes, [&](Mesh &mesh) {
        damage(mesh.host.pages, input);
        mesh.do_everything();
    });
    return 0;
}
