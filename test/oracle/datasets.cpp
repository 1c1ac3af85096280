#include "datasets.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <random>
#include <stdexcept>
#include <utility>

namespace abacus::oracle {
namespace {

// std::mt19937_64 gives the same numbers everywhere; the distributions of the
// standard library don't, so these are our own.
class Random {
public:
    explicit Random(std::uint64_t seed) : engine_(seed) {}
    std::uint64_t below(std::uint64_t n) { return engine_() % n; }
    double unit() { return double(engine_() >> 11) * 0x1p-53; }
    double between(double low, double high) { return low + (high - low) * unit(); }

private:
    std::mt19937_64 engine_;
};

void shuffle(std::vector<Point2> &points, Random &random) {
    for (std::size_t i = points.size(); i > 1; --i)
        std::swap(points[i - 1], points[random.below(i)]);
}

std::vector<Point2> uniform(std::size_t size, Random &random) {
    std::vector<Point2> points(size);
    for (Point2 &p : points) p = {random.unit(), random.unit()};
    return points;
}

/// The largest square integer grid of at most `size` points: every cell is degenerate.
std::vector<Point2> grid(std::size_t size, Random &) {
    const auto side = std::size_t(std::sqrt(double(size)));
    std::vector<Point2> points;
    for (std::size_t i = 0; i < side * side; ++i)
        points.push_back({double(i % side), double(i / side)});
    return points;
}

/// Integer points that lie on one circle exactly. A product N of primes 4k + 1
/// is a sum of two squares in 2^primes ways (times four for the signs): each
/// prime is a Gaussian integer times its conjugate, and every choice of one
/// of the two per prime is another point. 17 primes stay below 2^50.
std::vector<Point2> circle(std::size_t size, Random &random) {
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
    std::vector<Point2> points;
    for (const auto &[x, y] : quarter) {
        const double a = double(x), b = double(y);
        points.insert(points.end(), {{a, b}, {-b, a}, {-a, -b}, {b, -a}});
    }
    shuffle(points, random);
    if (points.size() > size) points.resize(size);
    return points;
}

/// Points of the unit circle as nearly as doubles can have them.
std::vector<Point2> rounded_circle(std::size_t size, Random &random) {
    std::vector<Point2> points(size);
    for (Point2 &p : points) {
        const double angle = random.between(0, 2 * std::numbers::pi);
        p = {std::cos(angle), std::sin(angle)};
    }
    return points;
}

/// An exact circle and its centre, which becomes a vertex of all triangles.
std::vector<Point2> wheel(std::size_t size, Random &random) {
    std::vector<Point2> points = circle(size - 1, random);
    points.push_back({0, 0});
    return points;
}

/// Seven lines through a common region: axis-parallel, diagonal, steep and shallow.
std::vector<Point2> lines(std::size_t size, Random &random) {
    static constexpr struct {
        double x, y, dx, dy;
    } line[] = {{0, 0, 1, 0},    {0, 0, 0, 1},   {0, 0, 1, 1},     {0, 1e6, 1, -1},
                {7, 3, 1000, 1}, {5, 1, 1, 333}, {0, 500000, 1, 0}};
    std::vector<Point2> points(size);
    for (Point2 &p : points) {
        const auto &l = line[random.below(std::size(line))];
        const double t = double(random.below(1'000'000));
        p = {l.x + t * l.dx, l.y + t * l.dy};
    }
    return points;
}

/// Ten clusters whose spread is 1e-12 of the domain, and a few points around them.
std::vector<Point2> clusters(std::size_t size, Random &random) {
    std::vector<Point2> centres = uniform(10, random);
    std::vector<Point2> points(size);
    for (Point2 &p : points) {
        if (random.below(1000) == 0) {
            p = {random.unit(), random.unit()};
        } else {
            const Point2 centre = centres[random.below(centres.size())];
            p = {centre.x + random.between(-5e-13, 5e-13),
                 centre.y + random.between(-5e-13, 5e-13)};
        }
    }
    return points;
}

/// Coordinates of either sign with exponents from 1e-300 to 1e300.
std::vector<Point2> exponents(std::size_t size, Random &random) {
    const auto coordinate = [&] {
        const double magnitude = std::pow(10, random.between(-300, 300));
        return random.below(2) ? magnitude : -magnitude;
    };
    std::vector<Point2> points(size);
    for (Point2 &p : points) {
        p.x = coordinate();
        p.y = coordinate();
    }
    return points;
}

/// Few places, many points on each, zeros of both signs among them.
std::vector<Point2> duplicates(std::size_t size, Random &random) {
    const auto side = std::max<std::uint64_t>(2, std::uint64_t(std::sqrt(double(size) / 10)));
    const auto coordinate = [&] {
        const double value = double(random.below(side)) - double(side / 2);
        return value == 0 && random.below(2) ? -0.0 : value;
    };
    std::vector<Point2> points(size);
    for (Point2 &p : points) {
        p.x = coordinate();
        p.y = coordinate();
    }
    return points;
}

constexpr struct {
    const char *name;
    std::vector<Point2> (*make)(std::size_t, Random &);
    const char *what;
} sets[] = {
    {"uniform", uniform, "random points of the unit square"},
    {"grid", grid, "a square integer grid"},
    {"circle", circle, "integer points exactly on one circle"},
    {"rounded_circle", rounded_circle, "points on a circle, rounded to doubles"},
    {"wheel", wheel, "integer points exactly on one circle, and its centre"},
    {"lines", lines, "integer points of seven lines"},
    {"clusters", clusters, "ten clusters with a spread of 1e-12 of the domain"},
    {"exponents", exponents, "coordinates from 1e-300 to 1e300"},
    {"duplicates", duplicates, "ten points on each node of an integer grid"},
};

} // namespace

std::vector<Point2> dataset(const std::string &name, std::size_t size, std::uint64_t seed) {
    Random random(seed);
    for (const auto &set : sets)
        if (name == set.name) return set.make(size, random);
    throw std::invalid_argument("no data set " + name);
}

std::string dataset_names() {
    std::string text;
    for (const auto &set : sets) text += std::string("  ") + set.name + ": " + set.what + "\n";
    return text;
}

} // namespace abacus::oracle
