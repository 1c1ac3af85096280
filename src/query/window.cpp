#include "query/window.hpp"

#include <algorithm>

namespace abacus {

template <int D> Box<D> BallRegion<D>::box_around(const Ball<D> &ball) {
    Box<D> box;
    for (int i = 0; i < D; ++i) {
        box.lower[i] = ball.center[i] - ball.radius;
        box.upper[i] = ball.center[i] + ball.radius;
    }
    return box;
}

// The nearest point of the box is compared, whose coordinates are not rounded.
template <int D> bool BallRegion<D>::may_meet(const Box<D> &box) const {
    Point<D> nearest;
    for (int i = 0; i < D; ++i)
        nearest[i] = std::clamp(ball_.center[i], box.lower[i], box.upper[i]);
    return ball_.contains(nearest);
}

template <int D> bool BallRegion<D>::may_meet(const Point<D> *const *points, int n) const {
    Box<D> around;
    for (int i = 0; i < n; ++i) around.extend(*points[i]);
    return may_meet(around);
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
}

template class BallRegion<2>;
template class BallRegion<3>;
template class Window<2>;
template class Window<3>;

} // namespace abacus
