// From shapes to pixels: the exact share of every pixel that a polygon covers,
// and antialiased lines.
//
// Exact coverage is what makes huge meshes come out right. A triangle of a millionth of
// a pixel adds a millionth of its colour, whether or not it holds any sample point.
// Neighbours share the pixels along their common edge without seam or overlap, since
// their shares sum to one. The sum does not depend on the order of drawing. So no mesh
// is too fine, and there is nothing to sort.
//
// A row of pixels is covered by accumulating signed areas. Every edge leaves, in
// each pixel it passes, the change of coverage that it causes there and in the
// pixel to the right; a running sum along the row turns the changes into
// coverage. Descending edges count positive, ascending ones negative, hence the
// inside ends up at +1 or -1 and the outside at 0. The cost is that of the
// pixels on the outline plus one addition for each pixel inside.
#pragma once

#include "draw/frame.hpp"
#include "host/arena.hpp"

#include <algorithm>
#include <cmath>

namespace abacus {

/// Changes of coverage along one row of pixels.
class CoverageRow {
public:
    CoverageRow(const Host &host, std::int32_t width);

    /// An edge passes from x = `from` to x = `to` while descending by `drop`
    /// (negative: ascending) within this row.
    void edge(double from, double to, double drop);

    /// Calls sink(x, coverage) for all covered pixels and clears the row.
    template <class Sink> void sweep(Sink &&sink) {
        double sum = 0;
        const std::int32_t end = std::min(last_ + 1, width_);
        for (std::int32_t x = first_; x < end; ++x) {
            sum += change_[x];
            change_[x] = 0;
            const double coverage = std::fabs(sum);
            if (coverage > 1e-9) sink(x, std::min(coverage, 1.0)); // less is rounding
        }
        for (std::int32_t x = end; x <= last_; ++x) change_[x] = 0;
        first_ = width_;
        last_ = -1;
    }

private:
    void inner_edge(double left, double right, double drop);

    std::int32_t width_;
    std::int32_t first_, last_; // range of changes
    Arena<double> change_;
};

class Raster {
public:
    Raster(const Host &host, std::int32_t width, std::int32_t height)
        : host_(&host), width_(width), height_(height), row_(host, width) {}

    /// Calls sink(x, y, coverage) for every pixel that the patch, in pixels, covers.
    template <class Sink> void fill(const Patch &patch, Sink &&sink);

    /// Calls sink(x, y, coverage) along a line of this width, at most about one pixel.
    template <class Sink>
    void line(const double (&from)[2], const double (&to)[2], double width, Sink &&sink) const;

private:
    struct Edge {
        double x, y, slope;  // upper end; change of x per row
        double bottom, turn; // lower end; +1 descending, -1 ascending
        double left, right;  // bounds of x, against rounding
    };

    /// Cuts the line off a little outside of the picture; false if nothing is left.
    bool clip(double (&from)[2], double (&to)[2]) const;

    const Host *host_;
    std::int32_t width_, height_;
    CoverageRow row_;
};

template <class Sink> void Raster::fill(const Patch &patch, Sink &&sink) {
    const auto &p = patch.corner;
    Edge edges[Patch::most];
    int count = 0;
    double top = height_, bottom = 0;
    for (int i = 0, j = patch.corners - 1; i < patch.corners; j = i++) {
        const bool down = p[j][1] < p[i][1];
        const double *upper = down ? p[j] : p[i];
        const double *lower = down ? p[i] : p[j];
        const double drop = lower[1] - upper[1];
        if (drop < 1e-12) continue; // level: no area to the right of it
        edges[count++] = {upper[0],
                          upper[1],
                          (lower[0] - upper[0]) / drop,
                          lower[1],
                          down ? 1.0 : -1.0,
                          std::min(upper[0], lower[0]),
                          std::max(upper[0], lower[0])};
        top = std::min(top, upper[1]);
        bottom = std::max(bottom, lower[1]);
    }
    const auto first = static_cast<std::int32_t>(std::max(top, 0.0));
    const auto end = static_cast<std::int32_t>(std::ceil(std::min<double>(bottom, height_)));
    for (std::int32_t y = first; y < end; ++y) {
        host_->poll();
        for (int i = 0; i < count; ++i) {
            const Edge &e = edges[i];
            const double from = std::max<double>(y, e.y);
            const double to = std::min<double>(y + 1, e.bottom);
            if (!(from < to)) continue;
            row_.edge(std::clamp(e.x + (from - e.y) * e.slope, e.left, e.right),
                      std::clamp(e.x + (to - e.y) * e.slope, e.left, e.right),
                      (to - from) * e.turn);
        }
        row_.sweep([&](std::int32_t x, double coverage) { sink(x, y, coverage); });
    }
}

template <class Sink>
void Raster::line(const double (&from)[2], const double (&to)[2], double width, Sink &&sink) const {
    double a[2] = {from[0], from[1]};
    double b[2] = {to[0], to[1]};
    if (!clip(a, b)) return;
    // Step along the longer axis u; at each step the line is an interval of the other, v.
    const int u = std::fabs(b[0] - a[0]) >= std::fabs(b[1] - a[1]) ? 0 : 1;
    const int v = 1 - u;
    if (a[u] > b[u]) std::swap(a, b);
    const double length = b[u] - a[u];
    if (!(length > 0)) return;
    const double slope = (b[v] - a[v]) / length;
    const double thickness = width * std::sqrt(1 + slope * slope);
    // A line thinner than a pixel is drawn fainter, not narrower: no steps show.
    const double spread = std::max(thickness, 1.0);
    const double strength = thickness / spread;
    const std::int32_t end_u = u == 0 ? width_ : height_;
    const std::int32_t end_v = u == 0 ? height_ : width_;
    for (auto i = static_cast<std::int32_t>(std::max(a[u], 0.0)); i < end_u && i < b[u]; ++i) {
        const double left = std::max<double>(i, a[u]);
        const double right = std::min<double>(i + 1, b[u]);
        const double middle = a[v] + ((left + right) * 0.5 - a[u]) * slope;
        const double low = std::max(middle - spread * 0.5, 0.0);
        const double high = std::min<double>(middle + spread * 0.5, end_v);
        for (auto j = static_cast<std::int32_t>(low); j < high; ++j) {
            const double share = std::min<double>(high, j + 1) - std::max<double>(low, j);
            const double coverage = share * (right - left) * strength;
            if (u == 0)
                sink(i, j, coverage);
            else
                sink(j, i, coverage);
        }
    }
}

} // namespace abacus
