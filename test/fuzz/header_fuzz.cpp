// Damaged header rows: they are decoded or refused, and the pages need not fit the mesh that a
// decoded one describes.
#include "fuzz/fuzz_mesh.hpp"

#include <abacus/mesh_header.h>

#include <cstddef>

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
    empty.facts.form.dimension = 3;
    abacus_header with_srid = sound_mesh(2).header;
    with_srid.facts.form.srid = 4326;
    abacus_header wide = sound_mesh(2).header;
    wide.facts.columns.attributes = ABACUS_MAX_ATTRIBUTES;
    wide.facts.columns.apart = 1;
    for (auto &name : wide.names) std::snprintf(name, sizeof name, "a");
    std::vector<std::uint8_t> names(ABACUS_PAGE_BYTES);
    names.resize(abacus_header_encode_names(&wide, 0, names.data()));
    write_seeds(*argc, *argv,
                {encode(sound_mesh(2).header), encode(sound_mesh(3).header), encode(empty),
                 encode(with_srid), encode(wide), names});
    return 0;
}

namespace {

/// Damage, or a format or type of another version.
bool is_refusal(const abacus_error &error) {
    return error.kind == ABACUS_ERROR_CORRUPTED || error.kind == ABACUS_ERROR_STATE;
}

/// Also reads the bytes as a row of names of a mesh with many attributes.
void read_names(const std::uint8_t *data, std::size_t size) {
    abacus_header header{};
    header.facts.form.dimension = 2;
    header.facts.columns.attributes = static_cast<std::uint32_t>(std::min<std::size_t>(
        size / ABACUS_NAME_BYTES + ABACUS_MAX_PAGE_ATTRIBUTES, ABACUS_MAX_ATTRIBUTES));
    header.facts.columns.apart = 1;
    for (std::uint32_t row = 0; row < abacus_header_name_rows(&header.facts.columns); ++row) {
        abacus_error error{};
        if (abacus_header_decode_names(data, size, row, &header, &error) != ABACUS_OK) {
            require(is_refusal(error), "names are refused for another reason");
            continue;
        }
        std::vector<std::uint8_t> bytes(ABACUS_PAGE_BYTES);
        bytes.resize(abacus_header_encode_names(&header, row, bytes.data()));
        require(bytes.size() == size, "a row of names changes its size");
    }
}

} // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t *data, std::size_t size) {
    read_names(data, size);
    abacus_header header{};
    abacus_error error{};
    if (abacus_header_decode(data, size, &header, &error) != ABACUS_OK) {
        require(is_refusal(error), "a header is refused for another reason");
        return 0;
    }
    const std::vector<std::uint8_t> bytes = encode(header);
    abacus_header again{};
    // Older headers lack the last counters, which begin with the passes of threads.
    constexpr std::size_t last = sizeof(abacus_counters) - offsetof(abacus_counters, passes);
    require(bytes.size() == size || bytes.size() == size + last, "a header changes its size");
    require(abacus_header_decode(bytes.data(), bytes.size(), &again, &error) == ABACUS_OK &&
                std::memcmp(&header, &again, sizeof header) == 0,
            "a header changes on its way");
    // Over the pages of either mesh: with its own dimension, and with the other.
    for (const int dimension : {2, 3})
        with_copy(dimension, 1 << 20, [&](Mesh &mesh) {
            mesh.header = header;
            mesh.do_everything();
        });
    return 0;
}
