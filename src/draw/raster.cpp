#include "draw/raster.hpp"

namespace abacus {

CoverageRow::CoverageRow(const Host &host, std::int32_t width)
    : width_(width), first_(width), last_(-1), change_(host) {
    // An edge at the right border still changes the next two pixels.
    change_.resize(static_cast<std::size_t>(width) + 2);
    std::fill(change_.begin(), change_.end(), 0.0);
}

void CoverageRow::edge(double from, double to, double drop) {
    double left = std::min(from, to);
    double right = std::max(from, to);
    // The part left of the picture covers the whole row; the part right of it only keeps the row
    // open up to the border.
    if (right <= 0) {
        inner_edge(0, 0, drop);
        return;
    }
    if (left >= width_) {
        last_ = std::max(last_, width_ - 1);
        return;
    }
    if (left < 0 || right > width_) {
        const double drop_per_x = drop / (right - left);
        if (left < 0) {
            const double part = -left * drop_per_x;
            inner_edge(0, 0, part);
            drop -= part;
            left = 0;
        }
        if (right > width_) {
            drop -= (right - width_) * drop_per_x;
            right = width_;
            last_ = std::max(last_, width_ - 1);
        }
    }
    inner_edge(left, right, drop);
}

void CoverageRow::inner_edge(double left, double right, double drop) {
    const auto first = static_cast<std::int32_t>(left);
    const auto last = std::max(first, static_cast<std::int32_t>(std::ceil(right)) - 1);
    first_ = std::min(first_, first);
    last_ = std::max(last_, last + 1);
    if (first == last) {
        const double beyond = (left + right) * 0.5 - first;
        change_[first] += drop * (1 - beyond);
        change_[first + 1] += drop * beyond;
        return;
    }
    // The coverage of the pixel at x is the integral over it of the share of the
    // edge that lies left of a position: a parabola, a straight rise, a parabola.
    const double slope = drop / (right - left);
    double before = 0;
    for (std::int32_t x = first; x <= last; ++x) {
        const double start = std::max<double>(left, x);
        const double end = std::min<double>(right, x + 1);
        const double below = (start - left) * slope; // share passed before this pixel
        const double rise = (end - start) * slope;
        const double coverage =
            below * (x + 1 - start) + rise * (end - start) * 0.5 + rise * (x + 1 - end);
        change_[x] += coverage - before;
        before = coverage;
    }
    change_[last + 1] += drop - before;
}

bool Raster::clip(double (&from)[2], double (&to)[2]) const {
    // Within the margin, pixels at the border get the whole width of the line.
    constexpr double margin = 2;
    const double end[2] = {width_ + margin, height_ + margin};
    double enter = 0, leave = 1;
    for (int axis = 0; axis < 2; ++axis) {
        const double span = to[axis] - from[axis];
        const double near = -margin - from[axis];
        const double far = end[axis] - from[axis];
        if (span == 0) {
            if (near > 0 || far < 0) return false;
        } else {
            enter = std::max(enter, std::min(near / span, far / span));
            leave = std::min(leave, std::max(near / span, far / span));
        }
    }
    if (!(enter < leave)) return false;
    const double start[2] = {from[0], from[1]};
    for (int axis = 0; axis < 2; ++axis) {
        const double span = to[axis] - start[axis];
        if (leave < 1) to[axis] = std::clamp(start[axis] + span * leave, -margin, end[axis]);
        if (enter > 0) from[axis] = std::clamp(start[axis] + span * enter, -margin, end[axis]);
    }
    return true;
}

} // namespace abacus
