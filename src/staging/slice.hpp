// A slice of the insertion order: the points of one round, or of all rounds,
// whose locational codes lie in a range. The codes are those of the mesh's
// domain, or of a smaller box when the points share one code of the larger.
#pragma once

#include "geometry/box.hpp"
#include "keys/locational_code.hpp"
#include "sort/radix_sort.hpp"
#include "staging/rounds.hpp"

#include <bit>
#include <cstdint>

namespace abacus {

template <int D> struct Slice {
    static constexpr std::uint64_t last_code = (std::uint64_t{1} << (D * code_bits<D>)) - 1;

    Domain<D> domain;
    const Rounds<D> *rounds = nullptr; ///< set: the points of all rounds, not of one
    std::uint64_t lower = 0;           ///< range of codes, both ends included
    std::uint64_t upper = last_code;

    bool has_one_code() const { return rounds == nullptr && lower == upper; }

    /// The order of the slice, in two keys of at most key_bits bits. The second
    /// tells apart what the first does not, unless second_bits() is 0.
    std::uint64_t first_key(const Point<D> &p) const {
        const std::uint64_t key = (domain.code(p) - lower) >> second_bits();
        if (rounds == nullptr) return key;
        return std::uint64_t{rounds->round(p)} << (key_bits - round_bits) | key;
    }
    std::uint64_t second_key(const Point<D> &p) const {
        return (domain.code(p) - lower) & ((std::uint64_t{1} << second_bits()) - 1);
    }
    int first_bits() const {
        return rounds != nullptr ? key_bits
                                 : std::min<int>(key_bits, std::bit_width(upper - lower));
    }
    int second_bits() const {
        const int bits = std::bit_width(upper - lower);
        return std::max(0, bits - (rounds == nullptr ? key_bits : key_bits - round_bits));
    }
};
static_assert(2 * code_bits<2> - (key_bits - round_bits) <= key_bits);
static_assert(3 * code_bits<3> - (key_bits - round_bits) <= key_bits);

} // namespace abacus
