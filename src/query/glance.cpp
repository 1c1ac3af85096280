#include "query/glance.hpp"

#include "query/page_simplex.hpp"

#include <algorithm>
#include <cmath>
#include <functional>
#include <utility>

namespace abacus {

// ---- Where to look --------------------------------------------------------------------

template <int D>
bool Glance<D>::find(std::uint64_t &code, const Point<D> &p, abacus_simplex &simplex) {
    looks_ = 0;
    const KnownPage *const known = known_.find(code);
    if (known == nullptr) { // then it is not known either how far to look around
        if (is_cached(code)) return false;
        const Outcome outcome = look(code, nullptr, p, simplex);
        if (outcome != Outcome::not_here) return outcome == Outcome::found;
    }
    const KnownPage own = known == nullptr ? at_hand_ : *known; // a copy: others will be added
    const Cell<D> cell = cache_.domain().cell(p);
    for (const double distance : distances) {
        Codes codes;
        add_along_axes(cell, distance * own.spacing, codes);
        const bool is_first = distance == distances[0];
        if (is_first) codes.add(code);
        else add_diagonally(cell, distance * own.spacing, codes);
        std::sort(codes.begin(), codes.end(), std::greater());
        if (is_first) {
            code = *codes.begin();
            const auto is_here = [&](std::uint64_t c) { return is_cached(c); };
            if (std::all_of(codes.begin(), codes.end(), is_here)) return false;
        }
        for (const std::uint64_t c : codes) {
            if (c < own.lower || has_looked(c)) continue;
            const Outcome outcome = look(c, c < own.upper ? &own : known_.find(c), p, simplex);
            if (outcome != Outcome::not_here) return outcome == Outcome::found;
        }
    }
    return false;
}

/// Code of the cell so far away in a direction, or at the border of the domain.
template <int D>
static std::uint64_t code_at(const Cell<D> &cell, const std::array<int, D> &way, double distance) {
    constexpr std::int64_t last = (std::int64_t{1} << code_bits<D>) - 1;
    const std::int64_t step = static_cast<std::int64_t>(distance) + 1;
    Cell<D> other;
    for (int i = 0; i < D; ++i)
        other[i] = static_cast<std::uint32_t>(
            std::clamp<std::int64_t>(std::int64_t{cell[i]} + way[i] * step, 0, last));
    return curve_code<D>(other);
}

template <int D>
void Glance<D>::add_along_axes(const Cell<D> &cell, double distance, Codes &codes) {
    for (int axis = 0; axis < D; ++axis)
        for (const int sign : {-1, 1}) {
            std::array<int, D> way{};
            way[axis] = sign;
            codes.add(code_at<D>(cell, way, distance));
        }
}

template <int D>
void Glance<D>::add_diagonally(const Cell<D> &cell, double distance, Codes &codes) {
    constexpr double along_axis = D == 2 ? 0.85 : 0.7; // a little farther than along the axes
    for (unsigned signs = 0; signs < 1u << D; ++signs) {
        std::array<int, D> way;
        for (int i = 0; i < D; ++i) way[i] = (signs >> i & 1) != 0 ? 1 : -1;
        codes.add(code_at<D>(cell, way, distance * along_axis));
    }
}

// ---- Pages ----------------------------------------------------------------------------

template <int D> bool Glance<D>::has_looked(std::uint64_t code) const {
    const Key key{code, 0};
    return std::any_of(looked_.begin(), looked_.begin() + looks_, [&](const auto &page) {
        return page.first <= key && key < page.second;
    });
}

template <int D> bool Glance<D>::was_seen(const Key &page) {
    for (const Key &seen : seen_)
        if (seen == page) return true;
    seen_[next_++ % remembered] = page;
    return false;
}

template <int D>
bool Glance<D>::fetch(std::uint64_t code, const KnownPage *known, abacus_page &page) {
    const Host &host = cache_.host();
    if (known != nullptr) {
        known->prefetch();
        page.location = known->location;
        if (host.fetch(ABACUS_SIMPLEX_PAGES, page) && page.key == Key{known->lower, 0}) return true;
    }
    return host.find(ABACUS_SIMPLEX_PAGES, {code, 0}, page);
}

template <int D>
typename Glance<D>::Outcome Glance<D>::look(std::uint64_t code, const KnownPage *known,
                                            const Point<D> &p, abacus_simplex &simplex) {
    abacus_page page{};
    if (!fetch(code, known, page) || (looks_ == 0 && was_seen(page.key))) return Outcome::not_now;
    view_.open(page.bytes, page.size, cache_.vertices().attribute_count());
    if (!(view_.lower() == page.key)) throw_corrupted("A page is stored under another page's key.");
    looked_[looks_++] = {view_.lower(), view_.upper()};
    if (known == nullptr || known->location != page.location || known->bytes != page.bytes) {
        at_hand_ = {view_.lower().code, view_.upper().code, page.location, spacing(), page.bytes};
        if (view_.lower().part == 0) known_.learn(at_hand_);
    }

    const int number = search(p);
    if (number < 0) return Outcome::not_here;
    describe(view_, number, cache_.domain(), simplex);
    return Outcome::found;
}

template <int D> double Glance<D>::spacing() const {
    // Of points at random; some of the page's vertices are other pages', too.
    constexpr double simplices_per_vertex = D == 2 ? 2 : 6.77;
    constexpr std::uint64_t end = std::uint64_t{1} << (D * code_bits<D>);
    const double cells = static_cast<double>(std::min(view_.upper().code, end)) -
                         static_cast<double>(std::min(view_.lower().code, end));
    const double cells_per_vertex = cells * simplices_per_vertex / std::max(view_.simplices(), 1);
    return D == 2 ? std::sqrt(cells_per_vertex) : std::cbrt(cells_per_vertex);
}

// ---- In a page ------------------------------------------------------------------------

template <int D> void Glance<D>::compare(const Point<D> &p, int begin, int end) {
    std::array<Column::Prefix, page_vertices<D>> others;
    for (int axis = 0; axis < D; ++axis) {
        const Column &ranks = view_.ranks(axis);
        const Column::Prefix own = ranks.prefix(ordered(p[axis]));
        ranks.prefixes(static_cast<std::size_t>(begin), static_cast<std::size_t>(end),
                       &others[begin]);
        const int below = 1 << 2 * axis, above = 2 << 2 * axis;
        for (int v = begin; v < end; ++v) {
            const int side = (others[v] < own ? below : 0) | (others[v] > own ? above : 0);
            sides_[v] = static_cast<Side>(axis == 0 ? side : sides_[v] | side);
        }
    }
}

template <int D> bool Glance<D>::contains(int simplex, const Point<D> &p) {
    if (view_.is_ghost(simplex)) return false;
    for (int i = 0; i <= D; ++i) view_.read_point(view_.corner(simplex, i));
    return in_simplex<D>(corners_of(view_, simplex), p) > 0;
}

template <int D> int Glance<D>::search(const Point<D> &p) {
    constexpr int at_once = 64; // simplices
    sides_[view_.vertices()] = static_cast<Side>(-1);
    for (int s = 0, compared = 0; s < view_.simplices();) {
        const int end = view_.read_simplices(s + at_once);
        compare(p, std::exchange(compared, view_.vertices_read()), view_.vertices_read());
        for (; s < end; ++s) {
            const Lanes &corners = view_.corners(s);
            unsigned common = sides_[corners[0]];
            for (int i = 1; i <= D; ++i) common &= sides_[corners[i]];
            if (common == 0 && contains(s, p)) return s;
        }
    }
    return -1;
}

template class Glance<2>;
template class Glance<3>;

} // namespace abacus
