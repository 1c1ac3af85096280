#include "query/corner_numbers.hpp"

#include "mesh/bit_column.hpp"

#include <algorithm>

namespace abacus {

void CornerNumbers::add(const Point<3> &a, const Point<3> &b) {
    const std::uint64_t place = edges_.size();
    std::uint64_t *word = edges_.add();
    for (const double x : a) *word++ = ordered(x);
    for (const double x : b) *word++ = ordered(x);
    *word = place;
}

void CornerNumbers::finish() {
    pacer_.begin(ABACUS_PHASE_SORTING, edges_.size());
    edges_.finish();
    std::array<std::uint64_t, edge_words> last{};
    std::uint64_t number = 0, done = 0;
    while (const std::uint64_t *edge = edges_.next()) {
        if (!std::equal(last.begin(), last.end(), edge)) {
            if (done > 0) ++number;
            std::copy_n(edge, edge_words, last.begin());
        }
        std::uint64_t *record = numbers_.add();
        record[0] = edge[edge_words];
        record[1] = number;
        if (++done % Pacer::stride == 0) pacer_.reached(done);
    }
    edges_.close();
    numbers_.finish();
}

} // namespace abacus
