// Parts of keys: computed only where a block lies inside one code.
#include "geometry/locational_code.hpp"

namespace abacus {

template <int D> Cell<D> Domain<D>::inner_cell(const Point<D> &p) const {
    constexpr double cells_inside = static_cast<double>(1u << inner_bits<D>);
    Cell<D> result;
    for (int i = 0; i < D; ++i) {
        const double t = (p[i] * scale_ - origin_[i]) * factor_;
        const double zero = -origin_[i] * factor_;
        if (std::floor(t) == std::floor(zero)) {
            const auto bits = std::bit_cast<std::uint64_t>(p[i] + 0.0);
            const auto ordered = bits >> 63 ? ~bits : bits | 1ull << 63;
            result[i] = static_cast<std::uint32_t>(ordered >> (64 - inner_bits<D>));
        } else {
            const double rest = (t - std::floor(t)) * cells_inside;
            result[i] = static_cast<std::uint32_t>(clamp(rest, cells_inside - 1));
        }
    }
    return result;
}

template <int D>
std::uint64_t Domain<D>::part(const std::array<const Point<D> *, D + 1> &corners, int n) const {
    int greatest = 0;
    std::uint64_t code = 0, inner = 0, hash = 0;
    for (int i = 0; i < n; ++i) {
        const Point<D> &p = *corners[i];
        const std::uint64_t c = this->code(p), in = morton<D>(inner_cell(p));
        const auto order = [&] { return lexicographically_less<D>(*corners[greatest], p); };
        if (c > code || (c == code && (in > inner || (in == inner && order())))) {
            greatest = i;
            code = c;
            inner = in;
        }
        std::uint64_t h = 0;
        for (const double x : p) {
            h = (h ^ std::bit_cast<std::uint64_t>(x + 0.0)) * 0x9e3779b97f4a7c15ull;
            h ^= h >> 29;
        }
        hash += h; // a sum: the same for every order of the corners
    }

    // The mean of the others as seen from the greatest, in units of the largest
    // distance: the star of a vertex with very many simplices lies in order around it.
    // Integers again, so that the order of the summands does not matter; a quarter of
    // the coordinates, so that no difference overflows.
    const auto offset = [&](int i, int axis) {
        return 0.25 * (*corners[i])[axis] - 0.25 * (*corners[greatest])[axis];
    };
    double largest = 0;
    for (int i = 0; i < n; ++i)
        for (int axis = 0; axis < D; ++axis)
            largest = std::max(largest, std::fabs(offset(i, axis)));
    Cell<D> around{};
    if (largest > 0)
        for (int axis = 0; axis < D; ++axis) {
            constexpr double middle = 1 << 20;
            std::uint32_t sum = 0;
            for (int i = 0; i < n; ++i)
                if (i != greatest)
                    sum += static_cast<std::uint32_t>(middle + offset(i, axis) / largest * (middle - 1));
            around[axis] = sum / (n - 1) >> (21 - around_bits<D>);
        }

    constexpr int hash_bits = 63 - D * (inner_bits<D> + around_bits<D>);
    hash *= 0xd6e8feb86659fd93ull;
    return inner << (63 - D * inner_bits<D>) | morton<D>(around) << hash_bits |
           hash >> (64 - hash_bits);
}

template class Domain<2>;
template class Domain<3>;

} // namespace abacus
