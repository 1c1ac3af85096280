#include "query/glance.hpp"

#include "query/page_simplex.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

namespace abacus {

template <int D> bool Glance<D>::was_seen(const Key &page) {
    for (const Key &seen : seen_)
        if (seen == page) return true;
    seen_[next_++ % remembered] = page;
    return false;
}

template <int D> int Glance<D>::search(const Point<D> &p) const {
    for (int s = 0; s < view_.simplices(); ++s) {
        if (view_.is_ghost(s)) continue;
        const Corners<D> corners = corners_of(view_, s);
        // Nearly all are dismissed by their boxes.
        bool is_in_box = true;
        for (int axis = 0; axis < D; ++axis) {
            double least = (*corners[0])[axis], greatest = least;
            for (int i = 1; i <= D; ++i) {
                least = std::min(least, (*corners[i])[axis]);
                greatest = std::max(greatest, (*corners[i])[axis]);
            }
            is_in_box &= (least <= p[axis]) & (p[axis] <= greatest);
        }
        if (is_in_box && in_simplex<D>(corners, p) > 0) return s;
    }
    return -1;
}

template <int D>
bool Glance<D>::find(const Key &key, const Domain<D> &domain, const Point<D> &p,
                     abacus_simplex &simplex) {
    abacus_page page{};
    if (!host_.find(ABACUS_SIMPLEX_PAGES, key, page) || was_seen(page.key)) return false;
    return look_into(page, domain, p, simplex) || look_around(domain, p, simplex);
}

template <int D>
bool Glance<D>::look_around(const Domain<D> &domain, const Point<D> &p,
                            abacus_simplex &simplex) {
    constexpr std::array<double, 2> distances{1, 2.5}; // more gained nothing
    std::array<std::pair<Key, Key>, 1 + distances.size() * 2 * D> regions;
    regions[0] = {view_.lower(), view_.upper()};
    auto end = regions.begin() + 1;
    Point<D> spacing; // of the page's vertices
    for (int axis = 0; axis < D; ++axis)
        spacing[axis] =
            (view_.box(D + axis) - view_.box(axis)) / std::pow(view_.vertices(), 1.0 / D);
    for (const double distance : distances)
        for (int way = 0; way < 2 * D; ++way) {
            const int axis = way / 2;
            Point<D> q = p;
            q[axis] += (way % 2 == 0 ? distance : -distance) * spacing[axis];
            const Key key{domain.code(q), 0};
            const bool is_known = std::any_of(regions.begin(), end, [&](const auto &region) {
                return !(key < region.first) && key < region.second;
            });
            abacus_page page{};
            if (is_known || !host_.find(ABACUS_SIMPLEX_PAGES, key, page)) continue;
            if (look_into(page, domain, p, simplex)) return true;
            *end++ = {view_.lower(), view_.upper()};
        }
    return false;
}

template <int D>
bool Glance<D>::look_into(const abacus_page &page, const Domain<D> &domain, const Point<D> &p,
                          abacus_simplex &simplex) {
    view_.read(page.bytes, page.size, attributes_);
    if (!(view_.lower() == page.key)) throw_corrupted("A page is stored under another page's key.");
    const int number = search(p);
    if (number < 0) return false;
    describe(view_, number, domain, simplex);
    return true;
}

template class Glance<2>;
template class Glance<3>;

} // namespace abacus
