#pragma once

#include "host/arena.hpp"
#include "mesh/simplex.hpp"

#include <bit>
#include <utility>

namespace abacus {

/// Finds the two new tetrahedra around each edge of a cavity's rim: a hash table made
/// for one insertion, large enough for a vertex with thousands of tetrahedra.
class Ridges {
public:
    static constexpr Link unmatched = 0xffffffffu;

    explicit Ridges(const Host &host) : entries_(host) {}

    /// Empties the table, for `links` links in pairs.
    void reset(std::size_t links) {
        const std::size_t size = std::bit_ceil(links + 1);
        if (entries_.size() < size) {
            entries_.resize(size);
            std::fill(entries_.begin(), entries_.end(), Entry{});
            epoch_ = 0;
        }
        mask_ = size - 1;
        if (++epoch_ == 0) { // once in four billion insertions
            std::fill(entries_.begin(), entries_.end(), Entry{});
            epoch_ = 1;
        }
    }

    /// The link given before for the edge ab, or `unmatched` when this is the first.
    /// Throws when there are more than two: the cavity is no ball then.
    Link match(VertexIndex a, VertexIndex b, Link link) {
        const std::uint64_t edge = a < b ? std::uint64_t(a) << 32 | b : std::uint64_t(b) << 32 | a;
        std::size_t at = (edge * 0x9e3779b97f4a7c15ull >> 32) & mask_;
        while (entries_[at].epoch == epoch_ && entries_[at].edge != edge) at = (at + 1) & mask_;
        Entry &entry = entries_[at];
        if (entry.epoch == epoch_) {
            if (entry.link == unmatched)
                throw_corrupted("The simplices around a point are not a triangulation.");
            return std::exchange(entry.link, unmatched);
        }
        entry = {edge, epoch_, link};
        return unmatched;
    }

private:
    struct Entry {
        std::uint64_t edge;
        std::uint32_t epoch;
        Link link;
    };
    Arena<Entry> entries_;
    std::size_t mask_ = 0;
    std::uint32_t epoch_ = 0;
};

} // namespace abacus
