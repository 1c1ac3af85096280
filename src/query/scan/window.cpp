#include "query/scan/window.hpp"

#include <algorithm>
#include <limits>

namespace abacus {

template <int D> Box<D> BallRegion<D>::box_around(const Ball<D> &ball) {
    Box<D> box;
    for (int i = 0; i < D; ++i) {
        box.lower[i] = ball.center[i] - ball.radius;
        box.upper[i] = ball.center[i] + ball.radius;
    }
    return box;
}

// Compares the nearest point of the box, whose coordinates are not rounded.
template <int D> bool BallRegion<D>::may_meet(const Box<D> &box) const {
    return ball_.contains(box.nearest(ball_.center));
}

template <int D> bool BallRegion<D>::may_meet(const Point<D> *const *points, int n) const {
    Box<D> around;
    for (int i = 0; i < n; ++i) around.extend(*points[i]);
    return may_meet(around);
}

// The thinnest slab has the fewest pages.
template <int D> Box<D> slab_around(const Box<D> &box) {
    int thinnest = 0;
    for (int i = 1; i < D; ++i)
        if (box.upper[i] * 0.5 - box.lower[i] * 0.5 <
            box.upper[thinnest] * 0.5 - box.lower[thinnest] * 0.5)
            thinnest = i;
    Box<D> slab;
    for (int i = 0; i < D; ++i) {
        slab.lower[i] = i == thinnest ? box.lower[i] : -std::numeric_limits<double>::max();
        slab.upper[i] = i == thinnest ? box.upper[i] : std::numeric_limits<double>::max();
    }
    return slab;
}

template <int D> Window<D>::Window(const abacus_window &window) {
    const auto point = [](const double *from) {
        Point<D> p;
        for (int i = 0; i < D; ++i) p[i] = from[i] + 0.0; // -0.0 is +0.0
        return p;
    };
    if (window.kind == ABACUS_BOX_WINDOW)
        box_region_.emplace(box_.emplace(point(window.lower), point(window.upper)));
    else if (window.kind == ABACUS_BALL_WINDOW)
        ball_region_.emplace(ball_.emplace(Ball<D>{point(window.center), window.radius}));
    else if (window.kind == ABACUS_BOUNDS_WINDOW)
        slab_region_.emplace(
            slab_around<D>(box_.emplace(point(window.lower), point(window.upper))));
}

template class BallRegion<2>;
template class BallRegion<3>;
template class Window<2>;
template class Window<3>;

} // namespace abacus
