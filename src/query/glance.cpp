#include "query/glance.hpp"

#include "query/page_simplex.hpp"

#include <cmath>
#include <cstring>
#include <functional>
#include <limits>
#include <utility>

namespace abacus {

// ---- Where to look --------------------------------------------------------------------

template <int D>
bool Glance<D>::find(std::uint64_t &code, const Point<D> &p, abacus_simplex &simplex) {
    looks_ = 0;
    if (!in_order_) held_[0].upper = {}; // its bytes were the host's, for a while
    KnownPage own; // a copy: others will be added
    if (const Held *const held = find_held(code)) {
        own = held->page;
    } else if (const KnownPage *const known = known_.find(code)) {
        own = *known;
    } else { // then it is not known either how far to look around
        if (is_cached(code)) return false;
        const Outcome outcome = look(code, nullptr, p, simplex);
        if (outcome != Outcome::not_here) return outcome == Outcome::found;
        own = find_held(code)->page;
    }
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
            if (find_held(code) == nullptr && std::all_of(codes.begin(), codes.end(), is_here))
                return false;
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

template <int D> typename Glance<D>::Held *Glance<D>::find_held(std::uint64_t code) {
    const Key key{code, 0};
    for (Held &held : held_)
        if (held.lower <= key && key < held.upper) return &held;
    return nullptr;
}

template <int D>
typename Glance<D>::Held &Glance<D>::hold(std::uint64_t code, const abacus_page &page,
                                          const KnownPage *known) {
    const auto used_before = [](const Held &a, const Held &b) { return a.last_use < b.last_use; };
    Held &held =
        in_order_ ? *std::min_element(held_.begin(), held_.end(), used_before) : held_[0];
    ++pages_read_;
    held.upper = {}; // no page's, until all went well
    held.asked = 0;
    held.prefixed = 0;
    held.has_boxes = false;
    PageView<D> &view = held.view;
    const unsigned char *bytes = page.bytes;
    if (in_order_) {
        std::memcpy(held.bytes.data(), bytes, std::min(page.size, held.bytes.size()));
        bytes = held.bytes.data();
    }
    view.open(bytes, page.size, cache_.vertices().attribute_count());
    if (!(view.lower() == page.key)) throw_corrupted("A page is stored under another page's key.");
    if (const Key key{code, 0}; key < view.lower() || view.upper() <= key)
        throw_corrupted("No page owns a part of the curve.");
    const bool is_known = known != nullptr && known->location == page.location &&
                          known->bytes == page.bytes;
    held.page = is_known ? *known
                         : KnownPage{view.lower().code, view.upper().code, page.location,
                                     spacing(view), page.bytes};
    if (!is_known && view.lower().part == 0) known_.learn(held.page);
    held.lower = view.lower();
    held.upper = view.upper();
    return held;
}

template <int D>
typename Glance<D>::Outcome Glance<D>::look(std::uint64_t code, const KnownPage *known,
                                            const Point<D> &p, abacus_simplex &simplex) {
    Held *held = find_held(code);
    if (held == nullptr) {
        abacus_page page{};
        if (!fetch(code, known, page)) return Outcome::not_now;
        if (!in_order_ && looks_ == 0 && was_seen(page.key)) return Outcome::not_now;
        held = &hold(code, page, known);
    }
    held->last_use = ++uses_;
    ++held->asked;
    looked_[looks_++] = {held->lower, held->upper};

    const int number = search(*held, p);
    if (number == nowhere) return Outcome::not_here;
    if (number == on_facet) return Outcome::not_now;
    describe(held->view, number, cache_.domain(), simplex);
    return Outcome::found;
}

template <int D> double Glance<D>::spacing(const PageView<D> &view) {
    // Of points at random; some of the page's vertices are other pages', too.
    constexpr double simplices_per_vertex = D == 2 ? 2 : 6.77;
    constexpr std::uint64_t end = std::uint64_t{1} << (D * code_bits<D>);
    const double cells = static_cast<double>(std::min(view.upper().code, end)) -
                         static_cast<double>(std::min(view.lower().code, end));
    const double cells_per_vertex = cells * simplices_per_vertex / std::max(view.simplices(), 1);
    return D == 2 ? std::sqrt(cells_per_vertex) : std::cbrt(cells_per_vertex);
}

// ---- In a page ------------------------------------------------------------------------

template <int D> void Glance<D>::read_prefixes(Held &held, int end) {
    if (held.prefixed >= end) return;
    for (int axis = 0; axis < D; ++axis)
        held.view.ranks(axis).prefixes(static_cast<std::size_t>(held.prefixed),
                                       static_cast<std::size_t>(end),
                                       &held.prefixes[axis][held.prefixed]);
    held.prefixed = end;
}

template <int D> void Glance<D>::compare(Held &held, const Point<D> &p, int begin, int end) {
    read_prefixes(held, end);
    for (int axis = 0; axis < D; ++axis) {
        const auto &prefixes = held.prefixes[axis];
        const Prefix own = held.view.ranks(axis).prefix(ordered(p[axis]));
        const int below = 1 << 2 * axis, above = 2 << 2 * axis;
        for (int v = begin; v < end; ++v) {
            const int side = (prefixes[v] < own ? below : 0) | (prefixes[v] > own ? above : 0);
            sides_[v] = static_cast<Side>(axis == 0 ? side : sides_[v] | side);
        }
    }
}

template <int D> int Glance<D>::position(PageView<D> &view, int simplex, const Point<D> &p) {
    if (view.is_ghost(simplex)) return -1;
    for (int i = 0; i <= D; ++i) view.read_point(view.corner(simplex, i));
    return in_simplex<D>(corners_of(view, simplex), p);
}

template <int D> int Glance<D>::search_and_read(Held &held, const Point<D> &p) {
    constexpr int at_once = 64; // simplices
    PageView<D> &view = held.view;
    sides_[view.vertices()] = static_cast<Side>(-1);
    for (int s = 0, compared = 0; s < view.simplices();) {
        const int end = view.read_simplices(s + at_once);
        compare(held, p, std::exchange(compared, view.vertices_read()), view.vertices_read());
        for (; s < end; ++s) {
            const Lanes &corners = view.corners(s);
            unsigned common = sides_[corners[0]];
            for (int i = 1; i <= D; ++i) common &= sides_[corners[i]];
            if (common != 0) continue;
            const int inside = position(view, s, p);
            if (inside >= 0) return inside > 0 ? s : on_facet;
        }
    }
    return nowhere;
}

template <int D> void Glance<D>::make_boxes(Held &held) {
    constexpr auto most = std::numeric_limits<Prefix>::max(), least = Prefix(~most);
    PageView<D> &view = held.view;
    const int n = view.read_simplices(view.simplices());
    read_prefixes(held, view.vertices());
    for (int axis = 0; axis < D; ++axis) {
        const auto &prefixes = held.prefixes[axis];
        auto &lower = held.boxes.lower[axis], &upper = held.boxes.upper[axis];
        for (int s = 0; s < n; ++s) {
            const Lanes &corners = view.corners(s);
            Prefix below = most, above = least;
            for (int i = 0; i <= D && !view.is_ghost(s); ++i) {
                below = std::min(below, prefixes[corners[i]]);
                above = std::max(above, prefixes[corners[i]]);
            }
            lower[s] = below;
            upper[s] = above;
        }
        std::fill_n(&lower[n], Boxes::at_once, most);
        std::fill_n(&upper[n], Boxes::at_once, least);
    }
    held.has_boxes = true;
}

template <int D> int Glance<D>::search_boxes(Held &held, const Point<D> &p) {
    if (!held.has_boxes) make_boxes(held);
    std::array<PrefixLanes, D> own;
    for (int axis = 0; axis < D; ++axis)
        own[axis] = PrefixLanes{} + held.view.ranks(axis).prefix(ordered(p[axis]));
    const auto load = [](const Prefix *from) {
        PrefixLanes lanes;
        std::memcpy(&lanes, from, sizeof lanes);
        return lanes;
    };
    for (int first = 0; first < held.view.simplices(); first += Boxes::at_once) {
        PrefixLanes within = PrefixLanes{} - 1;
        for (int axis = 0; axis < D; ++axis)
            within &= (load(&held.boxes.lower[axis][first]) <= own[axis]) &
                      (own[axis] <= load(&held.boxes.upper[axis][first]));
        const auto halves = std::bit_cast<std::array<std::uint64_t, 2>>(within);
        if ((halves[0] | halves[1]) == 0) continue;
        for (int i = 0; i < Boxes::at_once; ++i) {
            if (within[i] == 0) continue;
            const int inside = position(held.view, first + i, p);
            if (inside >= 0) return inside > 0 ? first + i : on_facet;
        }
    }
    return nowhere;
}

template class Glance<2>;
template class Glance<3>;

} // namespace abacus
