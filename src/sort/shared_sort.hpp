// Words sorted by several threads (for one thread, and what the words hold: radix_sort.hpp).
//
//   1  Each thread sets the words of one stretch, and counts their leading digits.
//   2  Each moves the words of its stretch to where the counts say: those with one leading digit
//      come together, in the order in which they were.
//   3  Digits that follow one another make a piece, with as many words as the others, more or less.
//      Whichever thread has nothing to do sorts the next piece.
//
// No two words are equal, so the result is that of one thread. Where most words have one leading
// digit, most of the work is one thread's.
#pragma once

#include "host/shared_loop.hpp"
#include "sort/pacer.hpp"
#include "sort/radix_sort.hpp"

#include <functional>

namespace abacus {

class SharedSort : public SharedLoop {
public:
    /// Sets the words [begin, end) at `to`; their numbers ascend. For any thread.
    using Set = std::function<void(std::uint64_t *to, std::size_t begin, std::size_t end)>;
    /// The words [begin, end) are in order, and have no key in common with any other. For any
    /// thread.
    using Refine = std::function<void(std::size_t begin, std::size_t end, const Pacer &)>;

    using SharedLoop::SharedLoop;

    /// Whether there are threads, and so many words that they are worth it.
    static bool is_worth_while(const Host &host, std::size_t n);
    bool is_worth_while(std::size_t n) const { return is_worth_while(host_, n); }
    /// Sorts n words, whose keys have so many bits at most, into `words`; `scratch` is as long.
    void sort(std::uint64_t *words, std::uint64_t *scratch, std::size_t n, int bits, const Set &set,
              const Refine &refine);
};

} // namespace abacus
