// The directory of cached intervals: blocks in the order of their lower keys.
//
// A sorted array in pieces, as the leaves of a B-tree are: an insertion moves at
// most half a piece of entries, and a search looks at the first keys of the pieces,
// which stay in the processor's cache, and then at one piece.
#pragma once

#include "host/arena.hpp"
#include "keys/key.hpp"

#include <algorithm>

namespace abacus {

/// `Index`: what blocks are numbered by.
template <class Index> class DirectoryOf {
public:
    static constexpr Index none{0xffffffffu};

    explicit DirectoryOf(const Host &host) : entries_(host), pieces_(host), unused_(host) {}

    /// The block with the greatest lower key <= key, or none.
    Index floor(const Key &key) const {
        return at([&](const Key &lower) { return !(key < lower); });
    }
    /// The block with the greatest lower key < key, or none.
    Index before(const Key &key) const {
        return at([&](const Key &lower) { return lower < key; });
    }
    /// The block with the least lower key > key, or none.
    Index after(const Key &key) const {
        for (std::size_t p = piece_of(key); p < pieces_.size(); ++p) {
            const Entry *first = begin(p), *last = first + pieces_[p].count;
            const Entry *entry =
                std::partition_point(first, last, [&](const Entry &e) { return !(key < e.lower); });
            if (entry != last) return entry->block;
        }
        return none;
    }
    bool contains(const Key &lower) const {
        if (pieces_.empty()) return false;
        const std::size_t p = piece_of(lower);
        const Entry *entry = find(p, lower);
        return entry != begin(p) + pieces_[p].count && entry->lower == lower;
    }

    void insert(const Key &lower, Index block) {
        if (pieces_.empty()) add_piece(0, lower);
        std::size_t p = piece_of(lower);
        if (pieces_[p].count == piece_size) {
            cut(p);
            p = piece_of(lower);
        }
        Entry *const to = find(p, lower), *const last = begin(p) + pieces_[p].count;
        std::copy_backward(to, last, last + 1);
        *to = {lower, block};
        ++pieces_[p].count;
        pieces_[p].first = begin(p)->lower;
    }
    void erase(const Key &lower) {
        const std::size_t p = piece_of(lower);
        Entry *const from = find(p, lower), *const last = begin(p) + pieces_[p].count;
        std::copy(from + 1, last, from);
        if (--pieces_[p].count > 0) {
            pieces_[p].first = begin(p)->lower;
            return;
        }
        unused_.push_back(pieces_[p].number);
        std::copy(pieces_.begin() + p + 1, pieces_.end(), pieces_.begin() + p);
        pieces_.pop_back();
    }

private:
    static constexpr std::size_t piece_size = 128;

    struct Entry {
        Key lower;
        Index block;
    };
    struct Piece {
        Key first;
        std::uint32_t number; // its entries lie at number * piece_size
        std::uint32_t count;
    };

    Entry *begin(std::size_t p) { return entries_.data() + pieces_[p].number * piece_size; }
    const Entry *begin(std::size_t p) const {
        return entries_.data() + pieces_[p].number * piece_size;
    }

    /// The last piece whose first key is <= key, or the first piece.
    std::size_t piece_of(const Key &key) const {
        const Piece *piece = std::partition_point(pieces_.begin(), pieces_.end(),
                                                  [&](const Piece &p) { return !(key < p.first); });
        return piece == pieces_.begin() ? 0 : static_cast<std::size_t>(piece - pieces_.begin()) - 1;
    }
    Entry *find(std::size_t p, const Key &lower) {
        return std::partition_point(begin(p), begin(p) + pieces_[p].count,
                                    [&](const Entry &e) { return e.lower < lower; });
    }
    const Entry *find(std::size_t p, const Key &lower) const {
        return const_cast<DirectoryOf *>(this)->find(p, lower);
    }

    /// The last block whose lower key is `low`.
    template <class Low> Index at(Low low) const {
        const Piece *piece = std::partition_point(pieces_.begin(), pieces_.end(),
                                                  [&](const Piece &p) { return low(p.first); });
        if (piece == pieces_.begin()) return none;
        const std::size_t p = static_cast<std::size_t>(piece - pieces_.begin()) - 1;
        const Entry *entry = std::partition_point(begin(p), begin(p) + pieces_[p].count,
                                                  [&](const Entry &e) { return low(e.lower); });
        return (entry - 1)->block;
    }

    void add_piece(std::size_t p, Key first) { // a copy: it may be in entries_
        std::uint32_t number;
        if (!unused_.empty()) {
            number = unused_.back();
            unused_.pop_back();
        } else {
            number = static_cast<std::uint32_t>(entries_.size() / piece_size);
            entries_.resize(entries_.size() + piece_size);
        }
        pieces_.resize(pieces_.size() + 1);
        std::copy_backward(pieces_.begin() + p, pieces_.end() - 1, pieces_.end());
        pieces_[p] = {first, number, 0};
    }
    void cut(std::size_t p) {
        constexpr std::size_t half = piece_size / 2;
        add_piece(p + 1, (begin(p) + half)->lower);
        std::copy(begin(p) + half, begin(p) + piece_size, begin(p + 1));
        pieces_[p].count = half;
        pieces_[p + 1].count = piece_size - half;
    }

    Arena<Entry> entries_;
    Arena<Piece> pieces_;
    Arena<std::uint32_t> unused_;
};

/// With numbers of the caller's.
using Directory = DirectoryOf<std::uint32_t>;

} // namespace abacus
