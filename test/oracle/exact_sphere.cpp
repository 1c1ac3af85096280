#include "exact_sphere.hpp"

#include <cmath>

namespace abacus::oracle {
namespace {

/// A product N of primes 4k + 1 is a sum of two squares in 2^primes ways (times four for the
/// signs): each prime is a Gaussian integer times its conjugate, and every choice of one of the two
/// for each prime gives another point. 17 primes stay below 2^50.
Points<2> circle(std::size_t size) {
    static constexpr std::pair<std::int64_t, std::int64_t> primes[] = {
        {2, 1}, {3, 2}, {4, 1},  {5, 2},  {6, 1}, {5, 4},  {7, 2},  {6, 5}, {8, 3},
        {8, 5}, {9, 4}, {10, 1}, {10, 3}, {8, 7}, {11, 4}, {10, 7}, {11, 6}};
    std::vector<std::pair<std::int64_t, std::int64_t>> quarter = {{1, 0}};
    for (const auto &[a, b] : primes) {
        if (4 * quarter.size() >= size) break;
        const std::size_t count = quarter.size();
        for (std::size_t i = 0; i < count; ++i) {
            const auto [x, y] = quarter[i];
            quarter[i] = {x * a - y * b, x * b + y * a};
            quarter.push_back({x * a + y * b, y * a - x * b});
        }
    }
    Points<2> points;
    for (const auto &[x, y] : quarter) {
        const double a = double(x), b = double(y);
        points.insert(points.end(), {{a, b}, {-b, a}, {-a, -b}, {b, -a}});
    }
    return points;
}

/// All integer points with x^2 + y^2 + z^2 = n.
Points<3> sphere(std::int64_t n) {
    Points<3> points;
    const auto add = [&](std::int64_t x, std::int64_t y, std::int64_t z) {
        for (int signs = 0; signs < 8; ++signs) {
            if ((signs & 1 && x == 0) || (signs & 2 && y == 0) || (signs & 4 && z == 0)) continue;
            points.push_back({double(signs & 1 ? -x : x), double(signs & 2 ? -y : y),
                              double(signs & 4 ? -z : z)});
        }
    };
    for (std::int64_t x = 0; x * x <= n; ++x) {
        // y grows, so z shrinks: one pass along the quarter circle.
        std::int64_t z = std::int64_t(std::sqrt(double(n - x * x))) + 1;
        for (std::int64_t y = 0; x * x + y * y <= n; ++y) {
            while (z > 0 && x * x + y * y + z * z > n) --z;
            if (x * x + y * y + z * z == n) add(x, y, z);
        }
    }
    return points;
}

/// There are about 2 pi sqrt(n) such points; the number varies with n.
Points<3> sphere_of(std::size_t size) {
    auto n = std::int64_t(double(size) * double(size) / 36) | 1;
    Points<3> points = sphere(n);
    while (points.size() < size) points = sphere(n += 2);
    return points;
}

} // namespace

template <int D> Points<D> exact_sphere(std::size_t size, Random &random) {
    Points<D> points;
    if constexpr (D == 2)
        points = circle(size);
    else
        points = sphere_of(size);
    random.shuffle(points);
    if (points.size() > size) points.resize(size);
    return points;
}

template Points<2> exact_sphere<2>(std::size_t, Random &);
template Points<3> exact_sphere<3>(std::size_t, Random &);

} // namespace abacus::oracle
