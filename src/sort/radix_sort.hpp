// Sorts 64-bit words that hold a key in their upper bits and the number of a record in
// the lower ones, below the key. No two words are equal, so there is only one sorted
// order, and records with equal keys stay in the order of their numbers.
#pragma once

#include "sort/pacer.hpp"

#include <cstdint>

namespace abacus {

inline constexpr int index_bits = 31;
inline constexpr int key_bits = 64 - index_bits;
inline constexpr std::uint64_t index_mask = (std::uint64_t{1} << index_bits) - 1;

/// Sorts n words whose indices are ascending among equal keys. `scratch` has
/// room for n words. Returns where the result is: `words` or `scratch`.
std::uint64_t *radix_sort(std::uint64_t *words, std::uint64_t *scratch, std::size_t n,
                          const Pacer &pacer);

/// The same, of any n words, which are at `from` and will be at `to`.
void radix_sort_into(std::uint64_t *to, std::uint64_t *from, std::size_t n, const Pacer &pacer);

/// The same for small n, in place and without scratch.
void sort_few(std::uint64_t *words, std::size_t n);

/// Memory to sort one record: a word and its scratch.
inline constexpr std::size_t sort_bytes_per_record = 2 * sizeof(std::uint64_t);
/// Most records that can be sorted at once.
inline constexpr std::size_t most_sorted_records = index_mask;

/// Up to this many words, sort_few is faster.
inline constexpr std::size_t few = 768;

} // namespace abacus
