// The exact ends of the predicates.
//
// The filters fail most often on grids and octrees, since so many of their points are
// cospherical. These points differ by small multiples of one unit, so 128-bit integers
// hold the determinant. All others go to CGAL's filtered kernel (LGPL): interval
// arithmetic first, then exact numbers.
#include "geometry/predicates.hpp"

#include "geometry/cgal_points.hpp"
#include "geometry/linear_system.hpp"
#include "geometry/rational.hpp"

#include <optional>

namespace abacus::exact {

namespace {

using Wide = __int128;

template <class T> int sign(const T &value) { return (value > 0) - (value < 0); }

/// The points' differences from the origins, one for each, as integers in a common unit, if they
/// are exact and have at most `bits` bits.
template <int D, std::size_t N>
std::optional<std::array<std::array<std::int64_t, D>, N>>
differences(const std::array<const Point<D> *, N> &points,
            const std::array<const Point<D> *, N> &origins, int bits) {
    std::array<std::array<double, D>, N> difference;
    double largest = 0, rounded = 0;
    for (std::size_t n = 0; n < N; ++n)
        for (int axis = 0; axis < D; ++axis) {
            const double a = (*points[n])[axis], b = (*origins[n])[axis], d = a - b;
            const double rest = a - d; // what the subtraction rounded off (Knuth's TwoSum)
            rounded += std::fabs((a - (d + rest)) + (rest - b));
            largest = std::max(largest, std::fabs(d));
            difference[n][axis] = d;
        }
    if (!(rounded == 0 && largest > 1e-250 && largest < 1e250)) return std::nullopt;
    const double scale = std::ldexp(1.0, bits - 1 - std::ilogb(largest)), unit = 1 / scale;
    std::array<std::array<std::int64_t, D>, N> result;
    for (std::size_t n = 0; n < N; ++n)
        for (int axis = 0; axis < D; ++axis) {
            const double d = difference[n][axis];
            result[n][axis] = static_cast<std::int64_t>(d * scale);
            // Compared with d, not with d * scale, which underflows to 0 where d is far smaller
            // than the largest.
            if (static_cast<double>(result[n][axis]) * unit != d) return std::nullopt;
        }
    return result;
}

/// The same from one origin.
template <int D, std::size_t N>
auto differences(const std::array<const Point<D> *, N> &points, const Point<D> &origin, int bits) {
    std::array<const Point<D> *, N> origins;
    origins.fill(&origin);
    return differences<D, N>(points, origins, bits);
}

Wide determinant(const std::array<std::array<std::int64_t, 3>, 3> &rows) {
    const auto &[u, v, w] = rows;
    return Wide(u[2]) * (v[0] * w[1] - v[1] * w[0]) + Wide(v[2]) * (w[0] * u[1] - w[1] * u[0]) +
           Wide(w[2]) * (u[0] * v[1] - u[1] * v[0]);
}

/// Sign of the determinant of in_sphere(), positive inside, if integers are large enough for it.
std::optional<int> integer_in_sphere(const Corners<2> &corners, const Point<2> &p) {
    const auto d = differences<2, 3>(corners, p, 30);
    if (!d) return std::nullopt;
    const auto [a, b, c] = *d;
    const auto lift = [](const auto &v) { return Wide(v[0] * v[0] + v[1] * v[1]); };
    return sign(lift(a) * (b[0] * c[1] - b[1] * c[0]) + lift(b) * (c[0] * a[1] - c[1] * a[0]) +
                lift(c) * (a[0] * b[1] - a[1] * b[0]));
}

std::optional<int> integer_in_sphere(const Corners<3> &corners, const Point<3> &p) {
    const auto difference = differences<3, 4>(corners, p, 24); // the determinant: 127 bits
    if (!difference) return std::nullopt;
    const auto [a, b, c, d] = *difference;
    const auto lift = [](const auto &v) { return v[0] * v[0] + v[1] * v[1] + v[2] * v[2]; };
    const auto minor = [](const auto &v, const auto &w) { return v[0] * w[1] - w[0] * v[1]; };
    const std::int64_t ab = minor(a, b), bc = minor(b, c), cd = minor(c, d), da = minor(d, a),
                       ac = minor(a, c), bd = minor(b, d);
    const Wide abc = Wide(a[2]) * bc - Wide(b[2]) * ac + Wide(c[2]) * ab;
    const Wide bcd = Wide(b[2]) * cd - Wide(c[2]) * bd + Wide(d[2]) * bc;
    const Wide cda = Wide(c[2]) * da + Wide(d[2]) * ac + Wide(a[2]) * cd;
    const Wide dab = Wide(d[2]) * ab + Wide(a[2]) * bd + Wide(b[2]) * da;
    return -sign((lift(d) * abc - lift(c) * dab) + (lift(b) * cda - lift(a) * bcd));
}

/// Position of p relative to the sphere through the first N corners, on which it lies.
/// Infinitesimals lift the points, the lexicographically largest point by the largest. The sign is
/// that of the first coefficient in this order that is not zero. For p itself this is the sign of
/// the positive simplex, negated; for a corner it is the sign of the simplex with p in its place,
/// which `orientation` returns.
template <int D, int N, class Orientation>
int perturbed_sign(const Corners<D> &corners, const Point<D> &p, Orientation orientation) {
    const auto point = [&](int i) -> const Point<D> & { return i < N ? *corners[i] : p; };
    std::array<bool, N> passed{};
    for (;;) {
        int greatest = N;
        for (int i = 0; i < N; ++i)
            if (!passed[i] && lexicographically_less<D>(point(greatest), point(i))) greatest = i;
        if (greatest == N) return -1;
        Corners<D> replaced = corners;
        replaced[greatest] = &p;
        if (const int sign = orientation(replaced)) return sign;
        passed[greatest] = true;
    }
}

} // namespace

// Two equal points are the commonest case when a vertex is looked up: a walk ends there.

int orientation(const Point<2> &a, const Point<2> &b, const Point<2> &c) {
    if (a == b || b == c || c == a) return 0;
    if (const auto d = differences<2, 2>({&a, &b}, c, 31))
        return sign((*d)[0][0] * (*d)[1][1] - (*d)[0][1] * (*d)[1][0]);
    return Kernel().orientation_2_object()(cgal(a), cgal(b), cgal(c));
}

int orientation(const Point<3> &a, const Point<3> &b, const Point<3> &c, const Point<3> &d) {
    if (a == b || a == c || a == d || b == c || b == d || c == d) return 0;
    if (const auto difference = differences<3, 3>({&a, &b, &c}, d, 31))
        return -sign(determinant(*difference));
    return Kernel().orientation_3_object()(cgal(a), cgal(b), cgal(c), cgal(d));
}

int side_of_parallel(const Point<3> &a, const Point<3> &b, const Point<3> &c, const Point<3> &d,
                     const Point<3> &p) {
    // Neighbours in meshes have common points: then the plane contains three points.
    if (p == a || p == b) return 0;
    if (p == c || a == c || b == c) return abacus::orientation(a, b, d, p);
    if (p == d || a == d || b == d) return -abacus::orientation(a, b, c, p);
    const std::array<const Point<3> *, 3> ends{&b, &d, &p}, begins{&a, &c, &a};
    if (const auto difference = differences<3, 3>(ends, begins, 31))
        return sign(determinant(*difference));
    LinearSystem<Rational, 3>::Matrix rows;
    for (int i = 0; i < 3; ++i)
        for (int axis = 0; axis < 3; ++axis)
            rows[i][axis] = Rational((*ends[i])[axis]) - Rational((*begins[i])[axis]);
    const Rational value = LinearSystem<Rational, 3>::determinant(rows);
    return sign(value);
}

template <int D> int unperturbed_in_sphere(const Corners<D> &c, const Point<D> &p) {
    if (const auto sign = integer_in_sphere(c, p)) return *sign;
    if constexpr (D == 2)
        return Kernel().side_of_oriented_circle_2_object()(cgal(*c[0]), cgal(*c[1]), cgal(*c[2]),
                                                           cgal(p));
    else
        return Kernel().side_of_oriented_sphere_3_object()(cgal(*c[0]), cgal(*c[1]), cgal(*c[2]),
                                                           cgal(*c[3]), cgal(p));
}

template <int D> int in_sphere(const Corners<D> &corners, const Point<D> &p) {
    const int side = unperturbed_in_sphere<D>(corners, p);
    if (side != 0) return side;
    for (const Point<D> *corner : corners)
        if (*corner == p) return 0;

    return perturbed_sign<D, D + 1>(
        corners, p, [](const Corners<D> &replaced) { return abacus::orientation<D>(replaced); });
}

int in_hull_facet(const Corners<3> &corners, const Point<3> &p) {
    const auto coplanar_orientation = [](const Corners<3> &c) {
        return static_cast<int>(
            Kernel().coplanar_orientation_3_object()(cgal(*c[0]), cgal(*c[1]), cgal(*c[2])));
    };
    const int side = Kernel().coplanar_side_of_bounded_circle_3_object()(
        cgal(*corners[0]), cgal(*corners[1]), cgal(*corners[2]), cgal(p));
    if (side != 0) return side;
    for (int i = 0; i < 3; ++i)
        if (*corners[i] == p) return 0;

    // On the circle: areas in the plane for volumes. Their sign depends on the side from
    // which the plane is seen, hence the product.
    const int facing = coplanar_orientation(corners);
    return perturbed_sign<3, 3>(corners, p, [&](const Corners<3> &replaced) {
        return coplanar_orientation(replaced) * facing;
    });
}

template int unperturbed_in_sphere<2>(const Corners<2> &, const Point<2> &);
template int unperturbed_in_sphere<3>(const Corners<3> &, const Point<3> &);
template int in_sphere<2>(const Corners<2> &, const Point<2> &);
template int in_sphere<3>(const Corners<3> &, const Point<3> &);

} // namespace abacus::exact
