// Drawing behind the C interface.
#include "octree/octree_portrait.hpp"
#include "query/pictures/portrait.hpp"
#include "query/pictures/ray_portrait.hpp"

#include "capi/guard.hpp"

#include <abacus/draw.h>

namespace {

void require_dimension(const abacus_facts &facts, unsigned dimension) {
    if (facts.form.dimension != dimension)
        throw abacus::Error(ABACUS_ERROR_ARGUMENT, "the mesh has the wrong dimension");
}

abacus_status hand_over(abacus::Portrait portrait, abacus_picture *picture) {
    picture->size = portrait.png.size();
    picture->png = portrait.png.release();
    picture->is_blank = portrait.is_blank;
    return ABACUS_OK;
}

} // namespace

abacus_status abacus_draw(const abacus_host *host, const abacus_facts *facts,
                          const abacus_drawing *drawing, abacus_picture *picture,
                          abacus_error *error) {
    return abacus::guard(error, [&] {
        require_dimension(*facts, 2);
        const abacus::Host wrapped(*host);
        const auto draw =
            facts->form.type == ABACUS_OCTREE ? abacus::draw_octree : abacus::draw_mesh;
        return hand_over(draw(wrapped, *facts, *drawing), picture);
    });
}

abacus_status abacus_draw_section(const abacus_host *host, const abacus_facts *facts,
                                  const abacus_section *section, const abacus_drawing *drawing,
                                  abacus_picture *picture, abacus_error *error) {
    return abacus::guard(error, [&] {
        require_dimension(*facts, 3);
        const abacus::Host wrapped(*host);
        const auto draw =
            facts->form.type == ABACUS_OCTREE ? abacus::draw_octree_section : abacus::draw_section;
        return hand_over(draw(wrapped, *facts, *section, *drawing), picture);
    });
}

abacus_status abacus_draw_volume(const abacus_host *host, const abacus_facts *facts,
                                 const abacus_camera *camera, const abacus_drawing *drawing,
                                 abacus_picture *picture, abacus_error *error) {
    return abacus::guard(error, [&] {
        require_dimension(*facts, 3);
        const abacus::Host wrapped(*host);
        return hand_over(abacus::draw_rays(wrapped, *facts, *camera, *drawing), picture);
    });
}
