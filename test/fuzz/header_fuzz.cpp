// Damaged header rows: decoded or refused, and what is decoded describes a mesh that it
// need not fit.
#include "fuzz/fuzz_mesh.hpp"

#include <abacus/header.h>

using namespace abacus::fuzz;

namespace {

std::vector<std::uint8_t> encode(const abacus_header &header) {
    std::vector<std::uint8_t> bytes(ABACUS_PAGE_BYTES);
    bytes.resize(abacus_header_encode(&header, bytes.data()));
    return bytes;
}

} // namespace

extern "C" int LLVMFuzzerInitialize(int *argc, char ***argv) {
    abacus_header empty{};
    empty.dimension = 3;
    abacus_header with_srid = sound_mesh(2).header;
    with_srid.srid = 4326;
    write_seeds(*argc, *argv,
                {encode(sound_mesh(2).header), encode(sound_mesh(3).header), encode(empty),
                 encode(with_srid)});
    return 0;
}

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t *data, std::size_t size) {
    abacus_header header;
    abacus_error error{};
    if (abacus_header_decode(data, size, &header, &error) != ABACUS_OK) {
        require(error.kind == ABACUS_ERROR_CORRUPTED || error.kind == ABACUS_ERROR_STATE,
                "a header is refused for another reason");
        return 0;
    }
    const std::vector<std::uint8_t> bytes = encode(header);
    abacus_header again;
    require(bytes.size() == size, "a header changes its size");
    require(abacus_header_decode(bytes.data(), bytes.size(), &again, &error) == ABACUS_OK &&
                std::memcmp(&header, &again, sizeof header) == 0,
            "a header changes on its way");
    // Over the pages of either mesh: of its own dimension, and of another.
    for (const int dimension : {2, 3})
        with_copy(dimension, 1 << 20, [&](Mesh &mesh) {
            mesh.header = header;
            mesh.do_everything();
        });
    return 0;
}
