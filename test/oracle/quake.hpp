// The earthquake data sets by size, from the extension's own generator.
#pragma once

#include "coordinates.hpp"

namespace abacus::oracle {

/// The set whose number of points is nearest to `size`, among all hundredths of a Hertz.
Points<3> quake(std::size_t size);

} // namespace abacus::oracle
