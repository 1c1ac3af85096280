// Keys: order, and the ends of the curve.
#pragma once

#include <abacus/host_functions.h>

#include <cstdint>

namespace abacus {

using Key = abacus_key;

constexpr bool operator<(const Key &a, const Key &b) {
    return a.code < b.code || (a.code == b.code && a.part < b.part);
}
constexpr bool operator<=(const Key &a, const Key &b) { return !(b < a); }
constexpr bool operator==(const Key &a, const Key &b) {
    return a.code == b.code && a.part == b.part;
}

inline constexpr std::uint64_t key_word_end = 1ull << 63; // above every code and part
inline constexpr Key first_key{0, 0};
inline constexpr Key end_key{key_word_end, 0};

/// The greatest key below one that is not the first.
constexpr Key predecessor(const Key &key) {
    return key.part > 0 ? Key{key.code, key.part - 1} : Key{key.code - 1, key_word_end - 1};
}

/// Part of a link that was stored as a code alone.
inline constexpr std::uint64_t unknown_part = ~0ull;
/// Code of a link to a neighbour that has to be probed for.
inline constexpr std::uint64_t unknown_code = ~0ull;

} // namespace abacus
