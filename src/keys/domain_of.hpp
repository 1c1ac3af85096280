#pragma once

#include "geometry/box.hpp"
#include "keys/locational_code.hpp"

#include <abacus/facts.h>

#include <algorithm>

namespace abacus {

/// A domain with room for all points of a box: a square or cube on a grid. The step of the
/// grid is the power of two between an eighth and a quarter of the box's greatest extent. So
/// the box of some points, drawn at random, nearly always gives the domain of all.
template <int D> Domain<D> domain_around(Point<D> lower, Point<D> upper) {
    double extent = 0;
    for (int i = 0; i < D; ++i) extent = std::max(extent, upper[i] - lower[i]);
    int exponent = 0;
    if (extent < std::numeric_limits<double>::infinity()) std::frexp(extent, &exponent);
    const double step = std::ldexp(1.0, exponent - 3);
    // There is no such domain where a coordinate or the step would overflow or vanish,
    // nor around one point.
    if (!(extent > 1e-290 && extent < 1e290)) return {lower, upper};
    double side = 0;
    for (int i = 0; i < D; ++i) {
        // From 2^53 steps on every double is on the grid, and the quotient might overflow. Neither
        // a quotient that underflows nor a sum that is rounded shall leave out a point of the box.
        if (std::fabs(lower[i]) < 0x1p53 * step)
            lower[i] = std::min(lower[i], std::floor(lower[i] / step) * step);
        side = std::max(side, std::ceil((upper[i] - lower[i]) / step) * step);
    }
    for (int i = 0; i < D; ++i) upper[i] = std::max(upper[i], lower[i] + side);
    return {lower, upper};
}

/// The box that a mesh's form tells.
template <int D> Box<D> domain_box(const abacus_form &form) {
    Box<D> box;
    std::copy_n(form.lower, D, box.lower.begin());
    std::copy_n(form.upper, D, box.upper.begin());
    return box;
}

/// The domain of a mesh.
template <int D> Domain<D> domain_of(const abacus_form &form) {
    const Box<D> box = domain_box<D>(form);
    return domain_around<D>(box.lower, box.upper);
}

/// Whether a mesh's domain does not fit so many of its points that it needs another one.
inline bool has_outgrown_domain(std::uint64_t outside, std::uint64_t points) {
    constexpr std::uint64_t harmless = 64;
    return outside > harmless + points / 8;
}

/// Gives a mesh a domain with room for all points of a box.
template <int D> void set_domain(abacus_facts &facts, const Box<D> &box) {
    facts.form.has_domain = 1;
    facts.census.outside = 0;
    std::copy_n(box.lower.begin(), D, facts.form.lower);
    std::copy_n(box.upper.begin(), D, facts.form.upper);
}

} // namespace abacus
