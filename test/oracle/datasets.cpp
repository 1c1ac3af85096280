#include "datasets.hpp"

#include "exact_sphere.hpp"
#include "octree.hpp"
#include "quake.hpp"
#include "random.hpp"

#include <algorithm>
#include <cmath>
#include <stdexcept>

namespace abacus::oracle {
namespace {

/// `size` points, drawn coordinate by coordinate.
template <int D, class Draw> Points<D> each_coordinate(std::size_t size, Draw draw) {
    Points<D> points(size);
    for (auto &p : points)
        for (double &x : p) x = draw();
    return points;
}

template <int D> Points<D> uniform(std::size_t size, Random &random) {
    return each_coordinate<D>(size, [&] { return random.unit(); });
}

/// The largest integer grid with at most `size` points: every cell is degenerate.
template <int D> Points<D> grid(std::size_t size, Random &) {
    const auto nodes = [](std::size_t side) {
        std::size_t product = 1;
        for (int i = 0; i < D; ++i) product *= side;
        return product;
    };
    std::size_t side = 0;
    while (nodes(side + 1) <= size) ++side;
    Points<D> points(nodes(side));
    for (std::size_t n = 0; n < points.size(); ++n) {
        std::size_t rest = n;
        for (double &x : points[n]) {
            x = double(rest % side);
            rest /= side;
        }
    }
    return points;
}

/// Points of the unit circle or sphere, as precise as doubles allow.
template <int D> Points<D> rounded_sphere(std::size_t size, Random &random) {
    Points<D> points(size);
    for (auto &p : points) {
        double square;
        do {
            square = 0;
            for (double &x : p) {
                x = random.between(-1, 1);
                square += x * x;
            }
        } while (square > 1 || square < 0.01);
        for (double &x : p) x /= std::sqrt(square);
    }
    return points;
}

/// An exact circle or sphere and, last, its centre. It becomes a vertex of all simplices, and
/// removes them all if it comes late.
template <int D> Points<D> wheel(std::size_t size, Random &random) {
    Points<D> points = exact_sphere<D>(size - 1, random);
    points.push_back({});
    return points;
}

/// Seven lines through a common region: axis-parallel, diagonal, steep and shallow.
Points<2> lines(std::size_t size, Random &random) {
    static constexpr struct {
        double x, y, dx, dy;
    } line[] = {{0, 0, 1, 0},    {0, 0, 0, 1},   {0, 0, 1, 1},     {0, 1e6, 1, -1},
                {7, 3, 1000, 1}, {5, 1, 1, 333}, {0, 500000, 1, 0}};
    Points<2> points(size);
    for (auto &p : points) {
        const auto &l = line[random.below(std::size(line))];
        const double t = double(random.below(1'000'000));
        p = {l.x + t * l.dx, l.y + t * l.dy};
    }
    return points;
}

/// Two lines with half of the points each: every segment of the one makes a tetrahedron with every
/// segment of the other.
Points<3> skew_lines(std::size_t size, Random &random) {
    Points<3> points(size);
    for (std::size_t i = 0; i < size; ++i) {
        const double t = random.unit();
        if (i % 2 == 0)
            points[i] = {t, 0, 0};
        else
            points[i] = {0.3, t, 1};
    }
    return points;
}

/// Integer points on one slanted line or plane: no simplex at all.
template <int D> Points<D> flat(std::size_t size, Random &random) {
    Points<D> points(size);
    for (auto &p : points) {
        p[D - 1] = 0;
        for (int i = 0; i < D - 1; ++i) {
            p[i] = double(random.below(1'000'000));
            p[D - 1] -= p[i];
        }
    }
    return points;
}

/// The same and, last, a point off the line or plane.
template <int D> Points<D> flat_but_one(std::size_t size, Random &random) {
    Points<D> points = flat<D>(size - 1, random);
    points.push_back({});
    points.back()[0] = 1;
    return points;
}

/// Ten clusters whose spread is 1e-12 of the domain, and a few points around them.
template <int D> Points<D> clusters(std::size_t size, Random &random) {
    const Points<D> centres = uniform<D>(10, random);
    Points<D> points(size);
    for (auto &p : points) {
        const bool around = random.below(1000) == 0;
        const Coordinates<D> &centre = centres[random.below(centres.size())];
        for (int i = 0; i < D; ++i)
            p[i] = around ? random.unit() : centre[i] + random.between(-5e-13, 5e-13);
    }
    return points;
}

/// Coordinates of either sign with exponents from 1e-300 to 1e300.
template <int D> Points<D> exponents(std::size_t size, Random &random) {
    return each_coordinate<D>(size, [&] {
        const double magnitude = std::pow(10, random.between(-300, 300));
        return random.below(2) ? magnitude : -magnitude;
    });
}

/// Few places with many points each; zeros of both signs.
template <int D> Points<D> duplicates(std::size_t size, Random &random) {
    const auto side =
        std::max<std::uint64_t>(2, std::uint64_t(std::pow(double(size) / 10, 1.0 / D)));
    return each_coordinate<D>(size, [&] {
        const double value = double(random.below(side)) - double(side / 2);
        return value == 0 && random.below(2) ? -0.0 : value;
    });
}

/// Half of the points lie near closed curves, half in Gaussian clusters of different widths. They
/// are dense in few places, like shorelines, settlements and scanned surfaces.
template <int D> Points<D> curves(std::size_t size, Random &random) {
    constexpr double turn = 6.283185307179586;
    const auto normal = [&] { // Box and Muller
        return std::sqrt(-2 * std::log(1 - random.unit())) * std::cos(turn * random.unit());
    };
    struct Shape {
        Coordinates<D> centre;
        double width; // of a cluster; or of a curve, which winds around its centre
        std::array<double, D> frequency, phase;
    };
    std::vector<Shape> shapes(40);
    for (Shape &shape : shapes) {
        for (double &x : shape.centre) x = random.unit();
        shape.width = std::pow(10, random.between(-3, -1));
        for (double &x : shape.frequency) x = double(1 + random.below(5));
        for (double &x : shape.phase) x = turn * random.unit();
    }
    Points<D> points(size);
    for (auto &p : points) {
        const std::size_t chosen = random.below(shapes.size());
        const Shape &shape = shapes[chosen];
        const double along = turn * random.unit();
        for (int axis = 0; axis < D; ++axis)
            p[axis] =
                shape.centre[axis] +
                (chosen % 2 == 0
                     ? shape.width * normal()
                     : shape.width * std::sin(shape.frequency[axis] * along + shape.phase[axis]) +
                           1e-5 * normal());
    }
    return points;
}

Points<3> quake_near(std::size_t size, Random &) { return quake(size); }

template <int D> using Make = Points<D> (*)(std::size_t, Random &);

constexpr struct {
    const char *name;
    Make<2> make2;
    Make<3> make3;
    const char *what;
} sets[] = {
    {"uniform", uniform<2>, uniform<3>, "random points of the unit square or cube"},
    {"grid", grid<2>, grid<3>, "a square or cubic integer grid"},
    {"circle", exact_sphere<2>, nullptr, "integer points exactly on one circle"},
    {"sphere", nullptr, exact_sphere<3>, "integer points exactly on one sphere"},
    {"rounded_circle", rounded_sphere<2>, nullptr, "points on a circle, rounded to doubles"},
    {"rounded_sphere", nullptr, rounded_sphere<3>, "points on a sphere, rounded to doubles"},
    {"wheel", wheel<2>, wheel<3>, "such integer points, and their centre"},
    {"lines", lines, nullptr, "integer points of seven lines"},
    {"skew_lines", nullptr, skew_lines, "points of two skew lines: size^2 / 4 tetrahedra"},
    {"flat", flat<2>, flat<3>, "integer points of one slanted line or plane"},
    {"flat_but_one", flat_but_one<2>, flat_but_one<3>, "the same, and a point off it"},
    {"clusters", clusters<2>, clusters<3>, "ten clusters with a spread of 1e-12 of the domain"},
    {"curves", curves<2>, curves<3>, "thin curves and Gaussian clusters"},
    {"exponents", exponents<2>, exponents<3>, "coordinates from 1e-300 to 1e300"},
    {"duplicates", duplicates<2>, duplicates<3>, "ten points on each node of an integer grid"},
    {"octree", octree<2>, octree<3>, "corners of a random quadtree or octree, unbalanced"},
    {"quake", nullptr, quake_near, "the earthquake data set nearest in size"},
};

} // namespace

template <int D> Points<D> dataset(const std::string &name, std::size_t size, std::uint64_t seed) {
    Random random(seed);
    for (const auto &set : sets) {
        Make<D> make;
        if constexpr (D == 2)
            make = set.make2;
        else
            make = set.make3;
        if (name == set.name && make != nullptr) return make(size, random);
    }
    throw std::invalid_argument("no data set " + name + " in dimension " + std::to_string(D));
}

template Points<2> dataset<2>(const std::string &, std::size_t, std::uint64_t);
template Points<3> dataset<3>(const std::string &, std::size_t, std::uint64_t);

std::string dataset_names() {
    std::string text;
    for (const auto &set : sets)
        text += std::string("  ") + set.name +
                (set.make2 && set.make3 ? " (2, 3): "
                 : set.make2            ? " (2): "
                                        : " (3): ") +
                set.what + "\n";
    return text;
}

} // namespace abacus::oracle
