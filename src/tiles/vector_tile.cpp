#include "tiles/vector_tile.hpp"

#include "geometry/clip_trapezoid.hpp"
#include "geometry/tetrahedron_cut.hpp"
#include "query/pages/extent.hpp"
#include "query/pages/page_simplex.hpp"
#include "query/pages/page_values.hpp"
#include "query/scan/extent_pages.hpp"
#include "query/scan/range_scan.hpp"
#include "query/shapes/outline.hpp"
#include "tiles/fixed_lines.hpp"
#include "tiles/in_tile.hpp"
#include "tiles/tile_samples.hpp"

#include <algorithm>
#include <cmath>
#include <optional>

namespace abacus {

namespace {

// Squares of samples along a side of a tile, with one more on each side.
constexpr std::uint32_t squares = 128;
// The most segments of contours: if there are more, the interval is doubled.
constexpr double most_segments = 32000;

struct Corner {
    Point<2> at; // in the tile
    double value;
    std::int64_t id;
};
using Triangle = std::array<Corner, 3>; // counterclockwise where y points up

const char *name_of(const abacus_tile_words &words, RegionNumber region) {
    const char *name = nullptr;
    host::require(words.region_name(words.context, region, &name));
    return name;
}

class Maker {
public:
    Maker(const Host &host, const abacus_facts &facts, const TileWindow &window,
          const abacus_tile_vector_kind &kind, const abacus_tile_words &words,
          const abacus_tile_memory &memory)
        : host_(host), facts_(facts), window_(window), kind_(kind), words_(words), memory_(memory),
          values_(host, facts, kind.attribute), triangles_(host), regions_(host), hull_(host),
          fixed_(host), bytes_(host) {
        if (const Polygon *polygon = polygon_of(kind.extent))
            polygon_.emplace(host, *polygon,
                             [this](const Point<2> &p) { return place_of_vertex(p); });
    }

    VectorTile make() {
        const bool has_triangles = read() && write_all();
        if (!has_triangles) {
            sample();
            find_hull();
            find_fixed();
            write_overview();
        }
        return {as_png(host_, bytes_), has_triangles};
    }

private:
    Point<2> place_of_vertex(const Point<2> &p) const { return in_tile(window_, p); }
    static bool meets_tile(const Point<2> &a, const Point<2> &b, const Point<2> &c) {
        Box<2> box;
        for (const Point<2> *p : {&a, &b, &c}) box.extend(*p);
        return box.meets(buffered_tile());
    }

    /// What the tile shows has another border than the mesh.
    bool is_part() const { return kind_.extent.region != no_region || polygon_; }
    /// Calls visit(a, b) for the parts of a segment that count, in units of the tile.
    template <class Visit> void each_part(const Point<2> &a, const Point<2> &b, Visit visit) const {
        if (!polygon_) return visit(a, b);
        polygon_->cut(a, b, [&](const Polygon::Stretch &part) { visit(part.first, part.last); });
    }

    bool read();
    bool read(const PageView<2> &page);
    void sample();
    void find_hull();
    void find_fixed();
    void add_fixed(const PageView<2> &page, int simplex);
    void add_triangles(VectorLayer &layer) const;
    void add_triangle(VectorLayer &layer, std::size_t n, const std::array<Point<2>, 3> &part) const;
    void add_vertices(VectorLayer &layer) const;
    void add_contours(VectorLayer &layer) const;
    double interval() const;
    void write_overview();
    bool write_all();

    const Host &host_;
    const abacus_facts &facts_;
    const TileWindow &window_;
    const abacus_tile_vector_kind &kind_;
    const abacus_tile_words &words_;
    const abacus_tile_memory &memory_;
    std::optional<Polygon> polygon_; // of the extent, in units of the tile
    PageValues<2> values_;
    Arena<Triangle> triangles_;
    Arena<RegionNumber> regions_; // of the triangles
    TileLines hull_;
    FixedLines fixed_;
    TileBuffer bytes_;
};

// ---- What the tile has -------------------------------------------------------------------------

/// Reads all triangles; false if there are too many.
bool Maker::read() {
    const BoxRegion<2> region(window_.in_mesh(vector_margin));
    RangeScan<2> pages(host_, facts_, &region);
    while (pages.advance())
        if (!read(pages.page())) return false;
    return true;
}

bool Maker::read(const PageView<2> &page) {
    values_.enter(page);
    for (int s = 0; s < page.simplices(); ++s) {
        const bool is_ghost = page.is_ghost(s);
        Triangle triangle{};
        for (int i = 0; i < (is_ghost ? 2 : 3); ++i) {
            const int v = page.corner(s, i);
            triangle[i] = {place_of_vertex(page.point(v)), NAN, page.id(v)};
        }
        if (is_ghost) {
            if (!is_part())
                hull_.add(0, triangle[1].at, triangle[0].at); // as the triangle beside it sees it
            continue;
        }
        if (!meets_tile(triangle[0].at, triangle[1].at, triangle[2].at)) continue;
        if (!is_in<2>(kind_.extent, page, s)) continue;
        if (triangles_.size() == most_tile_triangles) return false;
        for (int i = 0; i < 3; ++i) triangle[i].value = values_.value(page.corner(s, i));
        triangles_.push_back(triangle);
        regions_.push_back(page.region(s));
        if (words_.lines_apart == 0) add_fixed(page, s);
    }
    return true;
}

void Maker::add_fixed(const PageView<2> &page, int simplex) {
    const FixedFacets<2> fixed = page.fixed(simplex);
    for (int i = 0; i < 3; ++i) {
        if (!fixed.is_fixed(i)) continue;
        const auto end = [&](int next) {
            return place_of_vertex(page.point(page.corner(simplex, (i + next) % 3)));
        };
        each_part(end(1), end(2), [&](const Point<2> &from, const Point<2> &to) {
            fixed_.add(fixed[i], from, to);
        });
    }
}

/// Of a tile with many triangles.
void Maker::find_fixed() {
    fixed_.clear();
    if (facts_.census.lines == 0) return;
    const BoxRegion<2> region(window_.in_mesh(vector_margin));
    RangeScan<2> pages(host_, facts_, &region, pages_in<2>(kind_.extent));
    while (pages.advance()) {
        const PageView<2> &page = pages.page();
        for (int s = 0; page.is_lined() && s < page.simplices(); ++s)
            if (page.fixed(s).count() > 0 && !page.is_ghost(s) && is_in<2>(kind_.extent, page, s))
                add_fixed(page, s);
    }
}

/// Replaces the triangles by two for each square of a grid on which the attribute is known.
void Maker::sample() {
    triangles_.clear();
    if (kind_.attribute < 0 || !(kind_.contour_interval > 0)) return;
    constexpr std::uint32_t points = squares + 3; // from the corner of the square beside the tile
    // Samples are at the centres of pixels, so the box extends half a square further.
    const Box<2> box = window_.wider(1.5 / squares);
    ValueRaster<2> rows = tile_samples(
        host_, facts_, window_, box, points,
        {static_cast<std::uint32_t>(kind_.attribute), without_polygon(kind_.extent)}, memory_);
    constexpr double step = double{tile_extent} / squares;
    std::array<double, points> above{}, here{};
    for (std::uint32_t y = 0; y < points; ++y) {
        std::copy_n(rows.next(), points, here.begin());
        const auto corner = [&](std::uint32_t x, bool is_above) {
            return Corner{{(x - 1.0) * step, (y - (is_above ? 2.0 : 1.0)) * step},
                          (is_above ? above : here)[x],
                          0};
        };
        for (std::uint32_t x = 0; y > 0 && x + 1 < points; ++x) {
            triangles_.push_back({corner(x, false), corner(x + 1, false), corner(x, true)});
            triangles_.push_back({corner(x + 1, true), corner(x, true), corner(x + 1, false)});
        }
        above = here;
    }
}

/// Walks around the hull. In a mesh that is not Delaunay, it would have to read all pages.
void Maker::find_hull() {
    hull_.clear();
    if (is_part() || !abacus_links_ghosts(facts_.standing)) return;
    Outline<2> outline(host_, facts_, {}, memory_.sort, memory_.cache);
    abacus_outline_row row;
    std::optional<Point<2>> first, last;
    while (outline.next(row)) {
        const Point<2> here = place_of_vertex({row.point[0], row.point[1]});
        if (last) hull_.add(0, *last, here);
        if (!first) first = here;
        last = here;
    }
    if (first) hull_.add(0, *last, *first);
    outline.close();
}

// ---- Layers ------------------------------------------------------------------------------------

/// Cuts a polygon at a line of an axis; keeps the side of `sign`.
std::size_t cut(const std::array<Point<2>, 8> &polygon, std::size_t size, int axis, double at,
                double sign, std::array<Point<2>, 8> &result) {
    std::size_t count = 0;
    for (std::size_t i = 0; i < size; ++i) {
        const Point<2> &a = polygon[i], &b = polygon[(i + 1) % size];
        const bool is_in = (a[axis] - at) * sign >= 0, next_is_in = (b[axis] - at) * sign >= 0;
        if (is_in) result[count++] = a;
        if (is_in == next_is_in) continue;
        Point<2> crossing;
        crossing[axis] = at;
        crossing[1 - axis] =
            std::lerp(a[1 - axis], b[1 - axis], (at - a[axis]) / (b[axis] - a[axis]));
        result[count++] = crossing;
    }
    return count;
}

void Maker::add_triangles(VectorLayer &layer) const {
    for (std::size_t n = 0; n < triangles_.size(); ++n) {
        const Triangle &triangle = triangles_[n];
        if (!polygon_) {
            add_triangle(layer, n, {triangle[0].at, triangle[1].at, triangle[2].at});
            continue;
        }
        const Point<2> origin = triangle[0].at;
        Piece<2> whole{};
        Box<2> box;
        for (int i = 0; i < 3; ++i) {
            const Point<2> &p = triangle[i].at;
            box.extend(p);
            whole.corner[i] = {p[0] - origin[0], p[1] - origin[1]};
        }
        polygon_->each_part(box, [&](const Polygon::Trapezoid &trapezoid) {
            clip_trapezoid(whole, trapezoid, origin, [&](const Piece<2> &part) {
                std::array<Point<2>, 3> corners;
                for (int i = 0; i < 3; ++i)
                    corners[i] = {part.corner[i][0] + origin[0], part.corner[i][1] + origin[1]};
                add_triangle(layer, n, corners);
            });
        });
    }
}

/// Adds a part of triangle n.
void Maker::add_triangle(VectorLayer &layer, std::size_t n,
                         const std::array<Point<2>, 3> &part) const {
    const Box<2> box = buffered_tile();
    std::array<Point<2>, 8> polygon, other; // each side of the box adds at most one corner
    std::size_t size = 3;
    std::copy_n(part.begin(), 3, polygon.begin());
    for (int axis = 0; axis < 2; ++axis) {
        size = cut(polygon, size, axis, box.lower[axis], 1, other);
        size = cut(other, size, axis, box.upper[axis], -1, polygon);
    }
    std::array<TilePoint, 8> ring;
    std::size_t corners = 0;
    for (std::size_t i = 0; i < size; ++i) {
        const TilePoint corner = rounded(polygon[i]);
        if (corners == 0 || corner != ring[corners - 1]) ring[corners++] = corner;
    }
    while (corners > 1 && ring[corners - 1] == ring[0]) --corners;
    std::int64_t area = 0; // twice that of the reversed ring
    for (std::size_t i = 0, j = corners - 1; i < corners; j = i++)
        area += std::int64_t{ring[i].x} * ring[j].y - std::int64_t{ring[j].x} * ring[i].y;
    if (area == 0 || (area < 0 && !polygon_)) return;                 // flat after rounding
    if (area > 0) std::reverse(ring.begin(), ring.begin() + corners); // clockwise on the screen
    layer.begin_polygon({ring.data(), corners});
    const Triangle &triangle = triangles_[n];
    double sum = 0;
    for (std::uint32_t i = 0; i < 3; ++i) {
        layer.tag_id(i, triangle[i].id);
        sum += triangle[i].value / 3;
    }
    layer.tag(3, sum);
    if (words_.region_name != nullptr && regions_[n] != no_region)
        layer.tag_word(4, regions_[n], name_of(words_, regions_[n]));
}

void Maker::add_vertices(VectorLayer &layer) const {
    Arena<Corner> corners(host_);
    const Box<2> box = buffered_tile();
    for (const Triangle &triangle : triangles_)
        for (const Corner &corner : triangle)
            if (box.contains(corner.at) && (!polygon_ || polygon_->contains(corner.at)))
                corners.push_back(corner);
    const auto key = [](const Corner &c) { return std::tuple(c.at, c.id); };
    std::sort(corners.begin(), corners.end(),
              [&](const Corner &a, const Corner &b) { return key(a) < key(b); });
    const Corner *last = nullptr;
    for (const Corner &corner : corners) {
        if (last != nullptr && key(*last) == key(corner)) continue;
        last = &corner;
        layer.begin_point(rounded(corner.at));
        layer.tag_id(0, corner.id);
        layer.tag(1, corner.value);
    }
}

/// Calls visit(triangle, least, greatest) for the triangles that have values.
template <class Visit> void each_range(const Arena<Triangle> &triangles, Visit visit) {
    for (const Triangle &t : triangles) {
        const auto [least, most] = std::minmax({t[0].value, t[1].value, t[2].value});
        const auto has_value = [](const Corner &corner) { return std::isfinite(corner.value); };
        if (std::all_of(t.begin(), t.end(), has_value)) visit(t, least, most);
    }
}

/// The requested interval, times a power of two.
double Maker::interval() const {
    double interval = kind_.contour_interval;
    for (;;) {
        double count = 0;
        each_range(triangles_, [&](const Triangle &, double least, double most) {
            count += std::floor(most / interval) - std::floor(least / interval);
        });
        if (count <= most_segments) return interval;
        interval *= 2;
    }
}

// A corner at a level counts as above it. A line goes from where the border rises above the level
// to where it falls below, so higher ground is to the right.
void Maker::add_contours(VectorLayer &layer) const {
    if (!(kind_.contour_interval > 0)) return;
    const double step = interval();
    TileLines lines(host_);
    each_range(triangles_, [&](const Triangle &t, double least, double most) {
        host_.poll();
        const double below = std::floor(least / step), count = std::floor(most / step) - below;
        for (int n = 1; n <= count; ++n) {
            const double level = (below + n) * step;
            Point<2> rise{}, fall{};
            for (std::size_t i = 0; i < 3; ++i) {
                const Corner &from = t[i], &to = t[(i + 1) % 3];
                const bool is_above = to.value >= level;
                if ((from.value >= level) == is_above) continue;
                // Upwards, so that both triangles of an edge find the same point.
                const Corner &low = is_above ? from : to, &high = is_above ? to : from;
                const double share = share_at(level, low.value, high.value);
                Point<2> &at = is_above ? rise : fall;
                for (int k = 0; k < 2; ++k) at[k] = std::lerp(low.at[k], high.at[k], share);
            }
            each_part(rise, fall, [&](const Point<2> &from, const Point<2> &to) {
                lines.add(level, from, to);
            });
        }
    });
    lines.put_into(layer, [](VectorLayer &l, double level) { l.tag(0, level); });
}

void Maker::write_overview() {
    TileWriter tile(bytes_);
    VectorLayer contours(host_, "contours", {"value"}), fixed(host_, "fixed", {"kind"}),
        hull(host_, "hull", {});
    add_contours(contours);
    contours.write(host_, tile);
    fixed_.put_into(fixed);
    fixed.write(host_, tile);
    hull_.put_into(hull, nullptr);
    hull.write(host_, tile);
}

/// False, with nothing written, if that is too large.
bool Maker::write_all() {
    VectorLayer triangles(host_, "triangles", {"v0", "v1", "v2", "value"});
    if (words_.region_name != nullptr) triangles.add_key("region");
    VectorLayer vertices(host_, "vertices", {"id", "value"});
    add_triangles(triangles);
    add_vertices(vertices);
    {
        TileWriter tile(bytes_);
        triangles.write(host_, tile);
        vertices.write(host_, tile);
    }
    write_overview();
    if (bytes_.size() <= most_tile_bytes) return true;
    bytes_.clear();
    return false;
}

} // namespace

VectorTile vector_tile(const Host &host, const abacus_facts &facts, const abacus_tile &tile,
                       const abacus_tile_vector_kind &kind, const abacus_tile_words &words,
                       const abacus_tile_memory &memory) {
    const TileWindow window(tile, facts);
    if (kind.attribute >= static_cast<std::int32_t>(facts.columns.attributes))
        throw Error(ABACUS_ERROR_ARGUMENT, "the mesh has no such attribute");
    if (!(std::isfinite(kind.contour_interval) && kind.contour_interval >= 0))
        throw Error(ABACUS_ERROR_ARGUMENT, "interval of the contours is negative or not finite");
    return Maker(host, facts, window, kind, words, memory).make();
}

} // namespace abacus
