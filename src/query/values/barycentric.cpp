#include "query/values/barycentric.hpp"

#include "geometry/linear_system.hpp"
#include "geometry/rational.hpp"
#include "host/error.hpp"

namespace abacus::exact {

template <int D>
void settle(CornerVolumes<D> &volumes, const abacus_simplex &simplex, const Point<D> &p) {
    std::array<Point<D>, D + 1> points;
    Corners<D> corners;
    for (int i = 0; i <= D; ++i) {
        std::copy_n(simplex.corner[i], D, points[i].begin());
        corners[i] = &points[i];
    }
    for (int i = 0; i <= D; ++i) {
        if (volumes.is_sure(i)) continue;
        double &volume = volumes.volume[i];
        volume = facet_side<D>(corners, i, p) > 0 ? std::max(volume, least_weight) : 0;
    }
}

template <int D>
std::array<double, D + 1> barycentric_weights(const abacus_simplex &simplex, const Point<D> &p) {
    std::array<std::array<Rational, D>, D + 1> seen;
    for (int i = 0; i <= D; ++i)
        for (int axis = 0; axis < D; ++axis)
            seen[i][axis] = Rational(simplex.corner[i][axis]) - Rational(p[axis]);
    std::array<Rational, D + 1> volumes;
    Rational sum = 0;
    for (int i = 0; i <= D; ++i) {
        typename LinearSystem<Rational, D>::Matrix facet;
        for (int k = 0; k < D; ++k) facet[k] = seen[(i + 1 + k) % (D + 1)];
        volumes[i] = LinearSystem<Rational, D>::determinant(facet);
        if (D == 3 && i % 2 != 0) volumes[i] = -volumes[i];
        if (volumes[i] < 0) volumes[i] = 0; // beyond the facet
        sum += volumes[i];
    }
    if (sum == 0) throw_corrupted("A simplex is flat.");
    std::array<double, D + 1> weights{};
    for (int i = 0; i <= D; ++i)
        if (volumes[i] > 0)
            weights[i] = std::max(nearest_double(Rational(volumes[i] / sum)), least_weight);
    return weights;
}

template void settle<2>(CornerVolumes<2> &, const abacus_simplex &, const Point<2> &);
template void settle<3>(CornerVolumes<3> &, const abacus_simplex &, const Point<3> &);
template std::array<double, 3> barycentric_weights<2>(const abacus_simplex &, const Point<2> &);
template std::array<double, 4> barycentric_weights<3>(const abacus_simplex &, const Point<3> &);

} // namespace abacus::exact
