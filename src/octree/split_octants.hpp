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

/// The octant of each level that was split last, where octants are split along the curve.
template <int D> class LastSplit {
public:
    LastSplit() { codes_.fill(~std::uint64_t{0}); }

    void set(int level, std::uint64_t code) { codes_[level] = code; }
    /// Calls add(level, code) for each octant that has to be split so that the cell is in one of
    /// this level. Cells come in order.
    template <class Add> void split_to(std::uint64_t cell, int level, Add add) {
        // Whose ancestor is split already, its own ancestors are.
        while (--level >= 0) {
            const std::uint64_t code = Octant<D>{cell, finest_level<D>}.ancestor(level).code;
            if (codes_[level] == code) return;
            codes_[level] = code;
            add(level, code);
        }
    }

private:
    std::array<std::uint64_t, finest_level<D>> codes_;
};

template <int D> class SplitOctants {
public:
    static constexpr std::uint64_t none = ~std::uint64_t{0};

    explicit SplitOctants(const Host &host) : host_(host) {}

    /// Splits whatever has the cell, until it is in an octant of this level. Cells come in order.
    void split_to(std::uint64_t cell, int level) {
        last_.split_to(cell, level, [this](int at, std::uint64_t code) { put(at, code); });
    }
    /// Of a level, in the order of the curve.
    void add(int level, std::uint64_t code) {
        last_.set(level, code);
        put(level, code);
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
    /// That so many octants of a level take in its spool: none if memory has room for them.
    static double spool_bytes(double octants) {
        return octants > RecordSpool::piece_bytes / 8 ? 8 * octants : 0;
    }
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
    void put(int level, std::uint64_t code) {
        if (!levels_[level]) levels_[level].emplace(host_, 1);
        *levels_[level]->add() = code;
        ++size_;
    }

    const Host &host_;
    std::array<std::optional<RecordSpool>, finest_level<D>> levels_;
    LastSplit<D> last_;
    std::array<std::uint64_t, finest_level<D>> heads_{};
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
