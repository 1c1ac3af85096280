#include "query/levels/contour_rings.hpp"

#include "geometry/exact_sum.hpp"

#include <bit>
#include <cstdint>

namespace abacus {

void ContourRings::begin(const Arena<Point<2>> &path) {
    open_.clear();
    slots_.resize(std::bit_ceil(2 * path.size()));
    std::fill(slots_.begin(), slots_.end(), none);
    places_.resize(path.size());
    std::fill(places_.begin(), places_.end(), none);
}

std::size_t ContourRings::first_equal(const Arena<Point<2>> &path, std::size_t point) {
    std::uint64_t hash = 0;
    for (const double x : path[point]) {
        hash = (hash ^ std::bit_cast<std::uint64_t>(x)) * 0x9e3779b97f4a7c15;
        hash ^= hash >> 29;
    }
    const std::size_t mask = slots_.size() - 1;
    for (std::size_t i = hash & mask;; i = (i + 1) & mask) {
        if (slots_[i] == none) return slots_[i] = point;
        if (path[slots_[i]] == path[point]) return slots_[i];
    }
}

/// Takes off the ring that begins and ends at an open point.
void ContourRings::take(std::size_t place) {
    ring_.clear();
    for (std::size_t i = place; i < open_.size(); ++i) ring_.push_back(open_[i]);
    ring_.push_back(ring_[0]);
    open_.resize(place);
}

/// Exact.
bool ContourRings::has_area() const {
    if (ring_.size() < 4) return false;
    WideSum twice;
    for (std::size_t i = 0; i + 1 < ring_.size(); ++i) {
        const Point<2> &a = ring_[i], &b = ring_[i + 1];
        add_product(twice, a[0], b[1]);
        add_product(twice, -b[0], a[1]);
    }
    return !twice.is_zero();
}

} // namespace abacus
