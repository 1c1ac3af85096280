// Which vertices are due for another look, by the cells of a coarse grid over the domain.
//
// A vertex has to be looked at again only if the simplex around it has changed. So the cells that
// the changed simplices' boxes meet are noted, which takes little memory and may note too many, but
// never too few: a coordinate's cell does not decrease with it.
#pragma once

#include "geometry/box.hpp"
#include "host/arena.hpp"
#include "keys/locational_code.hpp"

namespace abacus {

template <int D> class DueCells {
public:
    DueCells(const Memory &memory, const Domain<D> &domain) : domain_(domain), words_(memory) {
        words_.resize((std::size_t{1} << (D * bits)) / word_bits);
        clear();
    }

    void clear() { set_all(0); }
    void fill() { set_all(~std::uint64_t{0}); }
    void add(const Point<D> &p) {
        const std::size_t at = number(cell(p));
        words_[at / word_bits] |= bit(at);
    }
    /// All cells that a box meets.
    void add(const Box<D> &box) {
        each_row(box, [&](std::size_t first, std::size_t last) {
            for (std::size_t word = first / word_bits; word <= last / word_bits; ++word)
                words_[word] |= mask(word, first, last);
            return true;
        });
    }
    bool has(const Point<D> &p) const {
        const std::size_t at = number(cell(p));
        return (words_[at / word_bits] & bit(at)) != 0;
    }
    /// Whether one of the cells that a box meets is there.
    bool meets(const Box<D> &box) const {
        return !each_row(box, [&](std::size_t first, std::size_t last) {
            for (std::size_t word = first / word_bits; word <= last / word_bits; ++word)
                if ((words_[word] & mask(word, first, last)) != 0) return false;
            return true;
        });
    }
    void swap(DueCells &other) { words_.swap(other.words_); }

private:
    static constexpr int bits = D == 2 ? 11 : 7; // of a coordinate
    static constexpr std::size_t word_bits = 64;

    static std::uint64_t bit(std::size_t at) { return std::uint64_t{1} << (at % word_bits); }
    /// The bits of a word from `first` to `last`, which are numbers of cells.
    static std::uint64_t mask(std::size_t word, std::size_t first, std::size_t last) {
        std::uint64_t mask = ~std::uint64_t{0};
        if (word == first / word_bits) mask &= ~std::uint64_t{0} << (first % word_bits);
        if (word == last / word_bits)
            mask &= ~std::uint64_t{0} >> (word_bits - 1 - last % word_bits);
        return mask;
    }
    void set_all(std::uint64_t word) { std::fill(words_.begin(), words_.end(), word); }
    Cell<D> cell(const Point<D> &p) const {
        Cell<D> cell = domain_.cell(p);
        for (auto &coordinate : cell) coordinate >>= code_bits<D> - bits;
        return cell;
    }
    static std::size_t number(const Cell<D> &cell) {
        std::size_t number = 0;
        for (int axis = D - 1; axis >= 0; --axis) number = number << bits | cell[axis];
        return number;
    }
    /// Calls row(first, last) for the rows of the cells that a box meets, until it returns false.
    template <class Row> bool each_row(const Box<D> &box, Row row) const {
        const Cell<D> lower = cell(box.lower), upper = cell(box.upper);
        Cell<D> at = lower;
        for (;;) {
            at[0] = lower[0];
            const std::size_t first = number(at);
            if (!row(first, first + (upper[0] - lower[0]))) return false;
            int axis = 1;
            while (axis < D && at[axis] == upper[axis]) {
                at[axis] = lower[axis];
                ++axis;
            }
            if (axis == D) return true;
            ++at[axis];
        }
    }

    const Domain<D> domain_;
    Arena<std::uint64_t> words_;
};

} // namespace abacus
