#include "delaunay/lines_over.hpp"

namespace abacus {

std::optional<std::int64_t> LinesOver::find(const Point<2> &a, const Point<2> &b) {
    if (const auto line = from(a, b, false)) return line;
    if (const auto line = from(b, a, false)) return line;
    Point<2> at = a;
    for (std::optional<Point<2>> w; (w = next(b, at)); at = *w)
        if (const auto line = from(*w, a, true)) return line;
    return {};
}

std::optional<std::int64_t> LinesOver::from(const Point<2> &p, const Point<2> &through,
                                            bool beyond) {
    for (const abacus_segment_end &segment : lines_.at(p)) {
        const Point<2> other = other_end(segment);
        if (is_on_ray(p, through, other) && (!beyond || is_behind(p, through, other)))
            return segment.line;
    }
    return {};
}

std::optional<Point<2>> LinesOver::next(const Point<2> &behind, const Point<2> &at) {
    const Link corner = vertex_at(mesh_, at);
    if (corner == unset) return {};
    return fixed_straight_on(mesh_.cache(), corner, behind);
}

} // namespace abacus
