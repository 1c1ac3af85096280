// Decides when removing points one by one costs more than triangulating those that are left.
//
// The cost of a removal is the number of simplices in its star and in the hole. That is a
// few hundred nanoseconds in the plane, but a second if a vertex has a million neighbours, which
// its neighbours then inherit. The cost is not known in advance. So the cost of the removals so far
// is counted, in simplices made and destroyed, and that of the others is estimated from the last
// ones. A new triangulation of n points makes at most D + 1 times as many simplices as it ends
// with, and destroys most of them. The present mesh shows how many it will end with.
//
// Let s be the cost so far, r the expected cost of the rest, and b that of the new
// triangulation. The triangulation is worth it as soon as 4 s r > b². For removals that all
// cost the same, this never holds if all of them cost less than b; otherwise, the more they
// cost, the sooner it holds. The total is at most 1.5 times the best possible cost, and 1.1 times
// where there is much to gain. The more has been spent, the sooner it gives up.
#pragma once

#include <algorithm>
#include <atomic>
#include <cstdint>
#include <mutex>

namespace abacus {

template <int D> class Outlay {
public:
    /// For removing this many points from a mesh of this many vertices and simplices.
    Outlay(std::uint64_t points, std::uint64_t vertices, std::uint64_t simplices)
        : left_(static_cast<double>(points)) {
        const auto n = static_cast<double>(vertices);
        const double a_vertex = 2 * (D + 1) * static_cast<double>(simplices) / std::max(n, 1.0);
        anew_ = std::max(0.0, n - left_) * a_vertex + n * to_read + left_ * to_look_up;
    }

    /// Notes that `done` more points are done, and their cost `effort`. Returns whether a new mesh
    /// without the others is cheaper.
    bool is_too_much(std::uint64_t effort, std::uint64_t done) {
        const auto points = static_cast<double>(done), cost = static_cast<double>(effort);
        spent_ += cost;
        left_ -= points;
        const double each = cost / points;
        recent_ = recent_ < 0 ? each : recent_ + (each - recent_) * std::min(points / memory, 1.0);
        return 4 * spent_ * left_ * recent_ > anew_ * anew_;
    }

private:
    static constexpr double memory = 16; // points that count as the last ones
    /// The cost of reading a vertex from the mesh and sorting it, to find one that leaves.
    static constexpr double to_read = D == 2 ? 12 : 50, to_look_up = D == 2 ? 11 : 20;

    double spent_ = 0;
    double left_;        // points still to be removed
    double anew_;        // the cost of a new mesh
    double recent_ = -1; // the cost of one of the last points; negative: none yet
};

/// An outlay of several threads.
template <int D> class SharedOutlay {
public:
    explicit SharedOutlay(Outlay<D> &outlay) : outlay_(outlay) {}

    /// As Outlay::is_too_much().
    void add(std::uint64_t effort, std::uint64_t done) {
        const std::lock_guard guard(lock_);
        if (outlay_.is_too_much(effort, done)) is_too_much_ = true;
    }
    /// Whether it has been too much at any time.
    bool is_too_much() const { return is_too_much_.load(std::memory_order_relaxed); }

private:
    std::mutex lock_;
    Outlay<D> &outlay_;
    std::atomic<bool> is_too_much_ = false;
};

} // namespace abacus
