// Finds the two new tetrahedra around each edge of a cavity's rim.
//
// One of the two facets that meet there sees the edge from a to b, the other from b to a. Every
// facet first stores its links under its edges, and then takes those under the reversed edges.
// Which of the two comes first is unpredictable but does not matter.
//
// The rim's vertices are numbered as they come. Most cavities have some twenty, and each edge
// between these has its own place in a small table. If the small table lacks room, as around a
// vertex with thousands of tetrahedra, edges are hashed. An entry is valid only in the insertion
// that made it, so both tables are empty at once for the next one.
#pragma once

#include "host/arena.hpp"
#include "mesh/simplex.hpp"
#include "mesh/vertex_heap.hpp"

#include <algorithm>
#include <bit>

namespace abacus {

class Ridges {
    /// A link below the number of the insertion that left it.
    using Entry = std::uint64_t;
    struct Hashed {
        std::uint64_t edge;
        std::array<Entry, 2> entry; // from the smaller to the greater number, and back
    };

    /// One insertion's view of a table. A value, for registers.
    template <class Find> class View {
    public:
        View(Find find, std::uint64_t epoch) : find_(find), epoch_(epoch << 32) {}

        /// The entry for this side of the edge from a to b. Throws if it is taken: then the cavity
        /// is not a ball.
        void add(std::uint32_t a, std::uint32_t b, Link link) const {
            Entry &entry = find_(a, b);
            if ((entry ^ epoch_) >> 32 == 0) [[unlikely]]
                throw_no_triangulation();
            entry = epoch_ | to_bits(link);
        }
        /// The link on the other side; throws if there is none.
        Link across(std::uint32_t a, std::uint32_t b) const {
            const Entry entry = find_(b, a);
            if ((entry ^ epoch_) >> 32 != 0) [[unlikely]]
                throw_no_triangulation();
            return Link{static_cast<std::uint32_t>(entry)};
        }

    private:
        Find find_;
        std::uint64_t epoch_;
    };

public:
    explicit Ridges(const Host &host) : table_(host), hashed_(host) {
        table_.resize(numbers * numbers);
        forget();
    }

    /// Calls fill(view) with empty tables, for this many links, in pairs, between this many
    /// vertices.
    template <class Fill> void pair(std::size_t links, std::size_t vertices, Fill fill) {
        if (++epoch_ == 0) forget(); // once in four billion insertions
        if (vertices <= numbers) [[likely]] {
            Entry *const table = table_.data();
            fill(View([table](std::uint32_t a,
                              std::uint32_t b) -> Entry & { return table[a * numbers + b]; },
                      epoch_));
            return;
        }
        const std::size_t size = std::bit_ceil(links + 1);
        if (hashed_.size() < size) {
            hashed_.resize(size);
            forget();
        }
        fill(View(
            [table = hashed_.data(), mask = size - 1, epoch = epoch_](std::uint32_t a,
                                                                      std::uint32_t b) -> Entry & {
                const std::uint64_t edge = std::uint64_t(std::min(a, b)) << 32 | std::max(a, b);
                std::size_t at = (edge * 0x9e3779b97f4a7c15ull >> 32) & mask;
                const auto is_taken = [&](const Hashed &hashed) {
                    return hashed.entry[0] >> 32 == epoch || hashed.entry[1] >> 32 == epoch;
                };
                while (is_taken(table[at]) && table[at].edge != edge) at = (at + 1) & mask;
                table[at].edge = edge;
                return table[at].entry[a > b];
            },
            epoch_));
    }

private:
    static constexpr std::uint32_t numbers = 64;

    void forget() {
        std::fill(table_.begin(), table_.end(), Entry{});
        std::fill(hashed_.begin(), hashed_.end(), Hashed{});
        epoch_ = 1;
    }

    Arena<Entry> table_;
    Arena<Hashed> hashed_;
    std::uint32_t epoch_ = 1;
};

} // namespace abacus
