// Parts of keys: computed only where a block lies inside one code.
//
// No fixed number of bits below the code would do for every cluster: doubles have places
// a thousand octaves apart. But what shares a page should lie near one another as
// measured by its own size. So a part begins with the size of the simplex, in steps of
// eight, and with the place of its greatest vertex on a grid of that size: first the
// coarse place, hashed, whose stretch of the curve holds many pages' worth of simplices,
// then the place inside it. Around one vertex with very many simplices, the place of the
// others as seen from it follows. A hash of the vertices tells apart what is left.
#include "geometry/locational_code.hpp"

namespace abacus {

namespace {

/// Bits of a part.
template <int D> constexpr int coarse_bits = D == 2 ? 21 : 22;
template <int D> constexpr int place_bits = D == 2 ? 9 : 7;  // an axis
template <int D> constexpr int around_bits = D == 2 ? 9 : 4; // an axis
template <int D>
constexpr int hash_bits = 63 - coarse_bits<D> - D * (place_bits<D> + around_bits<D>);

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

std::uint64_t leading(std::uint64_t value, int bits) {
    return value * 0xd6e8feb86659fd93ull >> (64 - bits);
}

} // namespace

template <int D>
std::uint64_t Domain<D>::part(const std::array<const Point<D> *, D + 1> &corners, int n) const {
    int greatest = 0;
    std::uint64_t greatest_code = 0, hash = 0;
    for (int i = 0; i < n; ++i) {
        const Point<D> &p = *corners[i];
        const std::uint64_t code = this->code(p);
        if (code > greatest_code ||
            (code == greatest_code && lexicographically_less<D>(*corners[greatest], p))) {
            greatest = i;
            greatest_code = code;
        }
        Hash h;
        for (const double x : p) h.add(x);
        hash += h.value(); // a sum: the same for every order of the corners
    }

    // A quarter of the coordinates, so that no difference overflows.
    const auto quarter = [&](int i, int axis) { return 0.25 * (*corners[i])[axis]; };
    double size = std::numeric_limits<double>::denorm_min();
    for (int i = 0; i < n; ++i)
        for (int axis = 0; axis < D; ++axis)
            size = std::max(size, std::fabs(quarter(i, axis) - quarter(greatest, axis)));
    const int unit = static_cast<int>(std::floor(std::ilogb(size) / 3.0)) * 3; // a power of two

    Hash coarse;
    coarse.add(unit);
    Cell<D> place, around;
    constexpr double places = 1u << place_bits<D>;
    for (int axis = 0; axis < D; ++axis) {
        const double at = std::floor(std::ldexp(quarter(greatest, axis), -unit));
        const double corner = std::floor(at / places);
        coarse.add(corner);
        place[axis] = static_cast<std::uint32_t>(clamp(at - corner * places, places - 1));
        // Integers, so that the order of the summands does not matter.
        constexpr double middle = 1 << 20;
        std::uint32_t sum = 0;
        for (int i = 0; i < n; ++i)
            if (i != greatest)
                sum += static_cast<std::uint32_t>(
                    middle + (quarter(i, axis) - quarter(greatest, axis)) / size * (middle - 1));
        around[axis] = sum / (n - 1) >> (21 - around_bits<D>);
    }
    std::uint64_t part = leading(coarse.value(), coarse_bits<D>);
    part = part << (D * place_bits<D>) | morton<D>(place);
    part = part << (D * around_bits<D>) | morton<D>(around);
    return part << hash_bits<D> | leading(hash, hash_bits<D>);
}

template class Domain<2>;
template class Domain<3>;

} // namespace abacus
