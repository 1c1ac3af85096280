// Simplices as users see them. The order of the corners in memory depends on the history of a
// simplex. The order that users see does not: positive orientation, the least corner first (by id,
// then coordinates), in 3D the second least next.
#pragma once

#include "geometry/point.hpp"
#include "mesh/fixed_facets.hpp"
#include "mesh/simplex.hpp"

#include <abacus/simplex.h>

#include <algorithm>

namespace abacus {

/// Even permutations of the corners, so that the orientation stays, found by which corners come
/// first: in the plane one determines the permutation, in space two.
template <int D> class EvenOrders {
public:
    using Order = std::array<std::uint8_t, D + 1>;

    constexpr EvenOrders() {
        Order order{};
        for (int i = 0; i <= D; ++i) order[i] = static_cast<std::uint8_t>(i);
        do {
            if (is_even(order)) orders_[order[0]][D == 2 ? 0 : order[1]] = order;
        } while (std::next_permutation(order.begin(), order.end()));
    }

    const Order &find(int first, int second) const { return orders_[first][D == 2 ? 0 : second]; }

private:
    std::array<std::array<Order, D == 2 ? 1 : D + 1>, D + 1> orders_{};
};
template <int D> inline constexpr EvenOrders<D> even_orders;

/// The corners in the order in which they are in memory; of a ghost the last one is not read.
template <int D> struct DescribedCorners {
    std::array<std::int64_t, D + 1> id;
    std::array<const Point<D> *, D + 1> point;
    RegionNumber region = no_region;
};

/// Returns which of the corners is returned first, second, and so on.
///
/// Which corner is the least is as unpredictable as a die: it is found without branches, and
/// corners are written directly to where they belong.
template <int D>
const typename EvenOrders<D>::Order &describe(const DescribedCorners<D> &corners,
                                              std::uint64_t code, bool ghost, abacus_simplex &out) {
    const auto lesser = [&](int i, int j) {
        bool is_less = corners.id[j] < corners.id[i];
        if (corners.id[i] == corners.id[j]) [[unlikely]]
            is_less = *corners.point[j] < *corners.point[i];
        return is_less ? j : i;
    };
    int first = 0, second = 0;
    if (ghost) { // the point at infinity stays last
        if constexpr (D == 3) first = lesser(lesser(0, 1), 2);
        second = (first + 1) % D;
    } else {
        first = lesser(lesser(0, 1), 2);
        if constexpr (D == 3) {
            first = lesser(first, 3);
            second = lesser(lesser((first + 1) % 4, (first + 2) % 4), (first + 3) % 4);
        }
    }
    out.code = code;
    out.region = corners.region;
    out.ghost = ghost;
    const auto &order = even_orders<D>.find(first, second);
    for (int i = 0; i < D + !ghost; ++i) {
        out.id[i] = corners.id[order[i]];
        std::copy_n(corners.point[order[i]]->begin(), D, out.corner[i]);
    }
    return order;
}

/// Order among the simplices that contain one point: by code, then ids, then corners.
template <int D> bool comes_before(const abacus_simplex &a, const abacus_simplex &b) {
    if (a.code != b.code) return a.code < b.code;
    for (int i = 0; i <= D; ++i)
        if (a.id[i] != b.id[i]) return a.id[i] < b.id[i];
    for (int i = 0; i <= D; ++i)
        if (const auto &p = a.corner[i], &q = b.corner[i]; !std::equal(p, p + D, q))
            return std::lexicographical_compare(p, p + D, q, q + D);
    return false;
}

} // namespace abacus
