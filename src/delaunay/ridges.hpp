// Finds the two new tetrahedra around each edge of a cavity's rim.
//
// The rim's vertices are numbered as they come. Most cavities have some twenty, so the
// edges between the first of them have places of their own in a small table; those of a
// vertex with thousands of tetrahedra go on in a hash table. Both are empty at once for
// the next insertion: an entry counts only in the one that made it.
#pragma once

#include "cache/vertex_heap.hpp"
#include "host/arena.hpp"
#include "mesh/simplex.hpp"

#include <bit>
#include <utility>

namespace abacus {

class Ridges {
public:
    static constexpr Link unmatched = 0xffffffffu;

    explicit Ridges(const Host &host) : table_(host), hashed_(host) {
        table_.resize(numbers * numbers);
        forget();
    }

    /// Empties the tables, for `links` links in pairs.
    void reset(std::size_t links) {
        const std::size_t size = std::bit_ceil(links + 1);
        if (hashed_.size() < size) {
            hashed_.resize(size);
            forget();
        }
        mask_ = size - 1;
        if (++epoch_ == 0) forget(); // once in four billion insertions
    }

    /// The link given before for the edge between two numbers, or `unmatched` when this
    /// is the first. Throws when there are more than two: the cavity is no ball then.
    Link match(std::uint32_t a, std::uint32_t b, Link link) {
        if (a > b) std::swap(a, b);
        Entry &entry = b < numbers ? table_[a * numbers + b] : hashed(a, b);
        if (entry.epoch != epoch_) {
            entry.epoch = epoch_;
            entry.link = link;
            return unmatched;
        }
        if (entry.link == unmatched)
            throw_corrupted("The simplices around a point are not a triangulation.");
        return std::exchange(entry.link, unmatched);
    }

private:
    static constexpr std::uint32_t numbers = 64;

    struct Entry {
        std::uint32_t epoch;
        Link link;
    };
    struct Hashed {
        std::uint64_t edge;
        Entry entry;
    };

    Entry &hashed(std::uint32_t a, std::uint32_t b) {
        const std::uint64_t edge = std::uint64_t(a) << 32 | b;
        std::size_t at = (edge * 0x9e3779b97f4a7c15ull >> 32) & mask_;
        while (hashed_[at].entry.epoch == epoch_ && hashed_[at].edge != edge)
            at = (at + 1) & mask_;
        hashed_[at].edge = edge;
        return hashed_[at].entry;
    }
    void forget() {
        std::fill(table_.begin(), table_.end(), Entry{});
        std::fill(hashed_.begin(), hashed_.end(), Hashed{});
        epoch_ = 1;
    }

    Arena<Entry> table_;
    Arena<Hashed> hashed_;
    std::size_t mask_ = 0;
    std::uint32_t epoch_ = 1;
};

} // namespace abacus
