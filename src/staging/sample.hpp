// A random sample of points of a stream whose length is not known, with a fixed seed: reservoir
// sampling that draws how many points to skip before the next one that it takes (Algorithm L of Li,
// Reservoir-sampling algorithms of time complexity O(n(1 + log(N/n))), 1994).
#pragma once

#include "geometry/point.hpp"
#include "host/arena.hpp"

#include <cmath>
#include <cstdint>

namespace abacus {

template <int D> class Sample {
public:
    Sample(const Host &host, std::size_t most) : points_(host), most_(most) {}

    void add(const Point<D> &point) {
        if (++seen_ < next_) return;
        if (points_.size() < most_) {
            points_.push_back(point);
            next_ = seen_ + 1;
            if (points_.size() < most_) return;
        } else {
            points_[below(most_)] = point;
        }
        skip();
    }
    void clear() {
        points_.clear();
        seen_ = next_ = 0;
        threshold_ = 1;
    }
    std::size_t size() const { return points_.size(); }
    /// Number of points that it stands for.
    std::uint64_t seen() const { return seen_; }
    const Point<D> *begin() const { return points_.begin(); }
    const Point<D> *end() const { return points_.end(); }

private:
    /// Of so many points that each have a random number the sample has those with the least, all of
    /// them below the threshold. Lowers it to the next one, and finds which point is below it.
    void skip() {
        threshold_ *= std::exp(std::log(uniform()) / static_cast<double>(most_));
        const double skipped = std::floor(std::log(uniform()) / std::log1p(-threshold_));
        next_ = skipped < 0x1p62 ? seen_ + 1 + static_cast<std::uint64_t>(skipped) : UINT64_MAX;
    }
    /// Above 0 and below 1.
    double uniform() { return (static_cast<double>(random() >> 12) + 0.5) * 0x1p-52; }
    std::uint64_t below(std::uint64_t n) {
        return static_cast<std::uint64_t>(static_cast<unsigned __int128>(random()) * n >> 64);
    }
    /// splitmix64
    std::uint64_t random() {
        std::uint64_t z = state_ += 0x9e3779b97f4a7c15;
        z = (z ^ z >> 30) * 0xbf58476d1ce4e5b9;
        z = (z ^ z >> 27) * 0x94d049bb133111eb;
        return z ^ z >> 31;
    }

    Arena<Point<D>> points_;
    const std::size_t most_;
    std::uint64_t seen_ = 0, next_ = 0; ///< points, and the number of the next one to be taken
    double threshold_ = 1;
    std::uint64_t state_ = 0;
};

} // namespace abacus
