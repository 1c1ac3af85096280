// Predicates and locational codes, the innermost operations.
#include "geometry/predicates.hpp"
#include "keys/locational_code.hpp"

#include <benchmark/benchmark.h>

#include <random>
#include <vector>

namespace {

using namespace abacus;

constexpr std::size_t count = 1 << 12; // a power of two; stays in the cache

template <int D> std::vector<Point<D>> random_points() {
    std::mt19937_64 engine(1);
    std::vector<Point<D>> points(count);
    for (Point<D> &p : points)
        for (double &coordinate : p) coordinate = double(engine() >> 11) * 0x1p-53;
    return points;
}

/// Points of a small integer grid: the filters fail on every second call.
template <int D> std::vector<Point<D>> degenerate_points() {
    std::mt19937_64 engine(1);
    std::vector<Point<D>> points(count);
    for (Point<D> &p : points)
        for (double &coordinate : p) coordinate = double(engine() % 3);
    return points;
}

template <int D> Corners<D> corners_at(const std::vector<Point<D>> &points, std::size_t i) {
    Corners<D> corners;
    for (int k = 0; k <= D; ++k) corners[k] = &points[(i + k) % count];
    return corners;
}

template <int D>
void measure_orientation(benchmark::State &state, const std::vector<Point<D>> &points) {
    std::size_t i = 0;
    for (auto _ : state) benchmark::DoNotOptimize(orientation<D>(corners_at<D>(points, ++i)));
}

void Orientation2(benchmark::State &state) { measure_orientation<2>(state, random_points<2>()); }
void Orientation3(benchmark::State &state) { measure_orientation<3>(state, random_points<3>()); }
void Orientation2Degenerate(benchmark::State &state) {
    measure_orientation<2>(state, degenerate_points<2>());
}

template <int D>
void measure_in_sphere(benchmark::State &state, const std::vector<Point<D>> &points) {
    std::vector<Corners<D>> positive;
    for (std::size_t i = 0; i < count; ++i)
        if (const Corners<D> corners = corners_at<D>(points, i); orientation<D>(corners) > 0)
            positive.push_back(corners);
    std::size_t i = 0;
    for (auto _ : state) {
        ++i;
        benchmark::DoNotOptimize(in_sphere(positive[i % positive.size()], points[i % count]));
    }
}

void InSphere2(benchmark::State &state) { measure_in_sphere<2>(state, random_points<2>()); }
void InSphere3(benchmark::State &state) { measure_in_sphere<3>(state, random_points<3>()); }
void InSphere2Degenerate(benchmark::State &state) {
    measure_in_sphere<2>(state, degenerate_points<2>());
}

void InSphere3Degenerate(benchmark::State &state) {
    measure_in_sphere<3>(state, degenerate_points<3>());
}

template <int D> void measure_code(benchmark::State &state) {
    const std::vector<Point<D>> points = random_points<D>();
    Point<D> lower, upper;
    lower.fill(0);
    upper.fill(1);
    const Domain<D> domain(lower, upper);
    std::size_t i = 0;
    for (auto _ : state) benchmark::DoNotOptimize(domain.code(points[++i % count]));
}

void Code2(benchmark::State &state) { measure_code<2>(state); }
void Code3(benchmark::State &state) { measure_code<3>(state); }

BENCHMARK(Orientation2);
BENCHMARK(Orientation2Degenerate);
BENCHMARK(Orientation3);
BENCHMARK(InSphere2);
BENCHMARK(InSphere2Degenerate);
BENCHMARK(InSphere3);
BENCHMARK(InSphere3Degenerate);
BENCHMARK(Code2);
BENCHMARK(Code3);

} // namespace
