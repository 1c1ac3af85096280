// What one thread inserts: points along an interval of the curve, with a cache of its own.
//
// The interval begins and ends where pages do, and the thread loads no page of another one. So it
// shares nothing with others, takes no lock, and pays nothing where it finds a simplex in its
// cache. Where a search would leave the interval, the point is put off.
//
// Why that is right:
//
//   Inside. A cavity that was found has been searched without leaving the interval. So its
//   simplices and those beyond its rim are the interval's. A new simplex has vertices of one that
//   it replaces, and the point. Its key is the greatest code of these: at least the point's, and
//   no greater than that of the other simplex or of the point. So it belongs to the interval, too.
//
//   Outside. A simplex with a neighbour in another interval is never replaced, since the search
//   would have looked at that neighbour. So what a page of another interval says of it, its key,
//   stays true, and so does what it says of its neighbour.
//
//   All together. Each interval's mesh is that of the whole with the points of all intervals
//   inserted one after the other, in any order: no insertion reads what one in another interval
//   changes. The triangulation is unique, so its simplices do not depend on the intervals.
//
// If one of several equal points is put off, those after it are: of equal points the first in
// order is the vertex.
#pragma once

#include "delaunay/insertion.hpp"

#include <abacus/header.h>

#include <atomic>

namespace abacus {

/// Records along the curve, with their codes.
class Batch {
public:
    Batch(const Memory &memory, std::size_t stride)
        : stride_(stride), records_(memory), codes_(memory) {}

    void add(const std::uint64_t *record, std::uint64_t code) {
        std::uint64_t *to = records_.extend(stride_);
        for (std::size_t word = 0; word < stride_; ++word) to[word] = record[word];
        codes_.push_back(code);
    }
    void reserve(std::size_t points) {
        records_.reserve(points * stride_);
        codes_.reserve(points);
    }
    std::size_t size() const { return codes_.size(); }
    /// What so many points take.
    std::size_t bytes(std::size_t points) const {
        return points * (stride_ + 1) * sizeof(std::uint64_t);
    }
    const std::uint64_t *record(std::size_t i) const { return records_.data() + i * stride_; }
    std::uint64_t code(std::size_t i) const { return codes_[i]; }
    const std::uint64_t *begin() const { return codes_.begin(); }
    const std::uint64_t *end() const { return codes_.end(); }
    /// Moves the i-th to the place of the n-th, which comes before it or is the same.
    void move(std::size_t i, std::size_t n) {
        if (i == n) return;
        std::copy_n(record(i), stride_, records_.data() + n * stride_);
        codes_[n] = codes_[i];
    }
    void shorten(std::size_t size) {
        records_.resize(size * stride_);
        codes_.resize(size);
    }
    /// Gives the memory back.
    void reset() {
        records_.reset();
        codes_.reset();
    }

private:
    const std::size_t stride_;
    Arena<std::uint64_t> records_, codes_;
};

template <int D> class Interval {
public:
    /// Of what became of points; by number in the batch.
    struct Results {
        explicit Results(const Memory &memory) : is_vertex(memory), put_off(memory) {}

        Arena<std::size_t> is_vertex, put_off;  // in order
        std::int64_t simplices = 0, ghosts = 0; // more than before
        std::uint64_t vertices = 0;
        std::uint64_t crowded = 0; // came where the domain does not fit
        abacus_counters counters{};
    };

    /// `header` is that of the whole mesh; pages begin at the codes `first` and `last + 1`.
    Interval(const Host &host, const abacus_header &header, std::uint64_t first, std::uint64_t last,
             std::size_t cache_bytes);

    /// Inserts points [from, to) of the batch, and writes all pages. Adds to `done` as it goes.
    void insert(const Batch &batch, std::size_t from, std::size_t to, bool counts_crowded,
                std::atomic<std::uint64_t> &done, Results &results);

private:
    const Host &host_;
    const std::int64_t simplices_, ghosts_; // of the whole mesh, before
    Cache<D> cache_;
    Delaunay<D> mesh_;
    Insertion<D> insertion_;
};

extern template class Interval<2>;
extern template class Interval<3>;

} // namespace abacus
