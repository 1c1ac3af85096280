#include "sort/radix_sort.hpp"

#include <algorithm>
#include <cstring>
#include <utility>

namespace abacus {
namespace {

constexpr int digit_bits = 11;
constexpr int digits = key_bits / digit_bits;
static_assert(digits * digit_bits == key_bits);
constexpr std::size_t radix = std::size_t{1} << digit_bits;

std::size_t digit(std::uint64_t word, int number) {
    return (word >> (index_bits + number * digit_bits)) & (radix - 1);
}

} // namespace

std::uint64_t *radix_sort(std::uint64_t *words, std::uint64_t *scratch, std::size_t n,
                          const Pacer &pacer) {
    // n is below 2^index_bits, so 32 bits count.
    std::uint32_t count[digits][radix] = {};
    pacer.each_piece(n, [&](std::size_t begin, std::size_t end) {
        for (std::size_t i = begin; i < end; ++i)
            for (int d = 0; d < digits; ++d) ++count[d][digit(words[i], d)];
    });
    for (int d = 0; d < digits; ++d) {
        if (count[d][digit(words[0], d)] == n) continue; // all have the same digit
        std::uint32_t *at = count[d];
        std::uint32_t sum = 0;
        for (std::size_t i = 0; i < radix; ++i) sum += std::exchange(at[i], sum);
        pacer.each_piece(n, [&](std::size_t begin, std::size_t end) {
            for (std::size_t i = begin; i < end; ++i) {
                const std::uint64_t word = words[i];
                scratch[at[digit(word, d)]++] = word;
            }
        });
        std::swap(words, scratch);
    }
    return words;
}

void radix_sort_into(std::uint64_t *to, std::uint64_t *from, std::size_t n, const Pacer &pacer) {
    const std::uint64_t *sorted = n <= few ? from : radix_sort(from, to, n, pacer);
    if (sorted != to) std::memcpy(to, sorted, n * sizeof *to);
    if (n <= few) sort_few(to, n);
}

void sort_few(std::uint64_t *words, std::size_t n) {
    if (n > 24) {
        std::sort(words, words + n);
        return;
    }
    for (std::size_t i = 1; i < n; ++i) {
        const std::uint64_t word = words[i];
        std::size_t at = i;
        for (; at > 0 && words[at - 1] > word; --at) words[at] = words[at - 1];
        words[at] = word;
    }
}

} // namespace abacus
