#include "query/locate/nearest.hpp"

namespace abacus {

namespace {

/// A square of a distance that no point of the box is nearer to p than, whatever is rounded.
template <int D> double least_square(const Box<D> &box, const Point<D> &p) {
    return std::max(0.0, rounded_square<D>(p, box.nearest(p)) * (1 - 1e-15) - 1e-290);
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
    fill_record<D>(records_.data() + place->slot * words_, heap.id(vertex), point,
                   heap.attributes(vertex), static_cast<std::size_t>(heap.attribute_count()));
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
