// Tiles behind the C interface.
#include "tiles/fixed_layer.hpp"
#include "tiles/mesh_tile.hpp"
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
                                  uint64_t *beyond, abacus_error *error) {
    return abacus::guard(error, [&] {
        require_plane(*facts);
        const abacus::Host wrapped(*host);
        return hand_over(abacus::terrain_tile(wrapped, *facts, *tile, *kind, *memory, *beyond),
                         false, picture);
    });
}

abacus_status abacus_tile_mesh(const abacus_host *host, const abacus_facts *facts,
                               const abacus_tile *tile, const abacus_tile_mesh_kind *kind,
                               const abacus_tile_memory *memory, abacus_picture *picture,
                               abacus_error *error) {
    return abacus::guard(error, [&] {
        require_plane(*facts);
        const abacus::Host wrapped(*host);
        abacus::Png bytes = abacus::mesh_tile(wrapped, *facts, *tile, *kind, *memory);
        const bool is_blank = bytes.size() == 0;
        return hand_over(std::move(bytes), is_blank, picture);
    });
}

abacus_status abacus_tile_vector(const abacus_host *host, const abacus_facts *facts,
                                 const abacus_tile *tile, const abacus_tile_vector_kind *kind,
                                 const abacus_tile_words *words, const abacus_tile_memory *memory,
                                 abacus_picture *picture, int32_t *has_triangles,
                                 abacus_error *error) {
    return abacus::guard(error, [&] {
        require_plane(*facts);
        const abacus::Host wrapped(*host);
        abacus::VectorTile made =
            abacus::vector_tile(wrapped, *facts, *tile, *kind, *words, *memory);
        *has_triangles = made.has_triangles;
        const bool is_blank = made.bytes.size() == 0;
        return hand_over(std::move(made.bytes), is_blank, picture);
    });
}

abacus_status abacus_tile_window(const abacus_facts *facts, const abacus_tile *tile,
                                 double lower[2], double upper[2], abacus_error *error) {
    return abacus::guard(error, [&] {
        require_plane(*facts);
        const abacus::Box<2> box = abacus::TileWindow(*tile, *facts).in_mesh(abacus::vector_margin);
        std::copy_n(box.lower.begin(), 2, lower);
        std::copy_n(box.upper.begin(), 2, upper);
        return ABACUS_OK;
    });
}

abacus_status abacus_tile_fixed(const abacus_host *host, const abacus_facts *facts,
                                const abacus_tile *tile, const abacus_extent *extent,
                                const abacus_tile_edge *edges, uint64_t count,
                                abacus_picture *layer, abacus_error *error) {
    return abacus::guard(error, [&] {
        require_plane(*facts);
        const abacus::Host wrapped(*host);
        abacus::Png bytes = abacus::fixed_layer(wrapped, *facts, *tile, *extent,
                                                {edges, static_cast<std::size_t>(count)});
        const bool is_blank = bytes.size() == 0;
        return hand_over(std::move(bytes), is_blank, layer);
    });
}
