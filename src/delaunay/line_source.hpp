// The lines of a constrained mesh, as the host keeps them.
#pragma once

#include "geometry/point.hpp"

#include <abacus/constrain.h>

#include <span>

namespace abacus {

class LineSource {
public:
    /// The segments that end at p; valid until the next call.
    virtual std::span<const abacus_segment_end> at(const Point<2> &p) = 0;

protected:
    ~LineSource() = default;
};

inline Point<2> other_end(const abacus_segment_end &segment) {
    return {segment.other[0], segment.other[1]};
}

} // namespace abacus
