#include "query/portrait.hpp"

#include "query/page_scan.hpp"

#include <cmath>

namespace abacus {

namespace {

/// Shows every finite triangle to `picture`, an Extent or a Canvas.
template <class Sink>
void stream(const Host &host, const abacus_header &header, const abacus_drawing &drawing,
            Sink &picture) {
    const Point<2> lower{drawing.lower[0], drawing.lower[1]};
    const Point<2> upper{drawing.upper[0], drawing.upper[1]};
    const bool whole = shows_whole_mesh(drawing);
    PageScan<2> scan(host, header.attributes);
    while (scan.advance()) {
        const PageView<2> &page = scan.page();
        if (!whole && !page.meets(lower, upper)) continue;
        for (int s = 0; s < page.simplices(); ++s) {
            if (page.is_ghost(s)) continue;
            TriangleCorners corner;
            TriangleValues value;
            for (int i = 0; i < 3; ++i) {
                const int v = page.corner(s, i);
                const Point<2> p = page.point(v);
                corner[i][0] = p[0];
                corner[i][1] = p[1];
                value[i] = drawing.attribute >= 0 ? page.attribute(v, drawing.attribute) : NAN;
            }
            picture.triangle(corner, value);
        }
    }
}

} // namespace

Png draw_mesh(const Host &host, const abacus_header &header, const abacus_drawing &drawing) {
    if (drawing.attribute >= static_cast<std::int32_t>(header.attributes))
        throw Error(ABACUS_ERROR_ARGUMENT, "the mesh has no such attribute");
    Extent extent(drawing);
    if (Extent::is_needed(drawing)) stream(host, header, drawing, extent);
    const abacus_drawing whole = extent.drawing();
    Canvas canvas(host, whole, extent.low(), extent.high());
    stream(host, header, whole, canvas);
    return canvas.png();
}

} // namespace abacus
