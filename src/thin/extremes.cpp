#include "thin/extremes.hpp"

#include "geometry/misfit.hpp"

namespace abacus {

namespace {

/// Which of two points comes first in a direction: along an axis, up or down, then in
/// lexicographic order, up or down.
template <int D> struct Direction {
    int axis;
    bool is_down, is_tie_down;

    bool comes_first(const Point<D> &p, const Point<D> &q) const {
        if (p[axis] != q[axis]) return (p[axis] < q[axis]) != is_down;
        return is_tie_down ? lexicographically_less<D>(q, p) : lexicographically_less<D>(p, q);
    }
};

/// Whether p is farther than q from the line or plane through points, or as far and comes first.
template <int D>
bool is_farther(const std::array<Point<D>, D + 1> &from, std::size_t count, const Point<D> &p,
                const Point<D> &q) {
    int order;
    if (count == D) {
        std::array<Point<D>, D> facet;
        std::copy_n(from.begin(), D, facet.begin());
        const Magnitude a = height_over<D>(facet, p), b = height_over<D>(facet, q);
        order = a.least() > b.most()   ? 1
                : a.most() < b.least() ? -1
                                       : exact::compare_heights<D>(facet, p, q);
    } else if constexpr (D == 3) {
        const Magnitude a = distance_from(from[0], from[1], p),
                        b = distance_from(from[0], from[1], q);
        order = a.least() > b.most()   ? 1
                : a.most() < b.least() ? -1
                                       : exact::compare_distances(from[0], from[1], p, q);
    } else {
        order = 0;
    }
    return order != 0 ? order > 0 : lexicographically_less<D>(p, q);
}

} // namespace

template <int D>
Extremes<D>::Extremes(const Host &host, const abacus_facts &facts, std::uint32_t attribute,
                      std::size_t words)
    : host_(host), facts_(facts), attribute_(attribute), words_(words), found_(host) {}

template <int D> template <class Visit> void Extremes<D>::each(Visit visit) const {
    SourceVertices<D> source(host_, facts_, attribute_);
    while (source.advance())
        for (int v = 0; v < source.page().vertices(); ++v)
            if (!std::isnan(source.value(v))) visit(source, v);
}

template <int D> void Extremes<D>::add(const std::uint64_t *vertex) {
    for (std::size_t i = 0; i < count_; ++i)
        if (point(i) == vertex_point<D>(vertex)) return;
    std::copy_n(vertex, words_, found_.extend(words_));
    ++count_;
}

template <int D> void Extremes<D>::find_on_axes() {
    constexpr std::size_t directions = std::size_t{4} * D;
    Arena<std::uint64_t> first(host_);
    first.resize(directions * words_);
    bool is_any = false;
    each([&](const SourceVertices<D> &source, int v) {
        const Point<D> &p = source.page().point(v);
        for (std::size_t i = 0; i < directions; ++i) {
            const Direction<D> direction{static_cast<int>(i / 4), (i & 1) != 0, (i & 2) != 0};
            std::uint64_t *const kept = first.data() + i * words_;
            if (!is_any || direction.comes_first(p, vertex_point<D>(kept))) source.put(kept, v);
        }
        is_any = true;
    });
    if (!is_any)
        throw Error(ABACUS_ERROR_ARGUMENT, "no vertex of the mesh has a value", {},
                    "Choose another attribute, or give the points values with abacus_update().");
    // The lexicographically least and greatest come first.
    for (std::size_t i = 0; i < directions; ++i) {
        const std::size_t number = i == 1 ? 3 : i == 3 ? 1 : i;
        add(first.data() + number * words_);
    }
}

template <int D> std::size_t Extremes<D>::independent(std::array<Point<D>, D + 1> &points) const {
    Corners<D> corners;
    std::size_t n = 0;
    for (std::size_t i = 0; i < count_ && n <= D; ++i) {
        points[n] = point(i);
        corners[n] = &points[n];
        if (is_independent(corners, static_cast<int>(n), points[n])) ++n;
    }
    return n;
}

template <int D>
void Extremes<D>::find_farthest(const std::array<Point<D>, D + 1> &from, std::size_t count) {
    Arena<std::uint64_t> farthest(host_);
    farthest.resize(words_);
    bool is_any = false;
    each([&](const SourceVertices<D> &source, int v) {
        if (!is_any ||
            is_farther<D>(from, count, source.page().point(v), vertex_point<D>(farthest.data())))
            source.put(farthest.data(), v);
        is_any = true;
    });
    add(farthest.data());
}

template <int D> void Extremes<D>::find() {
    find_on_axes();
    std::array<Point<D>, D + 1> points;
    std::size_t n = independent(points);
    while (n <= D) {
        if (n > 1) find_farthest(points, n);
        const std::size_t before = n;
        n = independent(points);
        if (n == before)
            throw Error(ABACUS_ERROR_ARGUMENT,
                        n == 1   ? "only one vertex of the mesh has a value"
                        : n == 2 ? "the vertices with values lie on one line"
                                 : "the vertices with values lie in one plane",
                        {}, "A mesh needs points that span a simplex: give more of them values.");
    }
}

template class Extremes<2>;
template class Extremes<3>;

} // namespace abacus
