#include "query/places/value_raster.hpp"

#include "geometry/facet_order.hpp"
#include "geometry/map_plane.hpp"
#include "points/record.hpp"
#include "query/locate/hull_box.hpp"
#include "query/pages/extent.hpp"
#include "query/pages/page_flood.hpp"
#include "query/pages/page_simplex.hpp"
#include "query/places/place_value.hpp"
#include "query/places/places.hpp"
#include "query/scan/extent_pages.hpp"
#include "query/values/barycentric.hpp"
#include "query/values/weighted_mean.hpp"

#include <bit>
#include <cmath>

namespace abacus {

namespace {

/// The part of a row's line within a facet's half-space: a lower or an upper bound on x, or none.
/// The bounds are wide enough for rounding errors.
struct Bounds {
    double least = -INFINITY, greatest = INFINITY;
};

/// An upper bound on what a product may lose when it underflows.
constexpr double underflow = 1e-300;

/// The normal of a facet, towards the simplex, and bounds on the errors of its coordinates.
template <int D> struct Normal { Point<D> n, error; };

Normal<2> normal_of(const Point<2> &a, const Point<2> &b) {
    const Point<2> n{a[1] - b[1], b[0] - a[0]};
    return {n, {std::fabs(n[0]) * 2e-16, std::fabs(n[1]) * 2e-16}};
}

Normal<3> normal_of(const Point<3> &a, const Point<3> &b, const Point<3> &c) {
    Normal<3> normal;
    for (int i = 0; i < 3; ++i) {
        const int j = (i + 1) % 3, k = (i + 2) % 3;
        const double left = (b[j] - a[j]) * (c[k] - a[k]), right = (b[k] - a[k]) * (c[j] - a[j]);
        normal.n[i] = left - right;
        normal.error[i] = 1e-15 * (std::fabs(left) + std::fabs(right)) + underflow;
    }
    return normal;
}

template <int D>
void restrict_by_facet(const Corners<D> &corners, int facet, const Point<D> &in_row,
                       Bounds &bounds) {
    const auto &order = facet_order<D>[facet];
    const Point<D> &a = *corners[order[0]];
    const auto [n, error] = [&] {
        if constexpr (D == 2)
            return normal_of(a, *corners[order[1]]);
        else
            return normal_of(a, *corners[order[1]], *corners[order[2]]);
    }();
    const double slope = std::fabs(n[0]);
    if (!(slope > 100 * error[0])) return;
    double beside = 0, beside_error = underflow;
    for (int axis = 1; axis < D; ++axis) {
        const double distance = in_row[axis] - a[axis];
        beside += n[axis] * distance;
        beside_error += (error[axis] + 1e-15 * std::fabs(n[axis])) * std::fabs(distance);
    }
    const double x = a[0] - beside / n[0];
    const double margin = 2 * (beside_error + std::fabs(beside) * error[0] / slope) / slope +
                          1e-15 * (std::fabs(x) + std::fabs(a[0]));
    if (!std::isfinite(x) || !std::isfinite(margin)) return;
    if (n[0] > 0)
        bounds.least = std::max(bounds.least, x - margin);
    else
        bounds.greatest = std::min(bounds.greatest, x + margin);
}

/// The facets that p is on, as bits; negative if p is outside.
template <int D> int facets_at(const Corners<D> &corners, const Point<D> &p) {
    int facets = 0;
    for (int i = 0; i <= D; ++i) {
        const int side = facet_side<D>(corners, i, p);
        if (side < 0) return -1;
        facets |= (side == 0) << i;
    }
    return facets;
}

} // namespace

template <int D>
ValueRaster<D>::ValueRaster(const Host &host, const abacus_facts &facts,
                            const abacus_raster &raster, const abacus_interpolation &how,
                            std::size_t memory, std::size_t cache_bytes)
    : host_(host), facts_(facts), raster_(raster), width_(raster.upper[0] - raster.lower[0]),
      height_(raster.upper[1] - raster.lower[1]), how_(how), memory_(memory / 2),
      cache_bytes_(cache_bytes), latitudes_(host), values_(host), marks_(host),
      carried_(how_.attribute, 1), vertex_values_(host, facts) {
    if (!std::isfinite(width_ * raster.width) || !std::isfinite(height_ * raster.height))
        throw Error(ABACUS_ERROR_ARGUMENT, "the window is too large for the centres of its pixels",
                    {}, "Ask for a smaller window.");
    const std::size_t row_bytes = raster.width * (sizeof(double) + sizeof(Mark));
    rows_ =
        static_cast<std::uint32_t>(std::clamp<std::size_t>(memory_ / row_bytes, 1, raster.height));
    values_.resize(std::size_t(rows_) * raster.width);
    marks_.resize(std::size_t(rows_) * raster.width);
    for (std::uint32_t row = 0; raster.is_geographic != 0 && row < raster.height; ++row)
        latitudes_.push_back(MapPlane::latitude(evenly(row)));
}

template <int D> const double *ValueRaster<D>::next() {
    if (next_ == raster_.height) return nullptr;
    if (next_ == first_ + filled_) {
        first_ = next_;
        filled_ = std::min(rows_, raster_.height - first_);
        fill_band();
    }
    return values_.data() + std::size_t(next_++ - first_) * raster_.width;
}

template <int D> void ValueRaster<D>::fill_band() {
    const bool is_finer = is_finer_than_pixels();
    const bool is_linear = how_.method == ABACUS_LINEAR && !is_finer;
    const bool has_value_outside = how_.outside == ABACUS_OUTSIDE_NEAREST;
    if (is_finer && !has_value_outside && !extent_)
        extent_ = hull_box<D>(host_, facts_, cache_bytes_);
    std::fill(values_.begin(), values_.end(), NAN);
    std::fill(marks_.begin(), marks_.end(), is_linear && !has_value_outside ? filled : asked);
    if (is_linear && facts_.census.simplices > 0) fill_linear();
    ask();
}

template <int D> bool ValueRaster<D>::is_finer_than_pixels() const {
    // A place takes as long as this many simplices that fill nothing.
    constexpr double most_read = 8;
    if (D == 3 || facts_.form.has_domain == 0) return false;
    double pixels = 1; // in the domain
    for (int axis = 0; axis < 2; ++axis)
        pixels *= (facts_.form.upper[axis] / 2 - facts_.form.lower[axis] / 2) * 2 /
                  (axis == 0 ? width_ / raster_.width : height_ / raster_.height);
    return static_cast<double>(facts_.census.simplices) > most_read * pixels;
}

// ---- Asked for as places ----------------------------------------------------------------

template <int D> void ValueRaster<D>::ask() {
    constexpr std::size_t at_once = 512, words = record_words(D, 0);
    std::array<std::uint64_t, at_once * words> records;
    std::optional<Places<D>> places; // created for the first place
    std::size_t count = 0;
    const auto flush = [&] {
        if (count == 0) return;
        if (!places) places.emplace(host_, facts_, memory_, cache_bytes_);
        places->add(records.data(), count);
        count = 0;
    };
    for (std::uint32_t row = first_; row < first_ + filled_; ++row) {
        host_.poll();
        const Mark *marks = marks_.data() + std::size_t(row - first_) * raster_.width;
        for (std::uint32_t column = 0; column < raster_.width; ++column) {
            if (marks[column] != asked) continue;
            const Point<D> place = centre(row, column);
            if (extent_ && !extent_->contains(place)) continue;
            const std::int64_t id = std::int64_t(row - first_) * raster_.width + column;
            fill_record<D>(records.data() + count++ * words, id, place, nullptr, 0);
            if (count == at_once) flush();
        }
    }
    flush();
    if (!places) return;
    places->each(PlaceValue<D>(how_, values_.data()));
}

// ---- Filled by simplices ------------------------------------------------------------------

template <int D>
template <class Visit>
void ValueRaster<D>::each_page(const Box<D> &band, Visit visit) {
    const BoxRegion<D> region(band);
    if (abacus_floods_pages(facts_.standing)) {
        RangeScan<D> pages(host_, facts_, &region, pages_in<D>(how_.extent));
        while (pages.advance()) visit(pages.page());
        return;
    }
    if (!boxes_) boxes_.emplace(host_, facts_, cache_bytes_ / 8);
    PageFlood<D> pages(host_, facts_);
    boxes_->meeting(band, [&](const Key &from, const Key &to) {
        for (Key key = from; key < to; key = pages.page().upper()) {
            pages.reach(key);
            if (!pages.advance()) throw_corrupted("A page is found twice.");
            visit(pages.page());
        }
        return true;
    });
}

template <int D> void ValueRaster<D>::fill_linear() {
    const Point<D> a = centre(first_, 0), b = centre(first_ + filled_ - 1, raster_.width - 1);
    Box<D> band;
    band.extend(a);
    band.extend(b);
    each_page(band, [&](const PageView<D> &page) {
        Box<D> box;
        for (int i = 0; i < D; ++i) {
            box.lower[i] = page.box(i);
            box.upper[i] = page.box(D + i);
        }
        if (box.meets(band)) fill_from(page);
    });
}

template <int D> void ValueRaster<D>::fill_from(const PageView<D> &page) {
    for (int s = 0; s < page.simplices(); ++s)
        if (!page.is_ghost(s)) fill_from(page, s);
}

template <int D> void ValueRaster<D>::fill_from(const PageView<D> &page, int simplex) {
    const Corners<D> corners = corners_of(page, simplex);
    Box<D> box;
    for (const Point<D> *corner : corners) box.extend(*corner);
    if (D == 3 && (box.upper[2] < raster_.lower[2] || raster_.lower[2] < box.lower[2])) return;
    // Rows whose centres are between the least and the greatest y; loops correct the guess.
    const std::int64_t begin = first_, end = std::int64_t(first_) + filled_;
    const double top = latitudes_.empty() ? box.upper[1] : MapPlane::mercator(box.upper[1]);
    const double guess = (raster_.upper[1] - top) / height_ * raster_.height - 0.5;
    auto row = static_cast<std::int64_t>(
        std::clamp(guess, static_cast<double>(begin), static_cast<double>(end)));
    while (row > begin && y(row - 1) <= box.upper[1]) --row;
    while (row < end && y(row) > box.upper[1]) ++row;
    bool is_wanted = false;
    described_ = -1;
    for (; row < end && y(row) >= box.lower[1]; ++row) {
        const auto in_row = static_cast<std::uint32_t>(row);
        const Columns columns = columns_of(corners, box, centre(in_row, 0));
        if (columns.first > columns.last) continue;
        if (!is_wanted && !is_in<D>(without_polygon(how_.extent), page.region(simplex), corners))
            return;
        is_wanted = true;
        fill_row(page, simplex, in_row, columns);
    }
}

template <int D>
auto ValueRaster<D>::columns_of(const Corners<D> &corners, const Box<D> &box,
                                const Point<D> &in_row) const -> Columns {
    Bounds bounds{box.lower[0], box.upper[0]};
    for (int facet = 0; facet <= D; ++facet) restrict_by_facet<D>(corners, facet, in_row, bounds);
    const auto column_of = [&](double at) {
        const double column = (at - raster_.lower[0]) / width_ * raster_.width - 0.5;
        return static_cast<std::int64_t>(
            std::clamp(column, -1.0, static_cast<double>(raster_.width)));
    };
    const std::int64_t end = raster_.width;
    Columns columns{std::max<std::int64_t>(column_of(bounds.least), 0),
                    std::min(column_of(bounds.greatest), end - 1)};
    while (columns.first > 0 && x(columns.first - 1) >= bounds.least) --columns.first;
    while (columns.first < end && x(columns.first) < bounds.least) ++columns.first;
    while (columns.last + 1 < end && x(columns.last + 1) <= bounds.greatest) ++columns.last;
    while (columns.last >= 0 && x(columns.last) > bounds.greatest) --columns.last;
    return columns;
}

template <int D>
void ValueRaster<D>::fill_row(const PageView<D> &page, int simplex, std::uint32_t row,
                              const Columns &columns) {
    const Corners<D> corners = corners_of(page, simplex);
    std::int64_t first = columns.first, last = columns.last;
    int at_first = -1, at_last = -1;
    while (first <= last && (at_first = facets_at<D>(corners, centre(row, first))) < 0) ++first;
    if (first > last) return;
    while (first < last && (at_last = facets_at<D>(corners, centre(row, last))) < 0) --last;
    if (first == last) at_last = at_first;
    if (described_ != simplex) {
        // The code does not matter here.
        DescribedCorners<D> described;
        for (int i = 0; i <= D; ++i) {
            described.id[i] = page.id(page.corner(simplex, i));
            described.point[i] = corners[i];
        }
        const auto &order = describe(described, 0, false, simplex_);
        for (int i = 0; i <= D; ++i)
            carried_.set(i, [&](int attribute) {
                return vertex_values_.value(page, page.corner(simplex, order[i]), attribute);
            });
        described_ = simplex;
    }
    for (std::int64_t column = first; column <= last; ++column) {
        if (column % 4096 == 0) host_.poll();
        const int facets = column == first  ? at_first
                           : column == last ? at_last
                                            : at_first & at_last;
        // A vertex has one value, unless it shares its place.
        if (facets != 0 &&
            (facts_.census.split > 0 || std::popcount(static_cast<unsigned>(facets)) < D)) {
            marks_[pixel(row, column)] = asked;
            continue;
        }
        if (!may_count<D>(how_.extent, centre(row, column))) continue;
        const auto weights = barycentric_weights<D>(simplex_, centre(row, column));
        values_[pixel(row, column)] = weighted_mean(
            D + 1, [&](std::size_t i) { return weights[i]; },
            [&](std::size_t i) { return carried_.value(static_cast<int>(i), 0); });
        marks_[pixel(row, column)] = filled;
    }
}

template class ValueRaster<2>;
template class ValueRaster<3>;

} // namespace abacus
