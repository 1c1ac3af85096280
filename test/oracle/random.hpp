// std::mt19937_64 gives the same numbers everywhere; the distributions of the standard library
// don't, so these are our own.
#pragma once

#include <cstdint>
#include <random>
#include <utility>
#include <vector>

namespace abacus::oracle {

class Random {
public:
    explicit Random(std::uint64_t seed) : engine_(seed) {}
    std::uint64_t below(std::uint64_t n) { return engine_() % n; }
    double unit() { return double(engine_() >> 11) * 0x1p-53; }
    double between(double low, double high) { return low + (high - low) * unit(); }

    template <class T> void shuffle(std::vector<T> &items) {
        for (std::size_t i = items.size(); i > 1; --i) std::swap(items[i - 1], items[below(i)]);
    }

private:
    std::mt19937_64 engine_;
};

} // namespace abacus::oracle
