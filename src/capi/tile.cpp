// Tiles behind the C interface.
#include "tiles/picture_tile.hpp"
#include "tiles/terrain_tile.hpp"
#include "tiles/vector_tile.hpp"

#include "capi/guard.hpp"

namespace {

void require_plane(const abacus_facts &facts) {
    if (facts.form.dimension != 2)
        throw abacus::Error(ABACUS_ERROR_ARGUMENT, "the mesh has the wrong dimension");
}

abacus_status hand_over(abacus::Png bytes, bool is_blank, abacus_picture *picture) {
    picture->size = bytes.size();
    picture->png = bytes.release();
    picture->is_blank = is_blank;
    return ABACUS_OK;
}

} // namespace

abacus_status abacus_tile_picture(const abacus_host *host, const abacus_facts *facts,
                                  const abacus_tile *tile, const abacus_drawing *drawing,
                                  const abacus_tile_memory *memory, abacus_picture *picture,
                                  abacus_error *error) {
    return abacus::guard(error, [&] {
        require_plane(*facts);
        const abacus::Host wrapped(*host);
        abacus::Portrait portrait =
            abacus::draw_picture_tile(wrapped, *facts, *tile, *drawing, *memory);
        return hand_over(std::move(portrait.png), portrait.is_blank, picture);
    });
}

abacus_status abacus_tile_terrain(const abacus_host *host, const abacus_facts *facts,
                                  const abacus_tile *tile, const abacus_tile_terrain_kind *kind,
                                  const abacus_tile_memory *memory, abacus_picture *picture,
                                  abacus_error *error) {
    return abacus::guard(error, [&] {
        require_plane(*facts);
        const abacus::Host wrapped(*host);
        return hand_over(abacus::terrain_tile(wrapped, *facts, *tile, *kind, *memory), false,
                         picture);
    });
}

abacus_status abacus_tile_vector(const abacus_host *host, const abacus_facts *facts,
                                 const abacus_tile *tile, const abacus_tile_vector_kind *kind,
                                 const abacus_region_names *names, const abacus_tile_memory *memory,
                                 abacus_picture *picture, abacus_error *error) {
    return abacus::guard(error, [&] {
        require_plane(*facts);
        const abacus::Host wrapped(*host);
        abacus::Png bytes = abacus::vector_tile(wrapped, *facts, *tile, *kind, names, *memory);
        const bool is_blank = bytes.size() == 0;
        return hand_over(std::move(bytes), is_blank, picture);
    });
}
