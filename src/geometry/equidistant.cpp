#include "geometry/equidistant.hpp"

#include "geometry/linear_solution.hpp"

namespace abacus {

/// In doubles relative to the first point, in rational numbers in the mesh's coordinates.
template <int D> template <class T> auto Equidistant<D>::system(bool is_seen_from_first) const {
    LinearSystem<T, D> system;
    const Point<D> &first = *points_[0];
    int row = 0;
    for (int i = 1; i < count_; ++i, ++row) {
        T half = T(0);
        for (int axis = 0; axis < D; ++axis) {
            const T from = T(first[axis]), to = T((*points_[i])[axis]);
            system.matrix[row][axis] = to - from;
            const T twice_middle = is_seen_from_first ? T(to - from) : T(to + from);
            half += system.matrix[row][axis] * twice_middle;
        }
        system.right[row] = half / T(2);
    }
    for (int i = 0; i < side_count_; ++i, ++row) {
        system.matrix[row].fill(T(0));
        system.matrix[row][sides_[i].axis] = T(1);
        system.right[row] = T(sides_[i].value);
        if (is_seen_from_first) system.right[row] -= T(first[sides_[i].axis]);
    }
    return system;
}

template <int D> std::optional<Point<D>> Equidistant<D>::place(Rounding rounding) {
    std::sort(points_.begin(), points_.begin() + count_,
              [](const auto *a, const auto *b) { return lexicographically_less<D>(*a, *b); });
    std::sort(sides_.begin(), sides_.begin() + side_count_,
              [](const Side &a, const Side &b) { return a.axis < b.axis; });
    std::optional<Point<D>> place;
    if (rounding == Rounding::whenever) {
        const auto seen = system<double>(true);
        // Halves of squares of distances, which must not underflow.
        if (std::all_of(seen.right.begin(), seen.right.begin() + (count_ - 1),
                        [](double half) { return half > 1e-250; }))
            place = solve_in_doubles<D>(seen);
    }
    if (place)
        for (int axis = 0; axis < D; ++axis) (*place)[axis] += (*points_[0])[axis];
    else
        place = solve_exactly<D>(system<CGAL::Exact_rational>(false));
    if (!place) return place;
    constexpr double most = std::numeric_limits<double>::max();
    for (double &x : *place) x = std::clamp(x, -most, most);
    for (int i = 0; i < side_count_; ++i) (*place)[sides_[i].axis] = sides_[i].value;
    return place;
}

template <int D>
Point<D> circumcentre(const std::array<const Point<D> *, D + 1> &corners, Rounding rounding) {
    Equidistant<D> centre;
    for (const Point<D> *corner : corners) centre.add(*corner);
    const std::optional<Point<D>> place = centre.place(rounding);
    if (!place) throw_corrupted("A simplex is flat.");
    return *place;
}

template class Equidistant<2>;
template class Equidistant<3>;
template Point<2> circumcentre<2>(const std::array<const Point<2> *, 3> &, Rounding);
template Point<3> circumcentre<3>(const std::array<const Point<3> *, 4> &, Rounding);

} // namespace abacus
