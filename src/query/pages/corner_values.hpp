// Values at the corners of a simplex: the one way in which queries read attributes.
#pragma once

#include <abacus/facts.h>

#include <array>
#include <cstdint>

namespace abacus {

/// The requested attributes, and their values at the corners of the last simplex returned, in the
/// order of its corners. A missing value is NaN.
class CornerValues {
public:
    /// Numbers of attributes of the mesh.
    CornerValues(const std::uint32_t *wanted, std::size_t count) : count_(count) {
        for (std::size_t n = 0; n < count; ++n) wanted_[n] = wanted[n];
    }

    std::size_t count() const { return count_; }
    double value(int corner, std::size_t n) const { return values_[corner * count_ + n]; }

    /// attribute(i): the i-th of all attributes of the vertex at this corner.
    template <class Attribute> void set(int corner, Attribute attribute) {
        for (std::size_t n = 0; n < count_; ++n)
            values_[corner * count_ + n] = attribute(static_cast<int>(wanted_[n]));
    }

private:
    std::size_t count_;
    std::array<std::uint32_t, ABACUS_MAX_ATTRIBUTES> wanted_;
    std::array<double, (ABACUS_MAX_DIMENSION + 1) * ABACUS_MAX_ATTRIBUTES> values_;
};

} // namespace abacus
