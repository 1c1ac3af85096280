// Who has attributes, and the keys under which they are found.
//
// A vertex is named by its place, and a simplex by those of its vertices, in the order of the
// coordinates. So an owner is a set of one or D + 1 points. What names it says nothing of
// pages, ids and neighbours: its attributes stay where they are while simplices move.
//
// Its key is the greatest code of its points, continued by a hash of their coordinates. The
// attributes of all owners of a kind are cut into groups, and each group has pages of its own, from
// one end of the curve to the other. So the first word of a key is the group, followed by the code,
// which goes on in the second word, followed by the hash.
#pragma once

#include "blocks/bit_column.hpp"
#include "geometry/point.hpp"
#include "host/error.hpp"
#include "keys/key.hpp"
#include "keys/locational_code.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <span>
#include <type_traits>

namespace abacus {

/// K points that name an owner, in lexicographic order.
template <int D, int K> using Owner = std::conditional_t<K == 1, Point<D>, std::array<Point<D>, K>>;

template <int D, int K> std::span<const Point<D>, K> points_of(const Owner<D, K> &owner) {
    if constexpr (K == 1)
        return std::span<const Point<D>, K>(&owner, 1);
    else
        return owner;
}

/// The owner whose points are given in any order.
template <int D, int K> Owner<D, K> owner_of(std::array<Point<D>, K> points) {
    std::sort(points.begin(), points.end(), lexicographically_less<D>);
    return points;
}

inline constexpr int attribute_hash_bits = 53, attribute_code_low_bits = 10;
/// Codes have 63 bits, a key's words as many.
inline constexpr int attribute_group_shift = 63 - attribute_code_low_bits;

/// The groups of each kind of attributes, of as many as a key has room for: those of vertices, the
/// labels of simplices, and the markers of their facets.
inline constexpr unsigned groups_of_kind = 256;
template <int K> inline constexpr unsigned first_group = K == 1 ? 0 : groups_of_kind;
inline constexpr unsigned marker_group = 2 * groups_of_kind;
/// The group behind those of the kind that begins with a group; the last kind has all others.
constexpr unsigned end_of_kind(unsigned first) {
    return first == marker_group ? 4 * groups_of_kind : first + groups_of_kind;
}

/// The least key of a group; also the end of the one before.
constexpr Key group_begin(unsigned group) {
    return {std::uint64_t{group} << attribute_group_shift, 0};
}
constexpr unsigned group_of(const Key &key) {
    return static_cast<unsigned>(key.code >> attribute_group_shift);
}

template <int D, int K> std::uint64_t hash_of(const Owner<D, K> &owner) {
    std::uint64_t h = 0;
    for (const Point<D> &p : points_of<D, K>(owner))
        for (const double x : p) {
            h = (h ^ std::bit_cast<std::uint64_t>(x)) * 0x9e3779b97f4a7c15ull;
            h ^= h >> 32;
        }
    h *= 0xff51afd7ed558ccdull;
    return h ^ h >> 29;
}

/// The code of an owner: the greatest of its points.
template <int D, int K> std::uint64_t code_of(const Domain<D> &domain, const Owner<D, K> &owner) {
    std::uint64_t greatest = 0;
    for (const Point<D> &p : points_of<D, K>(owner)) greatest = std::max(greatest, domain.code(p));
    return greatest;
}

/// The least key of a code in group 0, and the code of a key in any.
constexpr Key code_begin(std::uint64_t code) {
    constexpr std::uint64_t low = (std::uint64_t{1} << attribute_code_low_bits) - 1;
    return {code >> attribute_code_low_bits, (code & low) << attribute_hash_bits};
}
constexpr std::uint64_t code_of(const Key &key) {
    return (key.code & (group_begin(1).code - 1)) << attribute_code_low_bits |
           key.part >> attribute_hash_bits;
}

/// The key of an owner with this code, in group 0.
template <int D, int K = 1> Key attribute_key(const Owner<D, K> &owner, std::uint64_t code) {
    const Key begin = code_begin(code);
    return {begin.code, begin.part | hash_of<D, K>(owner) >> (64 - attribute_hash_bits)};
}
/// The same in another one.
constexpr Key in_group(const Key &key, unsigned group) {
    return {group_begin(group).code | key.code, key.part};
}

/// For standard algorithms.
struct KeyBefore {
    constexpr bool operator()(const Key &a, const Key &b) const { return a < b; }
};

/// Somebody has seen an owner that is nowhere among the attributes.
template <int D, int K> [[noreturn]] void throw_no_attributes() {
    throw_corrupted(K == 1 ? "A vertex has no attributes." : "A simplex has no attributes.");
}

/// A missing value, NULL in SQL, is NaN, as everywhere in the core.
inline constexpr double null_value = std::numeric_limits<double>::quiet_NaN();
/// Whether the double of that rank is NaN.
constexpr bool is_null(std::uint64_t rank) {
    constexpr double most = std::numeric_limits<double>::infinity();
    return rank < ordered(-most) || ordered(most) < rank;
}

/// Markers of facets are numbers that are integers of four bytes.
inline bool is_marker(double marker) {
    constexpr double least = std::numeric_limits<std::int32_t>::min(),
                     greatest = std::numeric_limits<std::int32_t>::max();
    return least <= marker && marker <= greatest && marker == std::trunc(marker);
}

} // namespace abacus
