#include "geometry/misfit.hpp"

#include "geometry/rational.hpp"

namespace abacus::exact {

namespace {

int sign_of(const Rational &x) { return (x > 0) - (x < 0); }

template <int D> using Matrix = typename LinearSystem<Rational, D>::Matrix;

template <int D> std::array<Rational, D> seen(const Point<D> &p, const Point<D> &from) {
    std::array<Rational, D> way;
    for (int axis = 0; axis < D; ++axis) way[axis] = Rational(p[axis]) - Rational(from[axis]);
    return way;
}

template <int D> Rational magnitude(const Matrix<D> &matrix) {
    return CGAL::abs(LinearSystem<Rational, D>::determinant(matrix));
}

template <int D> Rational volume(const Piece<D> &piece) {
    Matrix<D> edges;
    for (int i = 0; i < D; ++i) edges[i] = seen<D>(piece.corner[i + 1], piece.corner[0]);
    return magnitude<D>(edges);
}

template <int D> Rational lifted_volume(const Piece<D> &piece, const Point<D> &p, double value) {
    std::array<std::array<Rational, D>, D + 1> corner;
    for (int i = 0; i <= D; ++i) corner[i] = seen<D>(piece.corner[i], p);
    Rational sum = 0;
    for (int i = 0; i <= D; ++i) {
        Matrix<D> others;
        for (int row = 0; row < D; ++row) others[row] = corner[row + (row >= i)];
        const Rational term = (Rational(piece.value[i]) - Rational(value)) *
                              LinearSystem<Rational, D>::determinant(others);
        if (i % 2 == 0)
            sum += term;
        else
            sum -= term;
    }
    return CGAL::abs(sum);
}

template <int D> Rational height_over(const std::array<Point<D>, D> &facet, const Point<D> &p) {
    Matrix<D> matrix;
    for (int i = 0; i < D; ++i) matrix[i] = seen<D>(facet[i], p);
    return magnitude<D>(matrix);
}

Rational squared_distance(const Point<3> &a, const Point<3> &b, const Point<3> &p) {
    const auto line = seen<3>(b, a), way = seen<3>(p, a);
    Rational sum = 0;
    for (int i = 0; i < 3; ++i) {
        const int j = (i + 1) % 3;
        const Rational part = line[i] * way[j] - line[j] * way[i];
        sum += part * part;
    }
    return sum;
}

} // namespace

template <int D>
int compare_misfit(const Piece<D> &piece, const Point<D> &p, double value, double bound) {
    return sign_of(
        Rational(lifted_volume<D>(piece, p, value) - Rational(bound) * volume<D>(piece)));
}

template <int D>
int compare_misfits(const Piece<D> &piece, const Point<D> &p, double value,
                    const Piece<D> &other_piece, const Point<D> &other_p, double other_value) {
    return sign_of(
        Rational(lifted_volume<D>(piece, p, value) * volume<D>(other_piece) -
                 lifted_volume<D>(other_piece, other_p, other_value) * volume<D>(piece)));
}

template <int D> double misfit(const Piece<D> &piece, const Point<D> &p, double value) {
    return nearest_double(Rational(lifted_volume<D>(piece, p, value) / volume<D>(piece)));
}

template <int D>
int compare_heights(const std::array<Point<D>, D> &facet, const Point<D> &p, const Point<D> &q) {
    return sign_of(Rational(height_over<D>(facet, p) - height_over<D>(facet, q)));
}

int compare_distances(const Point<3> &a, const Point<3> &b, const Point<3> &p, const Point<3> &q) {
    return sign_of(Rational(squared_distance(a, b, p) - squared_distance(a, b, q)));
}

template int compare_misfit<2>(const Piece<2> &, const Point<2> &, double, double);
template int compare_misfit<3>(const Piece<3> &, const Point<3> &, double, double);
template int compare_misfits<2>(const Piece<2> &, const Point<2> &, double, const Piece<2> &,
                                const Point<2> &, double);
template int compare_misfits<3>(const Piece<3> &, const Point<3> &, double, const Piece<3> &,
                                const Point<3> &, double);
template double misfit<2>(const Piece<2> &, const Point<2> &, double);
template double misfit<3>(const Piece<3> &, const Point<3> &, double);
template int compare_heights<2>(const std::array<Point<2>, 2> &, const Point<2> &,
                                const Point<2> &);
template int compare_heights<3>(const std::array<Point<3>, 3> &, const Point<3> &,
                                const Point<3> &);

} // namespace abacus::exact
