#include "delaunay/lines_over.hpp"

#include <algorithm>

namespace abacus {

template <class Visit>
bool LinesOver::from(const Point<2> &p, const Point<2> &through, bool beyond, Visit visit) {
    for (const abacus_segment_end &segment : lines_.at(p)) {
        const Point<2> other = other_end(segment);
        if (is_on_ray(p, through, other) && (!beyond || is_behind(p, through, other)) &&
            !visit(segment))
            return false;
    }
    return true;
}

template <class Visit> void LinesOver::each(const Point<2> &a, const Point<2> &b, Visit visit) {
    if (!from(a, b, false, visit) || !from(b, a, false, visit)) return;
    Point<2> at = a;
    for (std::optional<Point<2>> w; (w = next(b, at)); at = *w)
        if (!from(*w, a, true, visit)) return;
}

std::optional<std::int64_t> LinesOver::find(const Point<2> &a, const Point<2> &b) {
    std::optional<std::int64_t> line;
    each(a, b, [&](const abacus_segment_end &segment) {
        line = std::min(line.value_or(segment.line), segment.line);
        return true;
    });
    return line;
}

Fixed LinesOver::kind(const Point<2> &a, const Point<2> &b) {
    Fixed kind = Fixed::no;
    each(a, b, [&](const abacus_segment_end &segment) {
        kind = std::max(kind, segment.is_soft != 0 ? Fixed::soft : Fixed::hard);
        return kind != Fixed::hard;
    });
    return kind;
}

std::optional<Point<2>> LinesOver::next(const Point<2> &behind, const Point<2> &at) {
    const Link corner = vertex_at(mesh_, at);
    if (corner == unset) return {};
    return fixed_straight_on(mesh_.cache(), corner, behind);
}

} // namespace abacus
