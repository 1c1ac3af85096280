// Drawing behind the C interface.
#include "query/portrait.hpp"

#include "capi/guard.hpp"

abacus_status abacus_draw(const abacus_host *host, const abacus_header *header,
                          const abacus_drawing *drawing, unsigned char **png, size_t *size,
                          abacus_error *error) {
    return abacus::guard(error, [&] {
        if (header->dimension != 2)
            throw abacus::Error(ABACUS_ERROR_ARGUMENT, "only a mesh of dimension 2 can be drawn");
        const abacus::Host wrapped(*host);
        abacus::Png picture = abacus::draw_mesh(wrapped, *header, *drawing);
        *size = picture.size();
        *png = picture.release();
        return ABACUS_OK;
    });
}
