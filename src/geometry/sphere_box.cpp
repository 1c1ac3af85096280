#include "geometry/sphere_box.hpp"

#include "geometry/sphere_intervals.hpp"

namespace abacus {

namespace {

using intervals::cross, intervals::determinant, intervals::Interval, intervals::squared,
    intervals::Vector;

/// From the corner where a simplex's edges start to the centre of its circumsphere: formulas 2.1
/// and 2.2 of the dissertation, and the same in space.
Vector<2> to_centre(const std::array<Vector<2>, 2> &edges) {
    const auto &[b, c] = edges;
    const Interval bb = squared(b), cc = squared(c);
    const Interval twice = 2 * determinant(b[0], b[1], c[0], c[1]);
    return {determinant(bb, b[1], cc, c[1]) / twice, determinant(b[0], bb, c[0], cc) / twice};
}
Vector<3> to_centre(const std::array<Vector<3>, 3> &edges) {
    const auto &[b, c, d] = edges;
    const Vector<3> cd = cross(c, d), db = cross(d, b), bc = cross(b, c);
    const Interval bb = squared(b), cc = squared(c), dd = squared(d);
    const Interval twice = 2 * (b[0] * cd[0] + b[1] * cd[1] + b[2] * cd[2]);
    Vector<3> centre;
    for (int k = 0; k < 3; ++k) centre[k] = (bb * cd[k] + cc * db[k] + dd * bc[k]) / twice;
    return centre;
}

/// The same of a facet, to the centre of the least ball that has its corners on the border.
Vector<2> to_centre_of_facet(const std::array<Vector<2>, 1> &edges) {
    return {edges[0][0] / 2, edges[0][1] / 2};
}
Vector<3> to_centre_of_facet(const std::array<Vector<3>, 2> &edges) {
    const auto &[b, c] = edges;
    const Vector<3> n = cross(b, c), nb = cross(n, b), cn = cross(c, n);
    const Interval bb = squared(b), cc = squared(c), twice = 2 * squared(n);
    Vector<3> centre;
    for (int k = 0; k < 3; ++k) centre[k] = (cc * nb[k] + bb * cn[k]) / twice;
    return centre;
}

/// The N edges from the first corner of a simplex.
template <int D, std::size_t N>
std::array<Vector<D>, N> edges_of(const std::array<const Point<D> *, D + 1> &corners) {
    std::array<Vector<D>, N> edges;
    for (std::size_t i = 0; i < N; ++i)
        for (int k = 0; k < D; ++k) edges[i][k] = Interval((*corners[i + 1])[k]) - (*corners[0])[k];
    return edges;
}

template <int D> Box<D> ball_box(const Point<D> &corner, const Vector<D> &to_centre) {
    const Interval radius = sqrt(squared(to_centre));
    Box<D> box;
    for (int k = 0; k < D; ++k) {
        const Interval at = to_centre[k] + corner[k];
        box.lower[k] = (at - radius).inf();
        box.upper[k] = (at + radius).sup();
    }
    return box;
}

} // namespace

template <int D> Box<D> sphere_box(const std::array<const Point<D> *, D + 1> &corners) {
    const Interval::Protector rounding;
    return ball_box<D>(*corners[0], to_centre(edges_of<D, D>(corners)));
}

template <int D> Box<D> facet_ball_box(const std::array<const Point<D> *, D + 1> &corners) {
    const Interval::Protector rounding;
    return ball_box<D>(*corners[0], to_centre_of_facet(edges_of<D, D - 1>(corners)));
}

template Box<2> sphere_box<2>(const std::array<const Point<2> *, 3> &);
template Box<3> sphere_box<3>(const std::array<const Point<3> *, 4> &);
template Box<2> facet_ball_box<2>(const std::array<const Point<2> *, 3> &);
template Box<3> facet_ball_box<3>(const std::array<const Point<3> *, 4> &);

} // namespace abacus
