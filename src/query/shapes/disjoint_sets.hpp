// A partition of numbers into sets (union and find, Tarjan 1975).
#pragma once

#include "host/arena.hpp"

namespace abacus {

class DisjointSets {
public:
    explicit DisjointSets(const Memory &memory) : parent_(memory) {}

    /// Sets of one number each.
    void reset(std::size_t n) {
        parent_.resize(n);
        for (std::size_t i = 0; i < n; ++i) parent_[i] = static_cast<std::uint32_t>(i);
    }
    /// Adds a set; returns its number.
    std::uint32_t add() {
        const auto n = static_cast<std::uint32_t>(parent_.size());
        parent_.push_back(n);
        return n;
    }
    /// How many numbers there are.
    std::size_t size() const { return parent_.size(); }
    std::uint32_t find(std::uint32_t i) {
        while (parent_[i] != i) {
            parent_[i] = parent_[parent_[i]];
            i = parent_[i];
        }
        return i;
    }
    /// Joins two sets; the lesser of their names names the result. False if they are the same set.
    bool join(std::uint32_t a, std::uint32_t b) {
        a = find(a);
        b = find(b);
        if (a == b) return false;
        parent_[std::max(a, b)] = std::min(a, b);
        return true;
    }

private:
    Arena<std::uint32_t> parent_;
};

} // namespace abacus
