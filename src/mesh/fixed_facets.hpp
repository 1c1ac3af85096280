// Which facets of a simplex are fixed, and by lines of which kind. Only meshes in the plane have
// any.
#pragma once

#include <bit>
#include <cstdint>

namespace abacus {

/// A facet on hard lines and on soft ones is hard.
enum class Fixed : std::uint8_t { no, soft, hard };

template <int D> class FixedFacets {
public:
    /// Bits of each facet of a simplex: whether it is fixed and, in those above, whether it is
    /// soft.
    static constexpr int width = D + 1;
    static constexpr FixedFacets from_bits(unsigned bits) {
        FixedFacets facets;
        facets.bits_ = static_cast<std::uint8_t>(bits);
        return facets;
    }
    constexpr unsigned bits() const { return bits_; }

    constexpr bool any() const { return bits_ != 0; }
    constexpr bool any_soft() const { return bits_ >> width != 0; }
    constexpr int count() const { return std::popcount(bits_ & mask); }
    constexpr int count_soft() const {
        return std::popcount(static_cast<unsigned>(bits_) >> width);
    }
    constexpr bool is_fixed(int facet) const { return (bits_ >> facet & 1) != 0; }
    constexpr Fixed operator[](int facet) const {
        if (!is_fixed(facet)) return Fixed::no;
        return (bits_ >> (facet + width) & 1) != 0 ? Fixed::soft : Fixed::hard;
    }
    constexpr void set(int facet, Fixed fixed) {
        const unsigned others = bits_ & ~(both << facet);
        const unsigned bits = fixed == Fixed::soft ? both : fixed == Fixed::hard ? 1u : 0u;
        bits_ = static_cast<std::uint8_t>(others | bits << facet);
    }
    /// Whether only facets that are fixed are soft.
    constexpr bool is_sound() const { return (bits_ >> width & ~bits_) == 0; }
    constexpr bool operator==(const FixedFacets &) const = default;

private:
    static constexpr unsigned mask = (1u << width) - 1, both = 1u | 1u << width;

    std::uint8_t bits_ = 0;
};

} // namespace abacus
