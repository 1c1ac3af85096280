#include "query/lines/sight.hpp"

#include "geometry/line_numbers.hpp"

#include <cmath>
#include <limits>

namespace abacus {

namespace {

using exact::Rational;

/// An end of the line, and the facts about it.
struct End {
    Point<2> place;
    std::optional<Rational> ground; // the terrain's height
    std::optional<Rational> z;      // the line's; none if its ground is unknown
    double rounded = 0;             // z, rounded
    int above = 0;                  // sign of the ground's height above the line's
    double ground_above = 0;        // rounded
};

/// The terrain's height in a triangle, exactly.
Rational height_in(const abacus_simplex &simplex, const CornerValues &heights, const Point<2> &p) {
    std::array<std::array<Rational, 2>, 3> seen;
    for (int i = 0; i < 3; ++i)
        for (int axis = 0; axis < 2; ++axis)
            seen[i][axis] = Rational(simplex.corner[i][axis]) - Rational(p[axis]);
    Rational sum = 0, whole = 0;
    for (int i = 0; i < 3; ++i) {
        const auto &a = seen[(i + 1) % 3], &b = seen[(i + 2) % 3];
        const Rational weight = a[0] * b[1] - a[1] * b[0];
        if (weight == 0) continue; // its height does not count
        sum += weight * Rational(heights.value(i, 0));
        whole += weight;
    }
    return sum / whole;
}

/// Whether all corners that count at p have a finite height.
bool has_height(const abacus_simplex &simplex, const CornerValues &heights, const Point<2> &p) {
    const auto corner = [&](int i) { return Point<2>{simplex.corner[i][0], simplex.corner[i][1]}; };
    for (int i = 0; i < 3; ++i)
        if (orientation(corner((i + 1) % 3), corner((i + 2) % 3), p) != 0 &&
            !std::isfinite(heights.value(i, 0)))
            return false;
    return true;
}

class LineOfSight {
public:
    LineOfSight(Reader<2> &reader, std::uint32_t attribute, const abacus_extent &extent,
                const abacus_sight_end &observer, const abacus_sight_end &target)
        : reader_(reader), attribute_(attribute), extent_(extent), from_(find(observer)),
          to_(find(target)) {}

    abacus_sight look();

private:
    /// How far the ground is above the line at a parameter of the line; negative if it is below.
    struct Sample {
        double at, above;
    };

    End find(const abacus_sight_end &given);
    /// Whether the ground is above the line there; false if its height is unknown.
    bool is_above(const Line<2> &line, const Crossing<2> &crossing, std::optional<Sample> &sample);
    /// Goes to the next place; returns whether the line is blocked there, or since the last place.
    bool is_blocked(const std::optional<Sample> &sample, bool is_above);
    abacus_sight blocked_at(double parameter) const;
    abacus_sight look_along(const Line<2> &line);

    Reader<2> &reader_;
    const std::uint32_t attribute_;
    const abacus_extent extent_;
    const End from_, to_;
    std::optional<Sample> last_; // in the same triangle as the next one
    double blocked_ = 0;         // the parameter where it is blocked
};

End LineOfSight::find(const abacus_sight_end &given) {
    End end{{given.place[0] + 0.0, given.place[1] + 0.0}, {}, {}, 0, 0, 0};
    abacus_simplex simplex;
    CornerValues heights(&attribute_, 1);
    if (reader_.locate(end.place, simplex, &heights, extent_) &&
        has_height(simplex, heights, end.place))
        end.ground = height_in(simplex, heights, end.place);
    if (!given.stands)
        end.z = Rational(given.height);
    else if (end.ground)
        end.z = *end.ground + Rational(given.height);
    if (!end.z) return end;
    end.rounded = CGAL::to_double(*end.z);
    if (end.ground) {
        const Rational above = *end.ground - *end.z;
        end.above = CGAL::sign(above);
        end.ground_above = CGAL::to_double(above);
    }
    return end;
}

abacus_sight LineOfSight::blocked_at(double at) const {
    abacus_sight sight{ABACUS_SIGHT_BLOCKED, {}};
    for (int axis = 0; axis < 2; ++axis)
        sight.place[axis] = from_.place[axis] * (1 - at) + to_.place[axis] * at;
    sight.place[2] = from_.rounded * (1 - at) + to_.rounded * at;
    return sight;
}

abacus_sight LineOfSight::look() {
    if (!from_.z || !to_.z) return {ABACUS_SIGHT_UNKNOWN, {}};
    if (from_.above > 0) return blocked_at(0);
    if (!(from_.place == to_.place)) return look_along(Line<2>::between(from_.place, to_.place));
    if (to_.above <= 0) return {ABACUS_SIGHT_FREE, {}};
    // Straight down, to the ground.
    return {ABACUS_SIGHT_BLOCKED, {to_.place[0], to_.place[1], CGAL::to_double(*to_.ground)}};
}

bool LineOfSight::is_above(const Line<2> &line, const Crossing<2> &crossing,
                           std::optional<Sample> &sample) {
    sample.reset();
    double least = INFINITY, greatest = -INFINITY;
    for (int i = 0; i < 2; ++i) {
        if (crossing.weight[i] == 0) continue;
        if (!std::isfinite(crossing.value[i])) return false;
        least = std::min(least, crossing.value[i]);
        greatest = std::max(greatest, crossing.value[i]);
    }
    const double rise = to_.rounded - from_.rounded, z = from_.rounded + crossing.at * rise;
    const double above = crossing.mean() - z;
    sample = Sample{crossing.at, above};
    constexpr double underflow = std::numeric_limits<double>::min(); // far more than all of it
    const double error = 1e-8 * (greatest - least) + crossing.error * std::fabs(rise) +
                         1e-14 * (std::fabs(least) + std::fabs(greatest) +
                                  std::fabs(from_.rounded) + std::fabs(to_.rounded)) +
                         underflow;
    if (std::fabs(above) > error) return above > 0;
    if (crossing.corner[0] == crossing.corner[1]) return false; // the border of a polygon
    const auto weights = exact::facet_weights<2>(line, [&](int i) { return crossing.corner[i]; });
    Rational sum = 0, whole = 0;
    for (int i = 0; i < 2; ++i) {
        if (crossing.weight[i] == 0) continue;
        sum += weights[i] * Rational(crossing.value[i]);
        whole += weights[i];
    }
    const Rational at = exact::parameter_at<2>(line, crossing.corner);
    return sum / whole > *from_.z + at * (*to_.z - *from_.z);
}

bool LineOfSight::is_blocked(const std::optional<Sample> &sample, bool is_above) {
    if (is_above) {
        blocked_ = sample->at;
        if (last_ && sample->above > 0) { // from a place where the ground is not above the line
            const double below = std::max(0.0, -last_->above);
            blocked_ = last_->at + (sample->at - last_->at) * (below / (below + sample->above));
        }
        return true;
    }
    last_ = sample;
    return false;
}

abacus_sight LineOfSight::look_along(const Line<2> &line) {
    bool is_hidden = false, ends_inside = false;
    if (from_.ground) last_ = Sample{0, from_.ground_above};
    LineScan<2> scan(reader_, line, static_cast<int>(attribute_), extent_);
    scan.each([&](const LinePiece<2> &piece) {
        const auto passes = [&](const Crossing<2> &crossing) {
            std::optional<Sample> sample;
            const bool above = is_above(line, crossing, sample);
            is_hidden = is_blocked(sample, above);
        };
        if ((!piece.follows || piece.jumps) && !piece.enters.is_end) {
            last_.reset(); // nothing blocks before
            passes(piece.enters);
        }
        ends_inside = piece.leaves.is_end;
        if (!is_hidden && !ends_inside) passes(piece.leaves);
        return !is_hidden;
    });
    if (!is_hidden && to_.above > 0) {
        if (!ends_inside) last_.reset();
        is_hidden = is_blocked(Sample{1, to_.ground_above}, true);
    }
    return is_hidden ? blocked_at(blocked_) : abacus_sight{ABACUS_SIGHT_FREE, {}};
}

} // namespace

abacus_sight look(Reader<2> &reader, std::uint32_t attribute, const abacus_sight_end &observer,
                  const abacus_sight_end &target, const abacus_extent &extent) {
    return LineOfSight(reader, attribute, extent, observer, target).look();
}

} // namespace abacus
