#include "sort/dense_ranks.hpp"

#include <algorithm>

namespace abacus {

DenseRanks::DenseRanks(const Host &host, std::size_t key, std::size_t memory)
    : key_(key), pacer_(host), last_(host), names_(host, key + 1, key, memory / 2),
      ranks_(host, 2, 1, memory / 2) {}

std::uint64_t *DenseRanks::add() {
    const std::uint64_t place = names_.size();
    std::uint64_t *const name = names_.add();
    name[key_] = place;
    return name;
}

std::uint64_t DenseRanks::finish() {
    pacer_.begin(ABACUS_PHASE_SORTING, names_.size());
    names_.finish();
    ranks_.expect(static_cast<double>(names_.size()));
    last_.resize(key_);
    std::uint64_t count = 0, done = 0;
    while (const std::uint64_t *name = names_.next()) {
        if (count == 0 || !std::equal(last_.begin(), last_.end(), name)) {
            ++count;
            std::copy_n(name, key_, last_.begin());
        }
        std::uint64_t *const rank = ranks_.add();
        rank[0] = name[key_];
        rank[1] = count - 1;
        if (++done % Pacer::stride == 0) pacer_.reached(done);
    }
    names_.close();
    ranks_.finish();
    return count;
}

} // namespace abacus
