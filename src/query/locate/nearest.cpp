#include "query/locate/nearest.hpp"

#include "geometry/predicates.hpp"

namespace abacus {

namespace {

/// A square of a distance that no point of the box is nearer to p than, whatever is rounded.
template <int D> double least_square(const Box<D> &box, const Point<D> &p) {
    return std::max(0.0, rounded_square<D>(p, box.nearest(p)) * (1 - 1e-15) - 1e-290);
}

/// The same of a segment in the plane.
double least_square(const Point<2> &a, const Point<2> &b, const Point<2> &p) {
    Box<2> box;
    box.extend(a);
    box.extend(b);
    const double to_box = least_square<2>(box, p);
    const Point<2> way{b[0] - a[0], b[1] - a[1]};
    // Whether p is surely behind an end, seen from the other one.
    const auto is_behind = [&](const Point<2> &end, double sign) {
        const double x = sign * way[0] * (p[0] - end[0]), y = sign * way[1] * (p[1] - end[1]);
        return x + y > 1e-15 * (std::fabs(x) + std::fabs(y)) + 1e-290;
    };
    if (is_behind(a, -1)) return std::max(to_box, least_square<2>(Box<2>(a, a), p));
    if (is_behind(b, 1)) return std::max(to_box, least_square<2>(Box<2>(b, b), p));
    const SignedArea area = signed_area({a[0] - p[0], a[1] - p[1]}, {b[0] - p[0], b[1] - p[1]});
    const double height = std::max(0.0, std::fabs(area.value) - area.error);
    const double to_line = height / rounded_square<2>(a, b) * height * (1 - 1e-14) - 1e-290;
    return std::max(to_box, to_line); // of something that is not a number, the first
}

/// The same of a facet of n points.
template <int D>
double least_square(const std::array<const Point<D> *, D> &points, int n, const Point<D> &p) {
    if constexpr (D == 2)
        if (n == 2) return least_square(*points[0], *points[1], p);
    Box<D> box;
    for (int i = 0; i < n; ++i) box.extend(*points[i]);
    return least_square<D>(box, p);
}

/// A square of a distance that the point is not farther away than.
template <int D> double greatest_square(const Point<D> &p, const Point<D> &point) {
    return rounded_square<D>(p, point) * (1 + 1e-15) + 1e-290;
}

} // namespace

template <int D> void Nearest<D>::search(const Point<D> &p, std::uint64_t k) {
    forget();
    p_ = p;
    k_ = k;
    if (k == 0 || reader_.is_empty()) return;
    if (reader_.is_delaunay())
        search_edges();
    else if (reader_.is_convex())
        search_outward();
    else
        search_pages();
}

template <int D> void Nearest<D>::offer(Handle simplex, VertexIndex vertex) {
    const bool is_full = candidates_.size() == k_;
    const Point<D> &point = cache_.point(vertex);
    const Candidate candidate{point, cache_.vertices().id(vertex), candidates_.size(), simplex,
                              vertex};
    if (is_full && !Order{p_}(candidate, *candidates_.rbegin())) return;
    const auto [place, is_new] = candidates_.insert(candidate);
    if (!is_new) return;
    if (is_full) {
        const auto last = std::prev(candidates_.end());
        place->slot = last->slot;
        candidates_.erase(last);
    } else {
        records_.extend(words_);
    }
    const VertexHeap<D> &heap = cache_.vertices();
    fill_record<D>(
        records_.data() + place->slot * words_, heap.id(vertex), point, heap.attributes(vertex),
        reader_.vertex_values().are_elsewhere() ? 0
                                                : static_cast<std::size_t>(heap.attribute_count()));
}

// ---- Delaunay meshes -------------------------------------------------------------------

template <int D> void Nearest<D>::search_edges() {
    nearest_.simplex = reader_.simplex_around(p_);
    const Simplex<D> &s = cache_.simplex(nearest_.simplex);
    nearest_.vertex = s.vertex[0];
    for (int i = 1; i < s.finite_vertices(); ++i)
        if (compare_distance<D>(p_, cache_.point(s.vertex[i]), cache_.point(nearest_.vertex)) < 0)
            nearest_.vertex = s.vertex[i];
    while (!look_around_plateau()) forget();
    // The points at the least distance have been visited; visiting them again finds nothing new.
    std::uint64_t found = 1;
    for (auto next = candidates_.begin(); found < k_ && next != candidates_.end(); ++next, ++found)
        look_around(*next);
}

template <int D> bool Nearest<D>::look_around_plateau() {
    nearest_.point = cache_.point(nearest_.vertex);
    cache_.poll();
    const auto compare = [this](VertexIndex v) {
        return v == nearest_.vertex ? 0 : compare_distance<D>(p_, cache_.point(v), nearest_.point);
    };
    const auto has_one = [&](Handle h, int facet) {
        const Simplex<D> &s = cache_.simplex(h);
        for (int i = 0; i < s.finite_vertices(); ++i)
            if (i != facet && compare(s.vertex[i]) == 0) return true;
        return false;
    };
    return reader_.flood().from(cache_, nearest_.simplex, has_one, [&](Handle met) {
        const Simplex<D> &s = cache_.simplex(met);
        for (int i = 0; i < s.finite_vertices(); ++i) {
            if (compare(s.vertex[i]) >= 0) continue;
            nearest_.simplex = met;
            nearest_.vertex = s.vertex[i];
            return false;
        }
        offer_corners(met);
        return true;
    });
}

template <int D> void Nearest<D>::look_around(const Candidate &candidate) {
    cache_.poll();
    reader_.flood().around(cache_, candidate.simplex, candidate.vertex, [&](Handle met) {
        offer_corners(met);
        return true;
    });
}

// ---- Constrained meshes ----------------------------------------------------------------

template <int D> void Nearest<D>::search_outward() {
    const auto rank = [this](Handle h, int facet) {
        const Simplex<D> &s = cache_.simplex(h);
        std::array<const Point<D> *, D> ends;
        int n = 0;
        for (int i = 0; i < s.finite_vertices(); ++i)
            if (i != facet) ends[n++] = &cache_.point(s.vertex[i]);
        return least_square<D>(ends, n, p_);
    };
    double bound = std::numeric_limits<double>::infinity();
    const auto is_within = [&](double least) { return least <= bound; };
    reader_.flood().by_rank(cache_, reader_.simplex_around(p_), rank, is_within, [&](Handle met) {
        offer_corners(met);
        if (candidates_.size() == k_) bound = greatest_square<D>(p_, candidates_.rbegin()->point);
    });
}

// ---- Other meshes ----------------------------------------------------------------------

template <int D> void Nearest<D>::search_pages() {
    const auto rank = [this](const Box<D> &box) { return least_square<D>(box, p_); };
    double bound = std::numeric_limits<double>::infinity();
    reader_.boxes().by_rank(memory_, rank, [&](Key key, const Key &end, double least) {
        if (least > bound) return false;
        while (key < end) {
            cache_.trim();
            cache_.poll();
            key = cache_.visit(key, [this](Handle h) { offer_corners(h); });
        }
        if (candidates_.size() == k_) bound = greatest_square<D>(p_, candidates_.rbegin()->point);
        return true;
    });
}

template class Nearest<2>;
template class Nearest<3>;

} // namespace abacus
