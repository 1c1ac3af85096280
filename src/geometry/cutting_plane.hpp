// A plane in space, given by a point and a normal: how high other points are above it. Whether they
// are above, below or in the plane is exact.
//
// A height is the product of the normal and the way from the plane's point. Each of its three
// terms is rounded twice, and their sum twice: the error is below 5 units in the last place of the
// sum of their magnitudes. A height that is far beyond that has the right sign, and some digits
// too. All others, and what overflows or underflows, are computed in rational numbers.
#pragma once

#include "geometry/point.hpp"

namespace abacus {

class CuttingPlane {
public:
    /// The point is finite, so is the normal, which is not zero.
    CuttingPlane(const Point<3> &through, const Point<3> &normal);

    const Point<3> &through() const { return through_; }
    /// The normal, at a scale at which the greatest of its coordinates is from 1/32 to 1/16: so no
    /// height is beyond all doubles.
    const Point<3> &normal() const { return normal_; }

    /// The axis to which the plane is at right angles, along which all of its points are where one
    /// is; -1 if there is none.
    int axis() const { return axis_; }

    /// In lengths of that normal: positive above, negative below, 0 if and only if p is in the
    /// plane. Right to a millionth. It is a function of p alone, and finite.
    double height(const Point<3> &p) const;
    int side(const Point<3> &p) const {
        const double h = height(p);
        return (h > 0) - (h < 0);
    }

private:
    double exact_height(const Point<3> &p) const;

    Point<3> through_;
    Point<3> given_; // normal
    Point<3> normal_;
    int axis_ = -1;
    int exponent_;            // normal_ is given_, divided by 2 to this power
    bool is_rounded_ = false; // and then rounded
};

} // namespace abacus
