// Where to cut a slice of the insertion order so that each part fits in memory.
//
// The cuts are quantiles of a sample. They never affect the order of the points, only
// how evenly the parts are filled. A part that comes out too full is cut again. This
// ends, since a cut leaves either fewer points or a narrower range of codes in each
// part: a code that is at several quantiles, or is the least of the range, becomes a
// part of its own.
#pragma once

#include "staging/sample.hpp"
#include "staging/slice.hpp"

#include <algorithm>

namespace abacus {

template <int D> class Splitters {
public:
    /// Cuts into about `parts` parts, at least two; at most two more for each round. With
    /// `more_rounds` the round of the points promoted most often stays one part: when more
    /// points come, it may become several.
    Splitters(const Host &host, const Slice<D> &slice, const Sample<D> &sample, unsigned parts,
              bool more_rounds = false);

    /// Number of parts.
    unsigned size() const { return first_part_[rounds_]; }

    unsigned part(const Point<D> &p) const {
        const unsigned round = slice_.rounds == nullptr ? 0 : slice_.rounds->round(p);
        const std::uint64_t code = slice_.domain.code(p);
        // The last lower end of a part of the round that is not above the code: one of those
        // that the code's cell meets, nearly always one or two.
        const std::uint16_t *cell = first_in_cell_.data() + round * (cells + 1) + cell_of(code);
        const std::uint64_t *end = lower_.data() + cell[0];
        unsigned count = cell[1] - cell[0] + 1u;
        while (count > 1) {
            const unsigned half = count / 2;
            end += end[half] <= code ? half : 0;
            count -= half;
        }
        return static_cast<unsigned>(end - lower_.data());
    }

    /// The slice that is one of the parts, and its round.
    Slice<D> slice(unsigned part) const;
    unsigned round(unsigned part) const {
        return static_cast<unsigned>(std::upper_bound(first_part_, first_part_ + rounds_, part) -
                                     first_part_ - 1);
    }

private:
    /// Equal stretches of the slice's range of codes.
    static constexpr unsigned cells = 2048;

    std::size_t cell_of(std::uint64_t code) const { return (code - slice_.lower) >> cell_shift_; }
    void cut_round(const std::uint64_t *codes, std::size_t n, unsigned parts);
    void list_cells();

    const Slice<D> &slice_;
    unsigned rounds_;
    unsigned first_part_[Rounds<D>::most + 1] = {};
    Arena<std::uint64_t> lower_; ///< of each part; ascending inside a round
    int cell_shift_;
    Arena<std::uint16_t> first_in_cell_; ///< of each round's cells and one more: the part there
};

extern template class Splitters<2>;
extern template class Splitters<3>;

} // namespace abacus
