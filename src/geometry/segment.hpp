// Whether a segment meets a box or a ball. Exact, as geometry/simplex_box.hpp and
// geometry/ball.hpp are.
#pragma once

#include "geometry/ball.hpp"
#include "geometry/simplex_box.hpp"

namespace abacus {

/// Between two different points.
template <int D> bool meets(const Point<D> &a, const Point<D> &b, const Box<D> &box) {
    Box<D> around;
    around.extend(a);
    around.extend(b);
    if (!around.meets(box)) return false;
    if (box.contains(a) || box.contains(b)) return true;
    if constexpr (D == 2) {
        const Point<2> ends[2] = {a, b};
        return !is_kept_apart(ends, 2, box, true);
    } else {
        for (int k = 0; k < 3; ++k) { // the axis that is left out
            const auto flat = [k](const Point<3> &p) {
                return Point<2>{p[(k + 1) % 3], p[(k + 2) % 3]};
            };
            const Point<2> ends[2] = {flat(a), flat(b)};
            if (is_kept_apart(ends, 2, {flat(box.lower), flat(box.upper)}, true)) return false;
        }
        return true;
    }
}

template <int D> bool meets(const Point<D> &a, const Point<D> &b, const Ball<D> &ball) {
    return ball.contains(a) || ball.contains(b) || exact::meets_edge<D>(a, b, ball);
}

} // namespace abacus
