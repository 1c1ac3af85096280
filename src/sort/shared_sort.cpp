#include "sort/shared_sort.hpp"

#include "host/arena.hpp"

#include <algorithm>
#include <utility>

namespace abacus {

namespace {

/// From this number of words on, threads are worth starting.
constexpr std::size_t worth_sharing = 1 << 16;
constexpr int shared_digit_bits = 11;
constexpr std::size_t shared_digits = std::size_t{1} << shared_digit_bits;
/// Pieces for each thread, so that no thread waits long for the last one.
constexpr std::size_t pieces_a_thread = 8;

/// Consecutive words whose leading digits belong together.
struct Piece {
    std::size_t begin, end;
};

/// Turns the counts of digits in each stretch into the places of the first word of each digit from
/// there. Adds pieces of whole digits, with at least this many words.
void place(Arena<std::uint32_t> &counts, std::size_t least, Arena<Piece> &pieces) {
    std::uint32_t sum = 0;
    std::size_t begin = 0;
    for (std::size_t digit = 0; digit < shared_digits; ++digit) {
        for (std::size_t at = digit; at < counts.size(); at += shared_digits)
            sum += std::exchange(counts[at], sum);
        if (sum - begin < least && digit + 1 < shared_digits) continue;
        if (sum > begin) pieces.push_back({begin, sum});
        begin = sum;
    }
}

} // namespace

bool SharedSort::is_worth_while(const Host &host, std::size_t n) {
    return host.threads() > 1 && (n >= worth_sharing || (host.has_tiny_intervals() && n > 1));
}

void SharedSort::sort(std::uint64_t *words, std::uint64_t *scratch, std::size_t n, int bits,
                      const Set &set, const Refine &refine) {
    const int shift = index_bits + std::max(0, bits - shared_digit_bits);
    Arena<std::uint32_t> counts(host_);
    counts.resize(stretches() * shared_digits);
    std::fill(counts.begin(), counts.end(), 0);
    each_stretch(n, [&](std::size_t stretch, std::size_t from, std::size_t to, const Host &host) {
        std::uint32_t *const count = counts.data() + stretch * shared_digits;
        Pacer(host).each_piece(to - from, [&](std::size_t begin, std::size_t end) {
            set(words, from + begin, from + end);
            for (std::size_t i = from + begin; i < from + end; ++i) ++count[words[i] >> shift];
        });
    });
    Arena<Piece> pieces(host_);
    place(counts, n / (stretches() * pieces_a_thread) + 1, pieces);
    each_stretch(n, [&](std::size_t stretch, std::size_t from, std::size_t to, const Host &host) {
        std::uint32_t *const at = counts.data() + stretch * shared_digits;
        Pacer(host).each_piece(to - from, [&](std::size_t begin, std::size_t end) {
            for (std::size_t i = from + begin; i < from + end; ++i)
                scratch[at[words[i] >> shift]++] = words[i];
        });
    });
    each(pieces.size(), [&](std::size_t i, const Host &host) {
        const Pacer pacer(host);
        const auto [begin, end] = pieces[i];
        radix_sort_into(words + begin, scratch + begin, end - begin, pacer);
        refine(begin, end, pacer);
    });
}

} // namespace abacus
