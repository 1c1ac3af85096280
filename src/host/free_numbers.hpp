// Numbers that were given back, to be taken again. The next one is the lowest from where the last
// was taken on; the search then goes around.
//
// Things that are evicted together were made together, so many of their numbers are in a row. Taken
// again in that order, they lead to memory in a row, which the processor fetches in advance. And
// things that are then made together lie together in turn. Last in, first out would shuffle them
// more with each round. In a build of 10 M points in the plane with 64 MB, a tenth of the time
// would go on waiting for the places of new vertices.
#pragma once

#include "host/arena.hpp"

#include <algorithm>
#include <bit>
#include <cstdint>

namespace abacus {

class FreeNumbers {
public:
    explicit FreeNumbers(const Host &host) : words_(host), summary_(host) {}

    bool empty() const { return count_ == 0; }
    std::size_t size() const { return count_; }

    /// A number that is not among them.
    void add(std::uint32_t number) {
        const std::size_t word = number / 64;
        if (word >= words_.size()) [[unlikely]]
            grow(word + 1);
        words_[word] |= bit(number);
        summary_[word / 64] |= bit(word);
        ++count_;
    }

    /// Takes one; there must be some.
    std::uint32_t take() {
        if (words_[at_] == 0) at_ = next_word();
        std::uint64_t &word = words_[at_];
        const auto number = static_cast<std::uint32_t>(at_ * 64 + std::countr_zero(word));
        word &= word - 1;
        if (word == 0) summary_[at_ / 64] &= ~bit(at_);
        --count_;
        return number;
    }

private:
    static std::uint64_t bit(std::size_t i) { return std::uint64_t{1} << i % 64; }

    /// The first word behind the current one, which is empty, that is not empty.
    std::size_t next_word() const {
        std::size_t i = at_ / 64;
        std::uint64_t words = summary_[i] & ~std::uint64_t{0} << at_ % 64;
        while (words == 0) {
            if (++i == summary_.size()) i = 0;
            words = summary_[i];
        }
        return i * 64 + std::countr_zero(words);
    }

    void grow(std::size_t words) {
        fill_up(words_, (words + 63) / 64 * 64);
        fill_up(summary_, words_.size() / 64);
    }
    static void fill_up(Arena<std::uint64_t> &words, std::size_t size) {
        const std::size_t old = words.size();
        words.resize(size);
        std::fill(words.begin() + old, words.end(), 0);
    }

    Arena<std::uint64_t> words_;   // a bit for each number
    Arena<std::uint64_t> summary_; // a bit for each word that is not empty
    std::size_t count_ = 0;
    std::size_t at_ = 0; // the word of the number taken last
};

} // namespace abacus
