// The Hilbert curve: a path through the cells of a grid that steps from each cell to a
// neighbour. So what is near on the curve is near in space, and the curve lacks the
// jumps of the Z-order. The cells of any octant are one stretch of it.
//
// A cell's place is found from the top level down. On each level the curve visits the
// 2^D octants in the order of a Gray code, reflected and rotated according to a state
// that the octant above hands down: where the curve enters, and along which axis it
// leaves (Hamilton, "Compact Hilbert Indices", 2006). A table does several levels at
// once.
#pragma once

#include <array>
#include <bit>
#include <cstdint>

namespace abacus {

template <int D> class Hilbert {
public:
    /// Place on the curve of a cell with so many bits a coordinate.
    template <int bits>
    static constexpr std::uint64_t place(const std::array<std::uint32_t, D> &cell) {
        std::uint64_t place = 0;
        std::uint32_t state = 0;
        for (int shift = (bits - 1) / levels * levels; shift >= 0; shift -= levels) {
            std::uint32_t group = 0;
            for (int i = 0; i < D; ++i) group |= (cell[i] >> shift & level_mask) << (i * levels);
            const std::uint32_t entry = table[state | group];
            place = place << group_bits | (entry & (group_size - 1));
            state = entry & ~(group_size - 1);
        }
        return place;
    }

private:
    static constexpr std::uint32_t octants = 1u << D;
    static constexpr int levels = D == 2 ? 4 : 2; // that the table does at once
    static constexpr std::uint32_t level_mask = (1u << levels) - 1;
    static constexpr int group_bits = D * levels;
    static constexpr std::uint32_t group_size = 1u << group_bits;
    static constexpr std::uint32_t states = octants * D;

    struct State {
        std::uint32_t entry; // octant in which the curve begins
        std::uint32_t axis;  // along which it leaves
    };

    static constexpr std::uint32_t rotated(std::uint32_t octant, std::uint32_t left) {
        return (octant << left % D | octant >> (D - left % D)) & (octants - 1);
    }
    static constexpr std::uint32_t gray(std::uint32_t n) { return n ^ n >> 1; }

    /// Number of an octant on the curve; the state becomes that inside it.
    static constexpr std::uint32_t descend(State &state, std::uint32_t octant) {
        const std::uint32_t turned = rotated(octant ^ state.entry, 2 * D - state.axis - 1);
        std::uint32_t number = 0;
        while (gray(number) != turned) ++number;
        const std::uint32_t entry = number == 0 ? 0 : gray((number - 1) / 2 * 2);
        const std::uint32_t axis = std::countr_one(number % 2 == 1 ? number
                                                   : number == 0   ? 0
                                                                   : number - 1);
        state.entry ^= rotated(entry, state.axis + 1);
        state.axis = (state.axis + axis + 1) % D;
        return number;
    }

    /// Octant of a group, which has some bits of each coordinate in turn.
    static constexpr std::uint32_t octant(std::uint32_t group, int level) {
        std::uint32_t octant = 0;
        for (int i = 0; i < D; ++i) octant |= (group >> (i * levels + level) & 1) << i;
        return octant;
    }

    /// For each state and group of octants: the group of their numbers, and above it the
    /// state below them.
    static constexpr auto table = [] {
        std::array<std::uint16_t, states * group_size> table{};
        for (std::uint32_t i = 0; i < table.size(); ++i) {
            State state{i / group_size / D, i / group_size % D};
            std::uint32_t numbers = 0;
            for (int level = levels - 1; level >= 0; --level)
                numbers = numbers << D | descend(state, octant(i, level));
            table[i] =
                static_cast<std::uint16_t>((state.entry * D + state.axis) * group_size | numbers);
        }
        return table;
    }();
};

} // namespace abacus
