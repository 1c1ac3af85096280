// Finds the two new tetrahedra around each edge of a cavity's rim.
//
// Of the two facets that meet there one sees the edge from a to b, the other from b to a.
// So every facet leaves its links under its edges, and then takes those under the edges
// turned around: which of two comes first, a coin's toss, does not matter.
//
// The rim's vertices are numbered as they come. Most cavities have some twenty, so the
// edges between the first of them have places of their own in a small table; those of a
// vertex with thousands of tetrahedra go on in a hash table. Both are empty at once for
// the next insertion: an entry counts only in the one that made it.
#pragma once

#include "cache/vertex_heap.hpp"
#include "host/arena.hpp"
#include "mesh/simplex.hpp"

#include <algorithm>
#include <bit>

namespace abacus {

class Ridges {
public:
    explicit Ridges(const Host &host) : table_(host), hashed_(host) {
        table_.resize(numbers * numbers);
        forget();
    }

    /// Empties the tables, for so many links, in pairs.
    void reset(std::size_t links) {
        const std::size_t size = std::bit_ceil(links + 1);
        if (hashed_.size() < size) {
            hashed_.resize(size);
            forget();
        }
        mask_ = size - 1;
        if (++epoch_ == 0) forget(); // once in four billion insertions
    }

    /// What lies on this side of the edge from a to b. Throws when there is something: the
    /// cavity is no ball then.
    void add(std::uint32_t a, std::uint32_t b, Link link) {
        Entry &entry = at(a, b);
        if (entry.epoch == epoch_) [[unlikely]] refuse();
        entry = {epoch_, link};
    }
    /// What lies on the other side; throws when there is nothing.
    Link across(std::uint32_t a, std::uint32_t b) {
        const Entry &entry = at(b, a);
        if (entry.epoch != epoch_) [[unlikely]] refuse();
        return entry.link;
    }

private:
    static constexpr std::uint32_t numbers = 64;

    struct Entry {
        std::uint32_t epoch;
        Link link;
    };
    struct Hashed {
        std::uint64_t edge;
        std::array<Entry, 2> entry; // from the smaller to the greater number, and back
    };

    Entry &at(std::uint32_t a, std::uint32_t b) {
        return std::max(a, b) < numbers ? table_[a * numbers + b] : hashed(a, b);
    }
    [[gnu::noinline]] Entry &hashed(std::uint32_t a, std::uint32_t b) {
        const std::uint64_t edge = std::uint64_t(std::min(a, b)) << 32 | std::max(a, b);
        std::size_t at = (edge * 0x9e3779b97f4a7c15ull >> 32) & mask_;
        const auto is_taken = [&](const Hashed &hashed) {
            return hashed.entry[0].epoch == epoch_ || hashed.entry[1].epoch == epoch_;
        };
        while (is_taken(hashed_[at]) && hashed_[at].edge != edge) at = (at + 1) & mask_;
        hashed_[at].edge = edge;
        return hashed_[at].entry[a > b];
    }
    [[noreturn]] static void refuse() {
        throw_corrupted("The simplices around a point are not a triangulation.");
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
