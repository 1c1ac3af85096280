// Cuts the points along the curve into intervals, one for each thread.
//
// A point near a border is put off, so borders should be short. The border between two parts of the
// curve is that of the cells where it is cut: the coarser the cell, the shorter the border (one
// edge of the domain where the curve is halved, many edges where it is cut at an arbitrary place).
// So each border is moved, within a share of what a thread gets, to the coarsest cell there is.
#pragma once

#include "change/interval.hpp"

#include <algorithm>
#include <bit>

namespace abacus {

/// Intervals that cover the curve, one after the other, by their first codes.
class Cuts {
public:
    explicit Cuts(const Memory &memory) : first_(memory) { first_.push_back(0); }

    std::size_t size() const { return first_.size(); }
    std::uint64_t first(std::size_t i) const { return first_[i]; }
    std::uint64_t last(std::size_t i) const {
        return (i + 1 < size() ? first_[i + 1] : key_word_end) - 1;
    }
    /// The one that a code is in.
    std::size_t interval(std::uint64_t code) const {
        return static_cast<std::size_t>(std::upper_bound(first_.begin(), first_.end(), code) -
                                        first_.begin()) -
               1;
    }
    /// The first point of a run of a batch that is in the interval, or behind it.
    std::size_t begin(std::size_t i, const Batch &batch, std::size_t run) const {
        return batch.first_from(first_[i], run);
    }
    std::size_t end(std::size_t i, const Batch &batch, std::size_t run) const {
        return i + 1 < size() ? begin(i + 1, batch, run) : batch.run_end(run);
    }

    /// At most this many intervals, each with about as many points.
    void cut_evenly(const Batch &batch, std::size_t intervals) {
        const std::size_t n = batch.size(), share = n / intervals, leeway = share / 32;
        for (std::size_t i = 1; i < intervals; ++i) {
            const std::uint64_t low = std::max(first_.back(), code_at(batch, share * i - leeway)),
                                high = code_at(batch, std::min(share * i + leeway, n - 1));
            if (low >= high) continue; // one code, whose points stay together
            // The border above `low`, up to `high`, that ends in most zeros.
            const int zeros = std::bit_width(low ^ high) - 1;
            first_.push_back(high >> zeros << zeros);
        }
    }
    /// For tests: cuts anywhere, into intervals of any length, with this many points on average of
    /// the largest run.
    void cut_at_random(const Batch &batch, std::size_t points) {
        std::size_t run = 0;
        for (std::size_t other = 1; other < batch.runs(); ++other)
            if (batch.run_size(other) > batch.run_size(run)) run = other;
        const std::size_t end = batch.run_end(run);
        std::uint64_t state = batch.run_size(run);
        for (std::size_t i = batch.run_begin(run);;) {
            state = (state ^ state >> 29) * 0xd6e8feb86659fd93 + 1;
            i += 1 + (state >> 40) % (2 * points);
            if (i >= end) return;
            if (batch.code(i) > first_.back()) first_.push_back(batch.code(i));
        }
    }
    /// Joins the intervals in pairs.
    void join_pairs() {
        for (std::size_t i = 0; 2 * i < size(); ++i) first_[i] = first_[2 * i];
        first_.resize((size() + 1) / 2);
    }

private:
    /// The code that has this many points of all runs before it, or at it after others.
    std::uint64_t code_at(const Batch &batch, std::size_t rank) const {
        std::uint64_t code = 0;
        for (std::uint64_t bit = std::bit_floor(key_word_end - 1); bit > 0; bit >>= 1) {
            std::size_t before = 0;
            for (std::size_t run = 0; run < batch.runs(); ++run)
                before += batch.first_from(code | bit, run) - batch.run_begin(run);
            if (before <= rank) code |= bit;
        }
        return code;
    }

    Arena<std::uint64_t> first_;
};

} // namespace abacus
