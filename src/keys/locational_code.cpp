// Parts of keys: computed only where a block lies inside one code.
//
// No fixed number of bits below the code would do for every cluster, since doubles resolve places
// over a thousand octaves. But simplices that share a page should be near one another, measured by
// their own size. The greatest vertex does not count in this, since very many simplices may have
// only that one in common: a hub. So a part is the place of the simplex's least vertex on a grid.
// The grid has the size of the facet opposite the greatest vertex, in steps of 512. First comes the
// coarse place, hashed; a coarse cell's stretch of the curve holds many pages' worth of simplices.
// Then comes the place inside it. A hash of the vertices distinguishes the remaining simplices.
#include "keys/locational_code.hpp"

namespace abacus {

namespace {

/// Bits of a part.
constexpr int coarse_bits = 16;
template <int D> constexpr int place_bits = D == 2 ? 16 : 12; // per axis
/// Cells of the grid along the size of a simplex, as a power of two. So neighbours that differ by
/// much less than their size, as around an edge, still come in order.
template <int D> constexpr int fine_bits = D == 2 ? 3 : 0;
template <int D> constexpr int hash_bits = 63 - coarse_bits - D *place_bits<D>;

class Hash {
public:
    void add(double x) {
        value_ = (value_ ^ std::bit_cast<std::uint64_t>(x + 0.0)) * 0x9e3779b97f4a7c15ull;
        value_ ^= value_ >> 29;
    }
    std::uint64_t value() const { return value_; }

private:
    std::uint64_t value_ = 0;
};

// The C library's functions for these take more time than all the rest.

/// Largest e with 2^e <= x; at least the least exponent of a normal number.
int exponent(double x) {
    return std::max(1, static_cast<int>(std::bit_cast<std::uint64_t>(x) >> 52 & 0x7ff)) - 1023;
}
/// 2^e, or the normal number nearest to it.
double power(int e) {
    return std::bit_cast<double>(std::uint64_t(std::clamp(e + 1023, 1, 2046)) << 52);
}
double floor_of(double x) {
    if (!(std::fabs(x) < 0x1p62)) return x; // an integer, infinite or NaN
    const auto whole = static_cast<double>(static_cast<std::int64_t>(x));
    return whole > x ? whole - 1 : whole;
}

std::uint64_t leading(std::uint64_t value, int bits) {
    return value * 0xd6e8feb86659fd93ull >> (64 - bits);
}

} // namespace

template <int D>
std::uint64_t Domain<D>::part(const std::array<const Point<D> *, D + 1> &corners,
                              const std::array<std::uint64_t, D + 1> &codes, int n) {
    int least = 0, greatest = 0;
    std::uint64_t hash = 0;
    const auto less = [&](int i, int j) {
        return codes[i] < codes[j] ||
               (codes[i] == codes[j] && lexicographically_less<D>(*corners[i], *corners[j]));
    };
    for (int i = 0; i < n; ++i) {
        if (less(i, least)) least = i;
        if (less(greatest, i)) greatest = i;
        Hash h;
        for (const double x : *corners[i]) h.add(x);
        hash += h.value(); // a sum: the same for every order of the corners
    }

    // The greatest vertex does not count, except where a ghost's edge has no other.
    const auto counts = [&](int i) { return i != greatest || n == 2; };
    // Coordinates are divided by 4, so that no difference overflows. If they are so small that
    // steps might not be normal numbers, whose inverses would overflow, they are multiplied by 2^72
    // as well: a multiple of nine octaves.
    double extent = 0;
    for (int i = 0; i < n; ++i)
        for (int axis = 0; axis < D; ++axis)
            if (counts(i)) extent = std::max(extent, std::fabs((*corners[i])[axis]));
    const int raised = extent < 0x1p-900 ? 72 : 0;
    const double scale = raised != 0 ? 0x1p70 : 0.25;
    const auto scaled = [&](int i, int axis) { return scale * (*corners[i])[axis]; };
    double size = std::numeric_limits<double>::denorm_min();
    for (int i = 0; i < n; ++i)
        for (int axis = 0; axis < D; ++axis)
            if (counts(i)) size = std::max(size, std::fabs(scaled(i, axis) - scaled(least, axis)));
    // A power of two.
    const int unit = static_cast<int>(floor_of(exponent(size) / 9.0)) * 9 - fine_bits<D>;
    const double cells = power(-unit);

    Hash coarse;
    coarse.add(unit - raised);
    Cell<D> place;
    constexpr double places = 1u << place_bits<D>;
    for (int axis = 0; axis < D; ++axis) {
        const double at = floor_of(scaled(least, axis) * cells);
        const double corner = floor_of(at / places);
        coarse.add(corner);
        place[axis] = static_cast<std::uint32_t>(clamp(at - corner * places, places - 1));
    }
    const std::uint64_t part =
        leading(coarse.value(), coarse_bits) << (D * place_bits<D>) | morton<D>(place);
    return part << hash_bits<D> | leading(hash, hash_bits<D>);
}

template class Domain<2>;
template class Domain<3>;

} // namespace abacus
