// The gradient of a value that varies linearly in a simplex.
//
// It solves (corner i − corner 0) · g = value i − value 0, by Cramer's rule. Each number is the
// exact one, rounded once: it is computed with 106 bits, and where these do not determine the
// rounding, as in a flat simplex, in rational numbers.
#pragma once

#include "query/locate/reader.hpp"

#include <abacus/values.h>

namespace abacus {

/// The gradient in a simplex that is not flat, for finite values at its corners.
template <int D> Point<D> gradient_in(const abacus_simplex &simplex, const double *values);
/// The same times 2^-exponent, and the exponent: 0 unless doubles cannot hold the gradient well.
template <int D>
int scaled_gradient_in(const abacus_simplex &simplex, const double *values, Point<D> &gradient);
/// Sets the gradient of the first attribute at p, D numbers, each NaN if a corner has no finite
/// value; false outside. It is scaled if `exponent` is not null.
template <int D>
bool gradient_at(Reader<D> &reader, const abacus_interpolation &what, const Point<D> &p,
                 double *gradient, int *exponent);

} // namespace abacus
