// The points that a mesh starts with: the first affinely independent ones, since no
// mesh of fewer dimensions is kept. They depend on the order of the points alone.
#pragma once

#include "geometry/predicates.hpp"

#include <algorithm>
#include <cstdint>

namespace abacus {

template <int D> class FirstSimplex {
public:
    FirstSimplex() {
        for (int i = 0; i <= D; ++i) corners_[i] = &points_[i];
    }
    FirstSimplex(const FirstSimplex &) = delete;
    FirstSimplex &operator=(const FirstSimplex &) = delete;

    /// Takes the next point, which has this number; true if the simplex is complete.
    bool offer(const Point<D> &p, std::uint64_t number) {
        if (!is_complete() && is_independent(corners_, n_, p)) {
            points_[n_] = p;
            numbers_[n_++] = number;
        }
        return is_complete();
    }
    bool is_complete() const { return n_ == D + 1; }
    bool contains(std::uint64_t number) const {
        return std::find(numbers_.begin(), numbers_.begin() + n_, number) != numbers_.begin() + n_;
    }
    /// The number of the i-th corner; these ascend.
    std::uint64_t number(int i) const { return numbers_[i]; }

private:
    int n_ = 0;
    std::array<Point<D>, D + 1> points_;
    std::array<std::uint64_t, D + 1> numbers_;
    Corners<D> corners_;
};

} // namespace abacus
