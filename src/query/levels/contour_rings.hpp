// Splits a closed path where it touches itself, so that each ring passes each of its points once.
//
// The outline of a band touches itself at vertices that lie exactly at a level, and runs out and
// back along edges that do. The path is followed from its beginning; whenever it reaches a point
// that it has passed, the part between is a ring, and is split off. A ring of one or two points, or
// without area, bounds nothing.
#pragma once

#include "geometry/point.hpp"
#include "host/arena.hpp"

#include <cstddef>

namespace abacus {

class ContourRings {
public:
    explicit ContourRings(const Host &host)
        : open_(host), slots_(host), places_(host), ring_(host) {}

    /// Calls ring(points) for each ring of a closed path; the last point is the first.
    template <class Ring> void each(const Arena<Point<2>> &path, Ring ring) {
        begin(path);
        for (std::size_t i = 0; i < path.size(); ++i) {
            std::size_t &place = places_[first_equal(path, i)];
            if (place < open_.size() && open_[place] == path[i]) {
                take(place);
                if (has_area()) ring(ring_);
            }
            place = open_.size();
            open_.push_back(path[i]);
        }
    }

private:
    static constexpr std::size_t none = ~std::size_t{0};

    void begin(const Arena<Point<2>> &path);
    /// The first point of the path that is equal to that one.
    std::size_t first_equal(const Arena<Point<2>> &path, std::size_t point);
    void take(std::size_t place);
    bool has_area() const;

    Arena<Point<2>> open_;      // passed, but in no ring yet
    Arena<std::size_t> slots_;  // points that are the first of their kind, hashed
    Arena<std::size_t> places_; // of each of them, the last one among the open ones
    Arena<Point<2>> ring_;
};

} // namespace abacus
