// What lines make of a simplex: which of its facets are fixed, by lines of which kind, and in which
// region it lies. Only meshes in the plane have lines.
#pragma once

#include <bit>
#include <cstdint>

namespace abacus {

/// A facet on hard lines and on soft ones is hard.
enum class Fixed : std::uint8_t { no, soft, hard };

/// Number of a region of the mesh. Regions end at fixed edges; ghosts are in none.
using RegionNumber = std::uint32_t;
inline constexpr RegionNumber no_region = 0, most_regions = (1u << 24) - 1;

template <int D> class FixedFacets {
public:
    /// Bits of each facet of a simplex: whether it is fixed and, in those above, whether it is
    /// soft.
    static constexpr int width = D + 1;
    static constexpr FixedFacets from_bits(unsigned bits, RegionNumber region = no_region) {
        FixedFacets facets;
        facets.bits_ = bits | region << region_shift;
        return facets;
    }
    /// Of the facets.
    constexpr unsigned bits() const { return bits_ & facet_bits; }
    constexpr RegionNumber region() const { return bits_ >> region_shift; }
    constexpr void set_region(RegionNumber region) { bits_ = bits() | region << region_shift; }

    /// Whether there is anything to be kept.
    constexpr bool any() const { return bits_ != 0; }
    constexpr bool any_soft() const { return bits() >> width != 0; }
    constexpr int count() const { return std::popcount(bits_ & mask); }
    constexpr int count_soft() const { return std::popcount(bits() >> width); }
    constexpr bool is_fixed(int facet) const { return (bits_ >> facet & 1) != 0; }
    constexpr Fixed operator[](int facet) const {
        if (!is_fixed(facet)) return Fixed::no;
        return (bits_ >> (facet + width) & 1) != 0 ? Fixed::soft : Fixed::hard;
    }
    constexpr void set(int facet, Fixed fixed) {
        const unsigned others = bits_ & ~(both << facet);
        const unsigned bits = fixed == Fixed::soft ? both : fixed == Fixed::hard ? 1u : 0u;
        bits_ = others | bits << facet;
    }
    /// Whether only facets that are fixed are soft.
    constexpr bool is_sound() const { return (bits() >> width & ~bits_) == 0; }
    constexpr bool operator==(const FixedFacets &) const = default;

private:
    static constexpr unsigned mask = (1u << width) - 1, both = 1u | 1u << width;
    static constexpr unsigned region_shift = 8, facet_bits = (1u << region_shift) - 1;

    std::uint32_t bits_ = 0;
};

} // namespace abacus
