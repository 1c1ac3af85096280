#include "draw/ray_canvas.hpp"

#include "draw/captions.hpp"
#include "geometry/tetrahedron_cut.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace abacus {

namespace {

/// The edges of a tetrahedron, and each facet as edges, turned so that they follow one another.
constexpr int ends[6][2] = {{0, 1}, {0, 2}, {0, 3}, {1, 2}, {1, 3}, {2, 3}};
struct Facet {
    int corner[3];
    int edge[3]; // opposite the corners
    int turn[3]; // -1: the edge runs from its second end to its first
    int out;     // 1: so turned, the facet is to their right as seen from outside
};
constexpr Facet facets[4] = {{{1, 2, 3}, {5, 4, 3}, {1, -1, 1}, 1},
                             {{0, 2, 3}, {5, 2, 1}, {1, -1, 1}, -1},
                             {{0, 1, 3}, {4, 2, 0}, {1, -1, 1}, 1},
                             {{0, 1, 2}, {3, 1, 0}, {1, -1, 1}, -1}};

/// The line through an edge, in places.
template <class Number> struct Line {
    Number x, y;   // its first end
    Number dx, dy; // from there to the second
    int tie;       // side of a point a little to the right of and below one on the line

    Line() = default;
    Line(const Sight &a, const Sight &b)
        : x(a.x), y(a.y), dx(static_cast<Number>(b.x) - x), dy(static_cast<Number>(b.y) - y),
          tie(dy != 0 ? (dy < 0 ? 1 : -1) : (dx > 0) - (dx < 0)) {}
    Number operator()(Number at_x, Number at_y) const { return dx * (at_y - y) - dy * (at_x - x); }
};

template <class Number> Number centre(std::int32_t pixel) {
    return static_cast<Number>(pixel) * Camera::steps + Camera::steps / 2;
}

std::int32_t first_pixel(std::int64_t place) {
    // Its centre is at or after the place.
    const std::int64_t from = place - Camera::steps / 2 + Camera::steps - 1;
    return static_cast<std::int32_t>(
        std::clamp<std::int64_t>(from >> 8, std::numeric_limits<std::int32_t>::min(),
                                 std::numeric_limits<std::int32_t>::max()));
}
static_assert(Camera::steps == 1 << 8);

/// Keeps the part of a ray between two depths; false if nothing is left.
template <class Depths, class Hit> bool cut_off(const Depths &depths, Hit &enters, Hit &leaves) {
    if (leaves.depth < depths.from || depths.to < enters.depth || depths.to < depths.from)
        return false;
    const Hit first = enters;
    const double way = leaves.depth - enters.depth;
    const double slope = way > 0 ? (leaves.value - enters.value) / way : 0;
    const auto at = [&](double depth) {
        return Hit{depth, first.value + slope * (depth - first.depth)};
    };
    if (enters.depth < depths.from) enters = at(depths.from);
    if (depths.to < leaves.depth) leaves = at(depths.to);
    return true;
}

// Up to here, places and the products of their differences fit into words.
constexpr std::int64_t narrow = std::int64_t{1} << 29;

} // namespace

RayCanvas::RayCanvas(const Host &host, const Camera &camera, abacus_ray_mode mode,
                     const std::optional<Box<3>> &box)
    : host_(host), camera_(camera), mode_(mode), pixels_(host), depths_(host), enters_(host) {
    const auto width = static_cast<std::size_t>(camera.width());
    const std::size_t size = width * static_cast<std::size_t>(camera.height());
    pixels_.reserve(size);
    enters_.resize(width);
    if (box) depths_.reserve(size);
    for (std::int32_t y = 0; y < camera.height(); ++y) {
        host_.poll();
        std::fill_n(pixels_.extend(width), width, Pixel{});
        if (!box) continue;
        Depths *depths = depths_.extend(width);
        for (std::int32_t x = 0; x < camera.width(); ++x) {
            const auto [from, to] = camera.depths_within(*box, x, y);
            depths[x] = {from, to};
        }
    }
}

// ---- What is ahead --------------------------------------------------------------------------

void RayCanvas::add(const Sight &a, const Sight &b, const Sight &c, const Sight &d) {
    const Corners corners{&a, &b, &c, &d};
    int ahead = 0;
    for (const Sight *corner : corners) ahead += corner->seen[2] >= camera_.nearest();
    if (ahead == 4)
        project(corners);
    else if (ahead > 0)
        add_clipped(corners);
}

void RayCanvas::add_clipped(const Corners &corners) {
    unsigned above = 0;
    for (unsigned i = 0; i < 4; ++i)
        above |= static_cast<unsigned>(corners[i]->seen[2] >= camera_.nearest()) << i;
    const TetrahedronCut &cut = tetrahedron_cuts[above];
    std::array<Sight, 4> at;
    for (int i = 0; i < cut.corners; ++i) {
        const Sight &from = *corners[cut.edge[i].below], &to = *corners[cut.edge[i].above];
        const double share = share_at(camera_.nearest(), from.seen[2], to.seen[2]);
        Point<3> seen = point_between(from.seen, to.seen, share);
        seen[2] = camera_.nearest();
        at[i] = camera_.sight(seen, value_between(from.value, to.value, share));
    }
    const auto &edge = cut.edge;
    if (cut.corners == 4) { // the first two edges have the same upper end, and so have the last two
        const Sight &c = *corners[edge[0].above], &d = *corners[edge[2].above];
        add_prism({c, at[0], at[1], d, at[3], at[2]});
    } else if (edge[0].below == edge[1].below) { // from one corner below to the three others
        add_prism({at[0], at[2], at[1], *corners[edge[0].above], *corners[edge[2].above],
                   *corners[edge[1].above]});
    } else {
        project({corners[edge[0].above], &at[0], &at[1], &at[2]});
    }
}

/// A prism: two triangles and the space between them.
void RayCanvas::add_prism(const std::array<Sight, 6> &corners) {
    const auto &[a, b, c, u, v, w] = corners;
    project({&a, &b, &c, &w});
    project({&a, &b, &w, &v});
    project({&a, &v, &w, &u});
}

// ---- From tetrahedra to pixels --------------------------------------------------------------

void RayCanvas::project(const Corners &corners) {
    host_.poll(); // each may cover the picture
    const auto [left, right] =
        std::minmax({corners[0]->x, corners[1]->x, corners[2]->x, corners[3]->x});
    const auto [top, bottom] =
        std::minmax({corners[0]->y, corners[1]->y, corners[2]->y, corners[3]->y});
    const std::int32_t first_x = std::max(0, first_pixel(left));
    const std::int32_t first_y = std::max(0, first_pixel(top));
    const std::int32_t end_x = std::min(camera_.width(), first_pixel(right + 1));
    const std::int32_t end_y = std::min(camera_.height(), first_pixel(bottom + 1));
    if (first_x >= end_x || first_y >= end_y) return;
    if (std::min(left, top) > -narrow && std::max(right, bottom) < narrow)
        fill<std::int64_t>(corners, first_x, end_x, first_y, end_y);
    else
        fill<__int128>(corners, first_x, end_x, first_y, end_y);
}

/// The pixels of a facet row by row: those on the inner side of all of its edges.
template <class Number> class FacetRows {
public:
    /// Places in a row are counted from the pixel `first_x`.
    FacetRows(const Facet &facet, const Line<Number> (&lines)[6],
              const std::array<const Sight *, 4> &corners, std::int32_t first_x)
        : first_x_(first_x) {
        Number area = 0; // twice, of either sign
        for (int i = 0; i < 3; ++i) area += lines[facet.edge[i]](0, 0) * facet.turn[i];
        const int turn = area > 0 ? 1 : area < 0 ? -1 : 0;
        exists_ = turn != 0;
        leaves_ = turn == facet.out;
        for (int i = 0; i < 3; ++i) {
            const Line<Number> &line = lines[facet.edge[i]];
            const int inner = turn * facet.turn[i];
            edges_[i] = {&line, corners[facet.corner[i]], inner, line.tie * inner > 0 ? 0 : 1,
                         -line.dy * Camera::steps * inner};
        }
    }

    bool exists() const { return exists_; }
    /// Whether rays leave the tetrahedron through this facet.
    bool leaves() const { return leaves_; }

    /// Calls visit(x, depth, value) for the pixels of a row before `end`.
    template <class Visit> void each(std::int32_t y, std::int32_t end, Visit visit) const {
        Number distance[3]; // from the edge, times its length
        Number first = 0, count = end - first_x_;
        for (int i = 0; i < 3; ++i) {
            const Edge &edge = edges_[i];
            const Number d = distance[i] =
                (*edge.line)(centre<Number>(first_x_), centre<Number>(y)) * edge.inner;
            if (edge.step > 0) {
                if (d < edge.least)
                    first = std::max(first, (edge.least - d + edge.step - 1) / edge.step);
            } else if (d < edge.least) {
                return;
            } else if (edge.step < 0) {
                count = std::min(count, (d - edge.least) / -edge.step + 1);
            }
        }
        if (first >= count) return;
        for (int i = 0; i < 3; ++i) distance[i] += first * edges_[i].step;
        for (Number at = first; at < count; ++at) {
            double sum = 0, depth = 0, value = 0;
            for (int i = 0; i < 3; ++i) {
                const Sight &corner = *edges_[i].opposite;
                const double share = static_cast<double>(distance[i]) * corner.weight;
                sum += share;
                depth += share * corner.seen[2];
                value += share * corner.value;
                distance[i] += edges_[i].step;
            }
            const double inverse = 1 / sum;
            visit(first_x_ + static_cast<std::int32_t>(at), depth * inverse, value * inverse);
        }
    }

private:
    struct Edge {
        const Line<Number> *line;
        const Sight *opposite;
        int inner;    // sign of the distance on the inner side
        Number least; // least distance that counts as inside
        Number step;  // from one pixel to the next
    };

    std::int32_t first_x_;
    bool exists_, leaves_;
    Edge edges_[3];
};

template <class Number>
void RayCanvas::fill(const Corners &corners, std::int32_t left, std::int32_t right,
                     std::int32_t top, std::int32_t bottom) {
    Line<Number> lines[6];
    for (int e = 0; e < 6; ++e) lines[e] = {*corners[ends[e][0]], *corners[ends[e][1]]};
    const FacetRows<Number> rows[4] = {{facets[0], lines, corners, left},
                                       {facets[1], lines, corners, left},
                                       {facets[2], lines, corners, left},
                                       {facets[3], lines, corners, left}};
    for (std::int32_t y = top; y < bottom; ++y) {
        if ((y - top) % 16 == 15) host_.poll();
        for (const FacetRows<Number> &facet : rows)
            if (facet.exists() && !facet.leaves())
                facet.each(y, right, [&](std::int32_t x, double depth, double value) {
                    enters_[static_cast<std::size_t>(x)] = {depth, value};
                });
        for (const FacetRows<Number> &facet : rows)
            if (facet.exists() && facet.leaves())
                facet.each(y, right, [&](std::int32_t x, double depth, double value) {
                    deposit(x, y, enters_[static_cast<std::size_t>(x)], {depth, value});
                });
    }
}

void RayCanvas::deposit(std::int32_t x, std::int32_t y, Hit enters, Hit leaves) {
    // If a tetrahedron is far smaller than a pixel, the rounding of its places may turn it inside
    // out. Its neighbours then are too long, so it counts below 0.
    const bool is_turned = leaves.depth < enters.depth;
    if (is_turned) std::swap(enters, leaves);
    const std::size_t at = index(x, y);
    if (!depths_.empty() && !cut_off(depths_[at], enters, leaves)) return;
    Pixel &pixel = pixels_[at];
    if (!std::isfinite(enters.value) || !std::isfinite(leaves.value)) {
        if (pixel.length == 0 && pixel.value == 0) pixel.value = NAN;
        return;
    }
    if (std::isnan(pixel.value)) pixel.value = 0;
    const auto [least, greatest] = std::minmax(enters.value, leaves.value);
    const double way = leaves.depth - enters.depth;
    const double mean = enters.value * 0.5 + leaves.value * 0.5;
    switch (mode_) {
    case ABACUS_RAY_MAX:
        pixel.value = pixel.length == 0 ? greatest : std::max(pixel.value, greatest);
        pixel.length = 1;
        break;
    case ABACUS_RAY_MIN:
        pixel.value = pixel.length == 0 ? least : std::min(pixel.value, least);
        pixel.length = 1;
        break;
    case ABACUS_RAY_MEAN: // a mean is never beyond its values: nothing counts below 0
        pixel.length += way;
        pixel.value += way * mean;
        break;
    case ABACUS_RAY_SUM:
        pixel.length += is_turned ? -way : way;
        pixel.value += is_turned ? -way * mean : way * mean;
        break;
    }
}

// ---- From pixels to colours -----------------------------------------------------------------

double RayCanvas::value(std::int32_t x, std::int32_t y) const {
    const Pixel &pixel = pixels_[index(x, y)];
    if (!(pixel.length > 0)) return NAN;
    if (mode_ == ABACUS_RAY_MEAN) return pixel.value / pixel.length;
    if (mode_ != ABACUS_RAY_SUM) return pixel.value;
    constexpr double most = std::numeric_limits<double>::max();
    return std::clamp(pixel.value * camera_.length(x, y), -most, most);
}

bool RayCanvas::is_blank() const {
    return std::none_of(pixels_.begin(), pixels_.end(), [](const Pixel &pixel) {
        return pixel.length > 0 || std::isnan(pixel.value);
    });
}

Png RayCanvas::png(const abacus_drawing &drawing) const {
    const Palette palette = Palette::of(drawing.ramp, ABACUS_RAMP_STRATA);
    const bool is_transparent = drawing.transparent != 0;
    constexpr std::uint32_t opaque = 0xff000000;
    const Encoder encode;
    const std::uint32_t ground = is_transparent ? 0 : encode(color(0xf4f1ea));
    const std::uint32_t unknown = opaque | encode(color(0xcfccc6));
    const auto [low, high] = range(drawing);
    const Scale scale(low, high);
    Picture picture(host_, camera_.width(), camera_.height(), is_transparent);
    for (std::int32_t y = 0; y < camera_.height(); ++y) {
        host_.poll();
        std::uint32_t *row = picture.row(y);
        for (std::int32_t x = 0; x < camera_.width(); ++x) {
            const double shown = value(x, y);
            row[x] = std::isnan(pixels_[index(x, y)].value) ? unknown : ground;
            if (!std::isnan(shown))
                row[x] =
                    opaque | encode(palette(low < high ? static_cast<float>(scale(shown)) : 0.5f));
        }
    }
    if (drawing.legend != nullptr && low <= high)
        add_legend(picture, palette, low, high, drawing.legend);
    return picture.png();
}

/// The given range, or the range of the visible values.
std::pair<double, double> RayCanvas::range(const abacus_drawing &drawing) const {
    if (has_range(drawing)) return {drawing.range[0], drawing.range[1]};
    double low = std::numeric_limits<double>::infinity(), high = -low;
    for (std::int32_t y = 0; y < camera_.height(); ++y) {
        host_.poll();
        for (std::int32_t x = 0; x < camera_.width(); ++x) {
            low = std::fmin(low, value(x, y)); // NaN does not count
            high = std::fmax(high, value(x, y));
        }
    }
    return {low, high};
}

} // namespace abacus
