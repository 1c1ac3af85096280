#include "geometry/line.hpp"

#include "geometry/facet_order.hpp"
#include "geometry/line_numbers.hpp"

#include <algorithm>
#include <numeric>

namespace abacus {

namespace {

/// Weights have at least ten digits; else they are computed in rational numbers.
constexpr double most_error = 1e-10;

/// The values of line_side() for a few points: for each point in the plane, for each pair in space.
template <int D, int N> class Sides {
public:
    Sides(const Line<D> &line, const std::array<const Point<D> *, N> &points) {
        if constexpr (D == 2) {
            for (int i = 0; i < N; ++i) sides_[i] = line_side(line, *points[i]);
        } else {
            for (int i = 0; i < N; ++i)
                for (int j = i + 1; j < N; ++j) {
                    sides_[i * N + j] = line_side(line, *points[i], *points[j]);
                    sides_[j * N + i] = {-sides_[i * N + j].value, sides_[i * N + j].error};
                }
        }
    }

    /// The weights of a facet of these points.
    std::array<Estimate, D> weights(const std::array<int, D> &facet) const {
        if constexpr (D == 2) {
            const Estimate &a = sides_[facet[0]], &b = sides_[facet[1]];
            return {b, {-a.value, a.error}};
        } else {
            const auto [a, b, c] = facet;
            return {sides_[c * N + b], sides_[a * N + c], sides_[b * N + a]};
        }
    }

private:
    std::array<Estimate, D == 2 ? N : N * N> sides_;
};

/// The sum of numbers that are not negative, the same in whatever order they come.
template <std::size_t n> double sum_of(std::array<double, n> numbers) {
    std::sort(numbers.begin(), numbers.end());
    return std::accumulate(numbers.begin(), numbers.end(), 0.0);
}

/// Sets weights with the sum 1, in rational numbers if need be.
template <int D, class Get>
void set_weights(FacetPlace<D> &place, const Line<D> &line,
                 const std::array<Estimate, D> &estimates, Get point) {
    std::array<double, D> sizes, errors;
    for (int i = 0; i < D; ++i) {
        sizes[i] = std::fabs(estimates[i].value);
        errors[i] = estimates[i].error;
    }
    const double sum = sum_of(sizes);
    place.error = 2 * sum_of(errors) / sum + 1e-15;
    if (place.error <= most_error && std::isfinite(sum)) [[likely]] {
        for (int i = 0; i < D; ++i) place.weight[i] = sizes[i] / sum;
    } else {
        const auto exact = exact::facet_weights<D>(line, point);
        exact::Rational whole = 0;
        for (const auto &weight : exact) whole += weight;
        for (int i = 0; i < D; ++i)
            place.weight[i] = exact::nearest_double(exact::Rational(exact[i] / whole));
        place.error = 1e-15;
    }
    // A corner that has a weight keeps one, and a corner without weight gets none.
    for (int i = 0; i < D; ++i)
        place.weight[i] = estimates[i].value == 0
                              ? 0
                              : std::max(place.weight[i], std::numeric_limits<double>::min());
}

} // namespace

template <int D> Line<D> Line<D>::between(const Point<D> &from, const Point<D> &to) {
    Line line{from, {}, to, to, 0};
    for (int i = 0; i < D; ++i) {
        line.direction[i] = to[i] - from[i];
        if (std::fabs(line.direction[i]) > std::fabs(line.direction[line.axis])) line.axis = i;
    }
    return line;
}

template <int D> Line<D> Line<D>::towards(const Point<D> &from, const Point<D> &direction) {
    Line line{from, direction, {}, {}, 0};
    Point<D> second;
    bool is_exact = true;
    for (int i = 0; i < D; ++i) {
        if (std::fabs(direction[i]) > std::fabs(direction[line.axis])) line.axis = i;
        const double sum = from[i] + direction[i], back = sum - from[i]; // Knuth's TwoSum
        is_exact &= (from[i] - (sum - back)) + (direction[i] - back) == 0;
        second[i] = sum;
    }
    if (is_exact) line.second = second;
    return line;
}

template <int D> double Line<D>::along(const Point<D> &p) const {
    const double part = (p[axis] - from[axis]) / direction[axis];
    if (std::isfinite(part) && std::isfinite(direction[axis])) [[likely]]
        return part;
    const double whole = to ? (*to)[axis] / 4 - from[axis] / 4 : direction[axis] / 4;
    return (p[axis] / 4 - from[axis] / 4) / whole;
}

template <int D> std::optional<Passage<D>> passage(const Line<D> &line, const Corners<D> &corners) {
    constexpr const auto &facets = facet_order<D>;
    const Sides<D, D + 1> sides(line, corners);
    std::array<Estimate, D> in, out;
    Passage<D> passage;
    for (int facet = 0; facet <= D; ++facet) {
        const auto weights = sides.weights(facets[facet]);
        bool has_positive = false, has_negative = false;
        for (const Estimate &weight : weights) {
            has_positive |= weight.value > 0;
            has_negative |= weight.value < 0;
        }
        if (has_positive == has_negative) continue;
        (has_positive ? passage.leaves : passage.enters).facet = facet;
        (has_positive ? out : in) = weights;
    }
    if (passage.leaves.facet < 0 || passage.enters.facet < 0) return std::nullopt;
    const auto fill = [&](FacetPlace<D> &place, const std::array<Estimate, D> &weights) {
        place.corner = facets[place.facet];
        set_weights<D>(place, line, weights,
                       [&](int i) -> const Point<D> & { return *corners[place.corner[i]]; });
    };
    fill(passage.enters, in);
    fill(passage.leaves, out);
    if (passage.enters.face() == passage.leaves.face()) return std::nullopt;
    return passage;
}

template <int D>
bool meets_facet(const Line<D> &line, const std::array<const Point<D> *, D> &facet,
                 FacetPlace<D> &place, unsigned choice, int &ridge) {
    for (int i = 0; i < D; ++i) place.corner[i] = i;
    const auto estimates = Sides<D, D>(line, facet).weights(place.corner);
    int passed[D];
    unsigned count = 0;
    for (int i = 0; i < D; ++i)
        if (estimates[i].value < 0) passed[count++] = i;
    if (count > 0) {
        ridge = passed[choice % count];
        return false;
    }
    set_weights<D>(place, line, estimates, [&](int i) -> const Point<D> & { return *facet[i]; });
    return true;
}

namespace exact {

int line_side(const Line<2> &line, const Point<2> &a) {
    if (line.second) return orientation(line.from, *line.second, a);
    return CGAL::sign(line_side_value<2>(line, a, a));
}

int line_side(const Line<3> &line, const Point<3> &a, const Point<3> &b) {
    if (line.second) return -orientation(*line.second, a, b, line.from);
    return CGAL::sign(line_side_value<3>(line, a, b));
}

template <int D> double parameter(const Line<D> &line, const std::array<Point<D>, D> &facet) {
    return nearest_double(parameter_at<D>(line, facet));
}

template <int D>
int compare_along(const Line<D> &line, const std::array<Point<D>, D> &a,
                  const std::array<Point<D>, D> &b) {
    return CGAL::compare(parameter_at<D>(line, a), parameter_at<D>(line, b));
}

template double parameter<2>(const Line<2> &, const std::array<Point<2>, 2> &);
template double parameter<3>(const Line<3> &, const std::array<Point<3>, 3> &);
template int compare_along<2>(const Line<2> &, const std::array<Point<2>, 2> &,
                              const std::array<Point<2>, 2> &);
template int compare_along<3>(const Line<3> &, const std::array<Point<3>, 3> &,
                              const std::array<Point<3>, 3> &);

} // namespace exact

template struct Line<2>;
template struct Line<3>;
template std::optional<Passage<2>> passage<2>(const Line<2> &, const Corners<2> &);
template std::optional<Passage<3>> passage<3>(const Line<3> &, const Corners<3> &);
template bool meets_facet<2>(const Line<2> &, const std::array<const Point<2> *, 2> &,
                             FacetPlace<2> &, unsigned, int &);
template bool meets_facet<3>(const Line<3> &, const std::array<const Point<3> *, 3> &,
                             FacetPlace<3> &, unsigned, int &);

} // namespace abacus
