// Attributes of vertices that change as their pages are loaded: pages that are left from when
// vertices had other ones, and other values for some vertices.
#pragma once

#include "geometry/point.hpp"

#include <cstdint>
#include <limits>
#include <span>

namespace abacus {

/// Of an attribute that had no value.
inline constexpr std::uint32_t no_attribute = 0xffffffffu;

/// The value of an attribute where `values` are those of before; `source`: which of these it was.
inline double value_from(std::uint32_t source, const double *values) {
    return source == no_attribute ? std::numeric_limits<double>::quiet_NaN() : values[source];
}

/// How pages that have another number of attributes are read: a vertex gets as its i-th attribute
/// the former attribute source[i].
struct FormerAttributes {
    int count = -1; ///< of such a page; negative: there are none
    std::span<const std::uint32_t> source{};
};

/// Gives vertices other values as their pages are loaded, so that all pages with a vertex agree.
template <int D> class OtherValues {
public:
    /// Changes the values of a vertex; false if it keeps them.
    virtual bool give(const Point<D> &p, std::int64_t id, double *values) = 0;

protected:
    ~OtherValues() = default;
};

} // namespace abacus
