#include "tiles/picture_tile.hpp"

#include "query/locate/hull_box.hpp"
#include "query/places/places.hpp"
#include "query/values/barycentric.hpp"
#include "query/values/weighted_mean.hpp"
#include "tiles/tile_window.hpp"

namespace abacus {

namespace {

// From this number of triangles a pixel on, the centres of pixels are looked up instead: that takes
// as long as some triangles each.
constexpr double most_drawn = 4;

// At the equator.
constexpr double metres_of_degree = 20037508.342789244 / 180;

/// The centres of the pixels, including those of the margin.
class Samples {
public:
    Samples(const TileWindow &window, const abacus_drawing &drawing, std::int32_t margin)
        : window_(window), width_(drawing.width), margin_(margin), step_(window.side() / width_) {}

    /// Adds the centres within a box of the mesh.
    void add_to(Places<2> &places, const Box<2> &around) const {
        constexpr std::size_t at_once = 512, words = record_words(2, 0);
        std::array<std::uint64_t, at_once * words> records;
        std::size_t count = 0;
        for (std::int32_t y = -margin_; y < width_ + margin_; ++y)
            for (std::int32_t x = -margin_; x < width_ + margin_; ++x) {
                const Point<2> place = window_.plane().unproject(at(x + 0.5, y + 0.5));
                if (!around.contains(place)) continue;
                const std::int64_t id =
                    std::int64_t{y + margin_} * (width_ + 2 * margin_) + (x + margin_);
                fill_record<2>(records.data() + count * words, id, place, nullptr, 0);
                if (++count == at_once) places.add(records.data(), std::exchange(count, 0));
            }
        if (count > 0) places.add(records.data(), count);
    }

    /// The square of a pixel.
    Patch patch(std::int64_t id) const {
        constexpr double inset = 1e-6; // the whole square is in the pixel, whatever is rounded
        const double x = static_cast<double>(id % (width_ + 2 * margin_) - margin_);
        const double y = static_cast<double>(id / (width_ + 2 * margin_) - margin_);
        Patch patch;
        patch.corners = 4;
        for (int i = 0; i < 4; ++i) {
            const Point<2> corner =
                at(x + (i == 1 || i == 2 ? 1 - inset : inset), y + (i >= 2 ? 1 - inset : inset));
            patch.corner[i][0] = corner[0];
            patch.corner[i][1] = corner[1];
        }
        return patch;
    }

private:
    /// A place in pixels from the upper left corner.
    Point<2> at(double x, double y) const {
        return {window_.box().lower[0] + x * step_, window_.box().upper[1] - y * step_};
    }

    const TileWindow &window_;
    const std::int32_t width_, margin_;
    const double step_; // of a pixel
};

/// A spacing of vertices that gives triangles of this size.
double spacing_of(const abacus_simplex &simplex, const MapPlane &plane) {
    Point<2> p[3];
    for (int i = 0; i < 3; ++i) p[i] = plane.project({simplex.corner[i][0], simplex.corner[i][1]});
    const double twice =
        (p[1][0] - p[0][0]) * (p[2][1] - p[0][1]) - (p[2][0] - p[0][0]) * (p[1][1] - p[0][1]);
    return std::sqrt(std::fmax(twice, 0));
}

/// What a sample is drawn with: the value there, the size of its triangle, and its region.
struct Sample {
    double value;   // NaN: none
    double spacing; // negative outside the mesh
    std::uint64_t region;
};

class SampleQuestion final : public Question<2> {
public:
    SampleQuestion(const abacus_drawing &drawing, const MapPlane &plane, const Samples &samples,
                   Canvas &canvas)
        : attribute_(static_cast<std::uint32_t>(std::max(drawing.attribute, 0))),
          has_attribute_(drawing.attribute >= 0), extent_(without_polygon(drawing.extent)),
          plane_(plane), samples_(samples), canvas_(canvas) {}

    std::size_t words() const override { return sizeof(Sample) / 8; }
    bool is_quick() const override { return true; }
    void answer(Answerer<2> &by, const Point<2> &place, Tape &tape) const override {
        CornerValues values(&attribute_, 1);
        abacus_simplex simplex;
        Sample sample{NAN, -1, no_region};
        if (by.reader.locate(place, simplex, has_attribute_ ? &values : nullptr, extent_)) {
            sample.spacing = spacing_of(simplex, plane_);
            sample.region = simplex.region;
            if (has_attribute_) {
                const auto weights = barycentric_weights<2>(simplex, place);
                sample.value = weighted_mean(
                    3, [&](std::size_t i) { return weights[i]; },
                    [&](std::size_t i) { return values.value(static_cast<int>(i), 0); });
            }
        }
        tape.put(sample);
    }
    void tell(std::int64_t id, Tape::Player &answers) const override {
        const auto &sample = answers.take<Sample>();
        if (sample.spacing < 0) return;
        Patch patch = samples_.patch(id);
        std::fill_n(patch.value, 4, sample.value);
        patch.spacing = sample.spacing;
        patch.region = static_cast<std::uint32_t>(sample.region);
        canvas_.add(patch);
    }

private:
    const std::uint32_t attribute_;
    const bool has_attribute_;
    const abacus_extent extent_;
    const MapPlane &plane_;
    const Samples &samples_;
    Canvas &canvas_;
};

Portrait draw_samples(const Host &host, const abacus_facts &facts, const TileWindow &window,
                      const abacus_drawing &drawing, const abacus_tile_memory &memory) {
    const std::int32_t margin = Canvas::margin_of(drawing);
    const Samples samples(window, drawing, margin);
    Places<2> places(host, facts, memory.sort, memory.cache);
    samples.add_to(places, hull_box<2>(host, facts, memory.cache));
    Canvas canvas(host, drawing, drawing.attribute >= 0 ? drawing.range[0] : NAN,
                  drawing.attribute >= 0 ? drawing.range[1] : NAN, margin);
    places.each(SampleQuestion(drawing, window.plane(), samples, canvas));
    draw_fixed_edges(host, facts, drawing, canvas);
    leave_polygon(drawing, canvas);
    return {canvas.png(Palette::of(drawing.ramp, ABACUS_RAMP_TERRAIN)), canvas.is_blank()};
}

} // namespace

Portrait draw_picture_tile(const Host &host, const abacus_facts &facts, const abacus_tile &tile,
                           const abacus_drawing &drawing, const abacus_tile_memory &memory) {
    const TileWindow window(tile, facts);
    if (drawing.attribute >= static_cast<std::int32_t>(facts.columns.attributes))
        throw Error(ABACUS_ERROR_ARGUMENT, "the mesh has no such attribute");
    if (drawing.attribute >= 0 && !has_range(drawing))
        throw Error(ABACUS_ERROR_ARGUMENT, "a picture tile of an attribute needs a range", {},
                    "Give the same range for all tiles: a value then has one colour everywhere.");
    abacus_drawing of_tile = drawing;
    for (int axis = 0; axis < 2; ++axis) {
        of_tile.lower[axis] = window.box().lower[axis];
        of_tile.upper[axis] = window.box().upper[axis];
    }
    of_tile.height = drawing.width;
    of_tile.is_geographic = tile.is_geographic;
    if (tile.is_geographic != 0) of_tile.exaggeration /= metres_of_degree;
    check_drawing(of_tile);
    of_tile.density = window.mean_triangles(facts, window.side() / drawing.width);
    if (of_tile.density > most_drawn) return draw_samples(host, facts, window, of_tile, memory);
    return draw_mesh(host, facts, of_tile);
}

} // namespace abacus
