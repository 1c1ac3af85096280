// A random sample of points of a stream whose length is not known (reservoir
// sampling), with a fixed seed.
#pragma once

#include "geometry/point.hpp"
#include "host/arena.hpp"

#include <cstdint>

namespace abacus {

template <int D> class Sample {
public:
    Sample(const Host &host, std::size_t most) : points_(host), most_(most) {}

    void add(const Point<D> &point) {
        ++seen_;
        if (points_.size() < most_) return points_.push_back(point);
        const std::uint64_t place = below(seen_);
        if (place < most_) points_[place] = point;
    }
    void clear() {
        points_.clear();
        seen_ = 0;
    }
    std::size_t size() const { return points_.size(); }
    /// Number of points that it stands for.
    std::uint64_t seen() const { return seen_; }
    const Point<D> *begin() const { return points_.begin(); }
    const Point<D> *end() const { return points_.end(); }

private:
    /// A random number below n: splitmix64, scaled.
    std::uint64_t below(std::uint64_t n) {
        std::uint64_t z = state_ += 0x9e3779b97f4a7c15;
        z = (z ^ z >> 30) * 0xbf58476d1ce4e5b9;
        z = (z ^ z >> 27) * 0x94d049bb133111eb;
        z ^= z >> 31;
        return static_cast<std::uint64_t>(static_cast<unsigned __int128>(z) * n >> 64);
    }

    Arena<Point<D>> points_;
    const std::size_t most_;
    std::uint64_t seen_ = 0;
    std::uint64_t state_ = 0;
};

} // namespace abacus
