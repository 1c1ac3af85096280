// Points as CGAL's filtered kernel (LGPL) takes them. It takes seconds to compile, so only files
// whose predicates or constructions need it include this.
#pragma once

#include "geometry/point.hpp"

#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>

namespace abacus::exact {

using Kernel = CGAL::Exact_predicates_inexact_constructions_kernel;

inline Kernel::Point_2 cgal(const Point<2> &p) { return {p[0], p[1]}; }
inline Kernel::Point_3 cgal(const Point<3> &p) { return {p[0], p[1], p[2]}; }

} // namespace abacus::exact
