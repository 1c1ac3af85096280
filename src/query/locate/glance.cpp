#include "query/locate/glance.hpp"

#include "query/pages/page_simplex.hpp"

#include <cmath>
#include <cstring>

namespace abacus {

// ---- Where to look --------------------------------------------------------------------

template <int D>
bool Glance<D>::find(std::uint64_t &code, const Point<D> &p, abacus_simplex &simplex,
                     CornerValues *values) {
    looks_ = 0;
    if (!in_order_) held_[0].upper = {}; // its bytes were borrowed from the host
    KnownPage own;                       // a copy, since others will be added
    if (const Held *const held = find_held(code)) {
        own = held->page;
    } else if (const KnownPage *const known = known_.find(code)) {
        own = *known;
    } else { // then it is also unknown how far to look around
        if (is_cached(code)) return false;
        const Outcome outcome = look(code, nullptr, p, simplex, values);
        if (outcome != Outcome::not_here) return outcome == Outcome::found;
        own = find_held(code)->page;
    }
    const Cell<D> cell = cache_.domain().cell(p);
    for (const double distance : distances) {
        Codes codes;
        add_along_axes(cell, distance * own.spacing, codes);
        const bool is_first = distance == distances[0];
        if (is_first)
            codes.add(code);
        else
            add_diagonally(cell, distance * own.spacing, codes);
        if (is_first) {
            code = *codes.begin();
            const auto is_here = [&](std::uint64_t c) { return is_cached(c); };
            if (find_held(code) == nullptr && std::all_of(codes.begin(), codes.end(), is_here))
                return false;
        }
        for (const std::uint64_t c : codes) {
            if (c < own.lower || has_looked(c)) continue;
            const Outcome outcome =
                look(c, c < own.upper ? &own : known_.find(c), p, simplex, values);
            if (outcome != Outcome::not_here) return outcome == Outcome::found;
        }
    }
    return false;
}

/// The code of the cell at a distance in a direction, or at the border of the domain.
template <int D>
static std::uint64_t code_at(const Cell<D> &cell, const std::array<int, D> &way, double distance) {
    constexpr std::int64_t last = (std::int64_t{1} << code_bits<D>)-1;
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
    return std::any_of(looked_.begin(), looked_.begin() + looks_,
                       [&](const auto &page) { return page.first <= key && key < page.second; });
}

template <int D> bool Glance<D>::was_seen(const Key &page) {
    for (const Key &seen : seen_)
        if (seen == page) return true;
    seen_[next_++ % remembered] = page;
    return false;
}

/// About the part of a page up to the end of the coordinates; the rest is read for one simplex
/// only.
static constexpr std::size_t searched_bytes = 4608;

template <int D>
bool Glance<D>::fetch(std::uint64_t code, const KnownPage *known, abacus_page &page) {
    const Host &host = cache_.host();
    if (known != nullptr) {
        page = {{}, known->bytes, searched_bytes, known->location};
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
    Held &held = in_order_ ? *std::min_element(held_.begin(), held_.end(), used_before) : held_[0];
    ++pages_read_;
    held.upper = {}; // no page, until everything has succeeded
    held.asked = 0;
    held.patches = 0;
    held.has_boxes = false;
    PageView<D> &view = held.view;
    const unsigned char *bytes = page.bytes;
    if (in_order_) {
        std::memcpy(held.bytes.data(), bytes, std::min(page.size, held.bytes.size()));
        bytes = held.bytes.data();
    }
    const bool is_known =
        known != nullptr && known->location == page.location && known->bytes == page.bytes;
    view.open(bytes, page.size, cache_.vertices().attribute_count(),
              is_known ? PageView<D>::Checksum::ignore : PageView<D>::Checksum::verify);
    if (!(view.lower() == page.key)) throw_corrupted("A page is stored under another page's key.");
    if (const Key key{code, 0}; key < view.lower() || view.upper() <= key)
        throw_corrupted("No page owns a part of the curve.");
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
                                            const Point<D> &p, abacus_simplex &simplex,
                                            CornerValues *values) {
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
    describe(held->view, number, cache_.domain(), simplex, values, vertex_values_);
    return Outcome::found;
}

template <int D> double Glance<D>::spacing(const PageView<D> &view) {
    // Of points at random; some of the page's vertices also belong to other pages.
    constexpr double simplices_per_vertex = D == 2 ? 2 : 6.77;
    constexpr std::uint64_t end = std::uint64_t{1} << (D * code_bits<D>);
    const double cells = static_cast<double>(std::min(view.upper().code, end)) -
                         static_cast<double>(std::min(view.lower().code, end));
    const double cells_per_vertex = cells * simplices_per_vertex / std::max(view.simplices(), 1);
    return D == 2 ? std::sqrt(cells_per_vertex) : std::cbrt(cells_per_vertex);
}

// ---- In a page ------------------------------------------------------------------------

template <int D> int Glance<D>::search(Held &held, const Point<D> &p) {
    const Prefixes own = SimplexBoxes<D>::place(held.view, p);
    return held.asked > worth_boxes ? search_boxes(held, p, own) : search_patches(held, p, own);
}

template <int D> void Glance<D>::read_patch(Held &held, int patch) {
    if ((held.patches >> patch & 1) != 0) return;
    held.view.read_patch(patch);
    held.patches |= std::uint64_t{1} << patch;
}

/// The side on which a coordinate lies, in the bits of its axis.
static unsigned side_of(Column::Prefix prefix, Column::Prefix own, int axis) {
    return (prefix < own ? 1u << 2 * axis : 0) | (prefix > own ? 2u << 2 * axis : 0);
}

template <int D> void Glance<D>::compare(const PageView<D> &view, int patch, const Prefixes &own) {
    const auto fresh = view.fresh_of(patch), named = view.named_of(patch);
    for (int axis = 0; axis < D; ++axis) {
        view.ranks(axis).prefixes(static_cast<std::size_t>(fresh.begin),
                                  static_cast<std::size_t>(fresh.end), prefixes_.data());
        for (int v = fresh.begin; v < fresh.end; ++v) {
            const unsigned side = side_of(prefixes_[v - fresh.begin], own[axis], axis);
            sides_[v] = static_cast<Side>(axis == 0 ? side : sides_[v] | side);
        }
    }
    for (int i = named.begin; i < named.end; ++i) {
        const int v = view.named(i);
        if (v >= fresh.begin) continue; // the point at infinity gets its side at the end
        unsigned side = 0;
        for (int axis = 0; axis < D; ++axis)
            side |=
                side_of(view.ranks(axis).prefix_at(static_cast<std::size_t>(v)), own[axis], axis);
        sides_[v] = static_cast<Side>(side);
    }
    sides_[view.vertices()] = static_cast<Side>(-1);
}

template <int D> int Glance<D>::position(PageView<D> &view, int simplex, const Point<D> &p) {
    if (view.is_ghost(simplex)) return -1;
    for (int i = 0; i <= D; ++i) {
        view.ask_for_id(view.corner(simplex, i)); // this is most likely the simplex
        view.read_point(view.corner(simplex, i));
    }
    return in_simplex<D>(corners_of(view, simplex), p);
}

template <int D> int Glance<D>::search_patches(Held &held, const Point<D> &p, const Prefixes &own) {
    PageView<D> &view = held.view;
    for (int patch = 0; patch < view.patches(); ++patch) {
        const PagePatch<D> &box = view.patch(patch);
        bool is_within = true;
        for (int axis = 0; axis < D; ++axis)
            is_within =
                is_within && box.least[axis] <= own[axis] && own[axis] <= box.greatest[axis];
        if (!is_within) continue;
        read_patch(held, patch);
        compare(view, patch, own);
        for (int s = view.simplices_of(patch).begin; s < view.simplices_of(patch).end; ++s) {
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
    for (int patch = 0; patch < held.view.patches(); ++patch) {
        read_patch(held, patch);
        held.boxes.make(held.view, patch);
    }
    held.has_boxes = true;
}

template <int D> int Glance<D>::search_boxes(Held &held, const Point<D> &p, const Prefixes &own) {
    if (!held.has_boxes) make_boxes(held);
    int found = nowhere;
    held.boxes.around(own, {0, held.view.simplices()}, [&](int simplex) {
        const int inside = position(held.view, simplex, p);
        if (inside >= 0) found = inside > 0 ? simplex : on_facet;
        return inside < 0;
    });
    return found;
}

template class Glance<2>;
template class Glance<3>;

} // namespace abacus
