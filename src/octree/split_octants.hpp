// Octants that are split, level by level: what an octree is, without its leaves.
//
// An octree is the set of its octants that have children. The set holds the parent of each of its
// members. Points, sizes, balance and the tree that there is each ask for some octants to be split;
// all of them together are the union of such sets, and that is the least octree that serves
// all. Its leaves follow from it in one pass along the curve (next_leaf()).
//
// The codes of each level lie in a spool, in order. So a set is made, united and read
// from beginning to end, and its size does not show in memory.
#pragma once

#include "octree/octant.hpp"
#include "sort/record_spool.hpp"

#include <array>
#include <optional>

namespace abacus {

template <int D> class SplitOctants {
public:
    static constexpr std::uint64_t none = ~std::uint64_t{0};

    explicit SplitOctants(const Host &host) : host_(host) {}

    /// Splits whatever has the cell, until it is in an octant of this level. Cells come in order.
    void split_to(std::uint64_t cell, int level) {
        // Whose ancestor is split already, its own ancestors are.
        while (--level >= 0) {
            const std::uint64_t code = Octant<D>{cell, finest_level<D>}.ancestor(level).code;
            if (levels_[level] && last_[level] == code) return;
            add(level, code);
        }
    }
    /// Of a level, in the order of the curve.
    void add(int level, std::uint64_t code) {
        if (!levels_[level]) levels_[level].emplace(host_, 1);
        *levels_[level]->add() = last_[level] = code;
        ++size_;
    }

    /// Ends adding, or goes back to the beginning.
    void rewind() {
        for (int level = 0; level < finest_level<D>; ++level) {
            if (levels_[level]) levels_[level]->rewind();
            pop(level);
        }
        cell_ = 0;
    }
    /// The next one of a level, none after the last; for set operations.
    std::uint64_t head(int level) const { return heads_[level]; }
    void pop(int level) {
        const std::uint64_t *const record = levels_[level] ? levels_[level]->next() : nullptr;
        heads_[level] = record != nullptr ? *record : none;
    }
    /// The next leaf along the curve; false after the last.
    bool next_leaf(Octant<D> &leaf) {
        if (cell_ == domain_cells<D>) return false;
        int level = coarsest_level<D>(cell_);
        while (level < finest_level<D> && heads_[level] == cell_) pop(level++);
        leaf = {cell_, level};
        cell_ = leaf.end();
        return true;
    }
    /// One above the deepest level that has a member.
    int depth() const {
        int depth = finest_level<D>;
        while (depth > 0 && !levels_[depth - 1]) --depth;
        return depth;
    }
    std::uint64_t size() const { return size_; }
    /// Gives the spool of a level back.
    void close(int level) {
        if (levels_[level]) levels_[level]->close();
        levels_[level].reset();
        heads_[level] = none;
    }
    void close() {
        for (int level = 0; level < finest_level<D>; ++level) close(level);
    }

private:
    const Host &host_;
    std::array<std::optional<RecordSpool>, finest_level<D>> levels_;
    std::array<std::uint64_t, finest_level<D>> last_{}, heads_{};
    std::uint64_t size_ = 0;
    std::uint64_t cell_ = 0; // where the next leaf begins
};

/// Both of two rewound sets in a third one; closes the two.
template <int D> void unite(SplitOctants<D> &a, SplitOctants<D> &b, SplitOctants<D> &united) {
    for (int level = 0; level < finest_level<D>; ++level) {
        for (;;) {
            const std::uint64_t code = std::min(a.head(level), b.head(level));
            if (code == SplitOctants<D>::none) break;
            united.add(level, code);
            if (a.head(level) == code) a.pop(level);
            if (b.head(level) == code) b.pop(level);
        }
        a.close(level);
        b.close(level);
    }
}

} // namespace abacus
