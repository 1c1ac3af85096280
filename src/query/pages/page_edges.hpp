// The edges of a page met so far, by the numbers of their ends there.
#pragma once

#include "host/arena.hpp"
#include "mesh/simplex.hpp"

#include <bit>

namespace abacus {

class PageEdges {
public:
    explicit PageEdges(const Memory &memory) : slots_(memory), taken_(memory) {
        slots_.resize(slots);
        std::fill(slots_.begin(), slots_.end(), Slot{});
    }

    /// Forgets all edges.
    void clear() {
        for (const std::uint32_t i : taken_) slots_[i] = Slot{};
        taken_.clear();
    }
    std::size_t size() const { return taken_.size(); }
    /// The number of an edge, from 0 on; a new edge is added and gets the former size() as its
    /// number.
    std::size_t number(int from, int to) {
        const std::uint32_t key =
            (static_cast<std::uint32_t>(from) << 16 | static_cast<std::uint32_t>(to)) + 1;
        std::uint32_t i = key * 0x9e3779b1u >> (32 - std::bit_width(slots - 1));
        while (slots_[i].key != 0) {
            if (slots_[i].key == key) return slots_[i].number;
            i = (i + 1) & (slots - 1);
        }
        slots_[i] = {key, static_cast<std::uint32_t>(taken_.size())};
        taken_.push_back(i);
        return taken_.size() - 1;
    }

private:
    struct Slot {
        std::uint32_t key = 0; // 0: empty
        std::uint32_t number = 0;
    };
    /// Twice as many as all simplices of a page can have, at up to four each.
    static constexpr std::uint32_t slots = std::bit_ceil(2 * 4 * block_slots<3>);

    Arena<Slot> slots_;
    Arena<std::uint32_t> taken_;
};

} // namespace abacus
