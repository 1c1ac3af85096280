#include "tiles/tile_surface.hpp"

#include "geometry/in_words.hpp"
#include "points/record.hpp"
#include "query/locate/hull_box.hpp"
#include "query/pages/page_simplex.hpp"
#include "query/pages/page_values.hpp"
#include "query/places/place_value.hpp"
#include "query/places/places.hpp"
#include "query/scan/range_scan.hpp"

#include <tuple>

namespace abacus {

namespace {

// Squares of samples along a side.
constexpr int grid_squares = 64;
constexpr int grid_points = grid_squares + 1;

/// What the mesh has on a border between two places; the one with the lesser coordinate first.
struct BorderPiece {
    SurfaceCorner from, to;
};

/// A border of the tile, with its box, which is flat, and the axis along it.
struct BorderLine {
    TileBorder border;
    Box<2> box;
    int along;
};

/// A place along a border, and whether the mesh covers the way to the next one.
struct ChainLink {
    SurfaceCorner corner;
    bool is_covered;
};

bool has_height(const SurfaceCorner &corner) { return std::isfinite(corner.height); }

class SurfaceMaker {
public:
    SurfaceMaker(const Host &host, const abacus_facts &facts, const Box<2> &box,
                 const TileFrame &frame, std::uint32_t attribute, const abacus_tile_memory &memory)
        : host_(host), facts_(facts), box_(box), frame_(frame), attribute_(attribute),
          memory_(memory), values_(host, facts, static_cast<int>(attribute)),
          corners_(host), lines_{line(west_border, 0, box.lower[0]),
                                 line(east_border, 0, box.upper[0]),
                                 line(south_border, 1, box.lower[1]),
                                 line(north_border, 1, box.upper[1])},
          pieces_{Arena<BorderPiece>(host), Arena<BorderPiece>(host), Arena<BorderPiece>(host),
                  Arena<BorderPiece>(host)},
          chains_{Arena<ChainLink>(host), Arena<ChainLink>(host), Arena<ChainLink>(host),
                  Arena<ChainLink>(host)} {}

    Arena<SurfaceCorner> make() {
        if (facts_.census.simplices > 0 && !read_all()) make_grid();
        return std::move(corners_);
    }

private:
    struct MeshTriangle {
        std::array<Point<3>, 3> corners; // x, y, height
        Point<3> normal;
    };

    BorderLine line(TileBorder border, int axis, double at) const {
        Box<2> flat = box_;
        flat.lower[axis] = flat.upper[axis] = at;
        return {border, flat, 1 - axis};
    }

    template <class Visit> bool each_triangle(const Box<2> &box, Visit visit);
    bool read_all();
    bool add_pieces(std::size_t n, const MeshTriangle &triangle);
    void add_part(const MeshTriangle &triangle);
    void add(const SurfaceCorner &a, const SurfaceCorner &b, const SurfaceCorner &c) {
        for (const SurfaceCorner *corner : {&a, &b, &c}) corners_.push_back(*corner);
    }

    void make_grid();
    Box<2> area_of_grid() const;
    bool is_on_border(std::size_t n) const;
    void sample();
    SurfaceCorner sampled(int x, int y) const;
    double place_of(int axis, int n) const {
        return n == grid_squares
                   ? area_.upper[axis]
                   : area_.lower[axis] + (area_.upper[axis] - area_.lower[axis]) / grid_squares * n;
    }
    void make_chain(std::size_t n);
    void make_sampled_chain(std::size_t n);
    void join(std::size_t n);

    const Host &host_;
    const abacus_facts &facts_;
    const Box<2> box_;
    const TileFrame &frame_;
    const std::uint32_t attribute_;
    const abacus_tile_memory &memory_;
    PageValues<2> values_;
    Arena<SurfaceCorner> corners_;
    const std::array<BorderLine, 4> lines_;
    std::array<Arena<BorderPiece>, 4> pieces_;
    std::array<Arena<ChainLink>, 4> chains_;
    Box<2> area_; // of the grid
    // Of the grid and a place more on each side; NaN where there is no value.
    std::array<double, (grid_points + 2) * (grid_points + 2)> samples_{};
};

/// Calls visit(triangle) for those that meet the box and have heights, until it returns false.
template <class Visit> bool SurfaceMaker::each_triangle(const Box<2> &box, Visit visit) {
    const BoxRegion<2> region(box);
    RangeScan<2> pages(host_, facts_, &region);
    while (pages.advance()) {
        const PageView<2> &page = pages.page();
        values_.enter(page);
        for (int s = 0; s < page.simplices(); ++s) {
            if (page.is_ghost(s)) continue;
            MeshTriangle triangle{};
            Box<2> around;
            for (const Point<2> *corner : corners_of<2>(page, s)) around.extend(*corner);
            if (!around.meets(box)) continue;
            bool has_heights = true;
            for (int i = 0; i < 3; ++i) {
                const int v = page.corner(s, i);
                const Point<2> &p = page.point(v);
                frame_.require_place(p);
                triangle.corners[i] = {p[0] + 0.0, p[1] + 0.0, values_.value(v)};
                has_heights &= std::isfinite(triangle.corners[i][2]);
            }
            if (!has_heights) continue;
            std::array<Point<3>, 3> places;
            for (int i = 0; i < 3; ++i) {
                const Point<3> &p = triangle.corners[i];
                places[i] = frame_.place({p[0], p[1]}, p[2]);
            }
            triangle.normal = normal_of(places[0], places[1], places[0], places[2]);
            if (!visit(triangle)) return false;
        }
    }
    return true;
}

/// All triangles of the tile; false if it, or a border, has too many.
bool SurfaceMaker::read_all() {
    std::size_t triangles = 0;
    return each_triangle(box_, [&](const MeshTriangle &triangle) {
        for (std::size_t n = 0; n < 4; ++n)
            if (!add_pieces(n, triangle)) return false;
        const std::size_t before = corners_.size();
        add_part(triangle);
        return corners_.size() == before || ++triangles <= most_surface_triangles;
    });
}

/// Adds the part of a triangle in the tile: a fan.
void SurfaceMaker::add_part(const MeshTriangle &triangle) {
    TileCut tile(box_);
    const std::span<const CutCorner> part = tile.cut(triangle.corners);
    const auto corner = [&](std::size_t i) {
        return SurfaceCorner{part[i].at, part[i].height, triangle.normal, part[i].borders};
    };
    std::size_t first = 0; // of the least place: the same wherever the triangle begins
    for (std::size_t i = 1; i < part.size(); ++i)
        if (lexicographically_less<2>(part[i].at, part[first].at)) first = i;
    for (std::size_t i = 1; i + 1 < part.size(); ++i)
        add(corner(first), corner((first + i) % part.size()),
            corner((first + i + 1) % part.size()));
}

/// Adds what a triangle has on a border; false if that has too many pieces.
bool SurfaceMaker::add_pieces(std::size_t n, const MeshTriangle &triangle) {
    const BorderLine &line = lines_[n];
    Box<2> around;
    for (const Point<3> &p : triangle.corners) around.extend(Point<2>{p[0], p[1]});
    if (!around.meets(line.box)) return true;
    TileCut flat(line.box);
    const CutCorner *least = nullptr, *greatest = nullptr;
    for (const CutCorner &corner : flat.cut(triangle.corners)) {
        const double at = corner.at[line.along];
        if (least == nullptr || at < least->at[line.along]) least = &corner;
        if (greatest == nullptr || at > greatest->at[line.along]) greatest = &corner;
    }
    if (least == greatest || least->at == greatest->at) return true;
    if (pieces_[n].size() == most_border_pieces) return false;
    const auto corner = [&](const CutCorner &from) {
        constexpr int level = south_border | north_border, upright = west_border | east_border;
        const int ends = from.borders & (line.along == 0 ? upright : level);
        return SurfaceCorner{from.at, from.height, triangle.normal,
                             static_cast<std::uint8_t>(ends | line.border)};
    };
    pieces_[n].push_back({corner(*least), corner(*greatest)});
    return true;
}

// ---- A grid ------------------------------------------------------------------------------------

void SurfaceMaker::make_grid() {
    corners_.clear();
    area_ = area_of_grid();
    if (!(area_.lower[0] < area_.upper[0] && area_.lower[1] < area_.upper[1])) return;
    sample();
    for (std::size_t n = 0; n < 4; ++n) {
        pieces_[n].clear();
        const bool has_few =
            is_on_border(n) && each_triangle(lines_[n].box, [&](const MeshTriangle &triangle) {
                return add_pieces(n, triangle);
            });
        has_few ? make_chain(n) : make_sampled_chain(n);
        join(n);
    }
    const auto add_if_known = [&](const SurfaceCorner &a, const SurfaceCorner &b,
                                  const SurfaceCorner &c) {
        if (has_height(a) && has_height(b) && has_height(c)) add(a, b, c);
    };
    for (int y = 1; y + 2 < grid_points; ++y) {
        host_.poll();
        for (int x = 1; x + 2 < grid_points; ++x) {
            add_if_known(sampled(x, y), sampled(x + 1, y), sampled(x, y + 1));
            add_if_known(sampled(x + 1, y + 1), sampled(x, y + 1), sampled(x + 1, y));
        }
    }
}

/// The part of the tile in which there may be a mesh: far out that is little of it.
Box<2> SurfaceMaker::area_of_grid() const {
    Box<2> mesh = hull_box<2>(host_, facts_, memory_.cache);
    if (!std::isfinite(mesh.lower[0]) && facts_.census.outside == 0)
        mesh = {{facts_.form.lower[0], facts_.form.lower[1]},
                {facts_.form.upper[0], facts_.form.upper[1]}};
    Box<2> area;
    for (int axis = 0; axis < 2; ++axis) {
        area.lower[axis] = std::max(box_.lower[axis], mesh.lower[axis]);
        area.upper[axis] = std::min(box_.upper[axis], mesh.upper[axis]);
    }
    return area;
}

/// Whether that side of the grid is on the border of the tile.
bool SurfaceMaker::is_on_border(std::size_t n) const {
    const int across = 1 - lines_[n].along;
    return (n % 2 == 0 ? area_.lower[across] == box_.lower[across]
                       : area_.upper[across] == box_.upper[across]);
}

/// Asks for the values at all places of the grid, and of one more on each side.
void SurfaceMaker::sample() {
    abacus_interpolation how{};
    how.attributes = 1;
    how.attribute[0] = attribute_;
    Places<2> places(host_, facts_, memory_.sort, memory_.cache);
    samples_.fill(NAN);
    std::int64_t id = 0;
    for (int y = -1; y <= grid_points; ++y)
        for (int x = -1; x <= grid_points; ++x) {
            std::array<std::uint64_t, record_words(2, 0)> record;
            fill_record<2>(record.data(), id++, {place_of(0, x) + 0.0, place_of(1, y) + 0.0},
                           nullptr, 0);
            places.add(record.data(), 1);
        }
    places.each(PlaceValue<2>(how, samples_.data()));
}

/// Its normal is from the samples around it, and so the same in all tiles that have it.
SurfaceCorner SurfaceMaker::sampled(int x, int y) const {
    const auto height = [&](int column, int row) {
        return samples_[static_cast<std::size_t>(row + 1) * (grid_points + 2) +
                        static_cast<std::size_t>(column + 1)];
    };
    // Itself stands for one without a value: at the side of a mesh one neighbour gives the slope.
    const auto place = [&](int column, int row) {
        const bool is_known = std::isfinite(height(column, row));
        const int i = is_known ? column : x, k = is_known ? row : y;
        return frame_.place({place_of(0, i), place_of(1, k)}, height(i, k));
    };
    const Point<3> normal =
        normal_of(place(x - 1, y), place(x + 1, y), place(x, y - 1), place(x, y + 1));
    const Point<2> at{place_of(0, x), place_of(1, y)};
    const int borders =
        (at[0] == box_.lower[0] ? west_border : 0) | (at[0] == box_.upper[0] ? east_border : 0) |
        (at[1] == box_.lower[1] ? south_border : 0) | (at[1] == box_.upper[1] ? north_border : 0);
    return {at, height(x, y), normal, static_cast<std::uint8_t>(borders)};
}

/// What the mesh has on a border, in order.
void SurfaceMaker::make_chain(std::size_t n) {
    const int along = lines_[n].along;
    const auto key = [along](const SurfaceCorner &corner) {
        return std::tuple(corner.at[along], corner.height);
    };
    const auto all = [key](const BorderPiece &piece) {
        return std::tuple(key(piece.from), key(piece.to), piece.from.normal);
    };
    Arena<BorderPiece> &pieces = pieces_[n];
    std::sort(pieces.begin(), pieces.end(),
              [&](const BorderPiece &a, const BorderPiece &b) { return all(a) < all(b); });
    Arena<ChainLink> &chain = chains_[n];
    for (const BorderPiece &piece : pieces) {
        const auto add_normal = [&piece](SurfaceCorner &corner) {
            for (int i = 0; i < 3; ++i) corner.normal[i] += piece.from.normal[i];
        };
        const std::size_t size = chain.size();
        if (size > 1 && key(chain[size - 2].corner) == key(piece.from) &&
            key(chain[size - 1].corner) == key(piece.to)) { // an edge, seen from its other side
            add_normal(chain[size - 2].corner);
            add_normal(chain[size - 1].corner);
            continue;
        }
        if (size > 0 && key(chain.back().corner) == key(piece.from)) {
            chain.back().is_covered = true;
            add_normal(chain.back().corner);
        } else {
            chain.push_back({piece.from, true});
        }
        chain.push_back({piece.to, false});
    }
}

void SurfaceMaker::make_sampled_chain(std::size_t n) {
    for (int i = 0; i < grid_points; ++i) {
        const int across =
            (lines_[n].border & (west_border | south_border)) != 0 ? 0 : grid_squares;
        const SurfaceCorner corner = lines_[n].along == 0 ? sampled(i, across) : sampled(across, i);
        if (!has_height(corner)) continue;
        chains_[n].push_back({corner, false});
    }
    const int along = lines_[n].along;
    const double step = (area_.upper[along] - area_.lower[along]) / grid_squares;
    for (std::size_t i = 0; i + 1 < chains_[n].size(); ++i) {
        const double length = chains_[n][i + 1].corner.at[along] - chains_[n][i].corner.at[along];
        chains_[n][i].is_covered = length < 1.5 * step;
    }
}

/// Fills the strip between a border and the grid.
void SurfaceMaker::join(std::size_t n) {
    const BorderLine &line = lines_[n];
    const Arena<ChainLink> &outer = chains_[n];
    if (outer.empty()) return;
    const bool is_lower = (line.border & (west_border | south_border)) != 0;
    // Counterclockwise if the grid is to the left of the border.
    const bool has_grid_left = line.border == south_border || line.border == east_border;
    const auto inner = [&](int i) {
        const int across = is_lower ? 1 : grid_squares - 1;
        return line.along == 0 ? sampled(i, across) : sampled(across, i);
    };
    const auto add_turned = [&](const SurfaceCorner &a, const SurfaceCorner &b,
                                const SurfaceCorner &c) {
        if (!has_height(a) || !has_height(b) || !has_height(c)) return;
        has_grid_left ? add(a, b, c) : add(a, c, b);
    };
    std::size_t i = 0; // on the border
    int k = 1;         // in the grid
    while (i + 1 < outer.size() || k + 1 < grid_squares) {
        const bool ends = i + 1 == outer.size(), inner_ends = k + 1 == grid_squares;
        const double middle =
            place_of(line.along, k) / 2 + (inner_ends ? 0 : place_of(line.along, k + 1) / 2);
        const double here = outer[i].corner.at[line.along];
        if (!ends && (inner_ends || here / 2 + outer[i + 1].corner.at[line.along] / 2 <= middle)) {
            if (outer[i].is_covered) add_turned(outer[i].corner, outer[i + 1].corner, inner(k));
            ++i;
            continue;
        }
        // The mesh must cover the border on that side of its place.
        const bool is_covered =
            middle > here ? outer[i].is_covered : i > 0 && outer[i - 1].is_covered;
        if (is_covered || middle == here) add_turned(outer[i].corner, inner(k + 1), inner(k));
        ++k;
    }
}

} // namespace

void throw_beyond_floats(const SurfaceCorner &corner) {
    throw Error(ABACUS_ERROR_RANGE, "a place of the tile is beyond the range of 32-bit floats",
                "It is " + in_words(Point<3>{corner.at[0], corner.at[1], corner.height}) +
                    ", with its height; floats end at 3.4e+38.",
                "Give an attribute with heights in metres. A triangle with a corner whose value is "
                "NULL is left out.");
}

Arena<SurfaceCorner> tile_surface(const Host &host, const abacus_facts &facts, const Box<2> &box,
                                  const TileFrame &frame, std::uint32_t attribute,
                                  const abacus_tile_memory &memory) {
    return SurfaceMaker(host, facts, box, frame, attribute, memory).make();
}

} // namespace abacus
