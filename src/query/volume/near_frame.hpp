// A frame near a simplex: its first corner is the origin, and units are powers of two, one for each
// axis and one for the values, such that the simplex has a size of about 1. So nothing is rounded
// that would not be rounded otherwise, and products of lengths and values neither overflow nor
// underflow.
#pragma once

#include "query/volume/valued_simplex.hpp"

#include <bit>
#include <cmath>
#include <cstdint>
#include <numeric>

namespace abacus {

/// A power of two as a factor, for all exponents that doubles and their quotients have.
class PowerOfTwo {
public:
    PowerOfTwo() = default;
    explicit PowerOfTwo(int exponent)
        : factor_{power(exponent / 2), power(exponent - exponent / 2)} {}

    double times(double x) const { return x * factor_[0] * factor_[1]; }

private:
    /// From the bits of a double, which is quicker than std::ldexp().
    static double power(int exponent) {
        return std::bit_cast<double>(static_cast<std::uint64_t>(exponent + 1023) << 52);
    }

    double factor_[2] = {1, 1};
};

template <int D> class NearFrame {
public:
    /// Near the first of two simplices, with a unit for the values of both.
    NearFrame(const ValuedSimplex<D> &simplex, const ValuedSimplex<D> &other) {
        Box<D> box;
        for (const Point<D> &p : simplex.corner) box.extend(p);
        for (int axis = 0; axis < D; ++axis) {
            // Halves do not overflow.
            const double half = box.upper[axis] / 2 - box.lower[axis] / 2;
            exponent_[axis] = exponent_of(half) + 1;
        }
        double most = 0;
        for (int i = 0; i <= D; ++i)
            most = std::max({most, std::fabs(simplex.value[i]), std::fabs(other.value[i])});
        exponent_[D] = exponent_of(most);
        for (int i = 0; i <= D; ++i) {
            in_[i] = PowerOfTwo(-exponent_[i]);
            out_[i] = PowerOfTwo(exponent_[i]);
        }
        for (int axis = 0; axis < D; ++axis)
            origin_[axis] = in_[axis].times(simplex.corner[0][axis]);
    }

    /// How many powers of two an area or a volume is larger than in the frame, and a value.
    int of_measures() const { return std::accumulate(exponent_.begin(), exponent_.end() - 1, 0); }
    int of_values() const { return exponent_[D]; }

    Point<D> into(const Point<D> &p) const {
        Point<D> seen;
        for (int axis = 0; axis < D; ++axis) seen[axis] = in_[axis].times(p[axis]) - origin_[axis];
        return seen;
    }
    Box<D> into(const Box<D> &box) const { return {into(box.lower), into(box.upper)}; }
    Piece<D> into(const ValuedSimplex<D> &simplex) const {
        Piece<D> piece;
        for (int i = 0; i <= D; ++i) {
            piece.corner[i] = into(simplex.corner[i]);
            piece.value[i] = in_[D].times(simplex.value[i]);
        }
        return piece;
    }
    /// Between the frame and coordinates relative to the first corner, in units of the mesh.
    Piece<D> out(const Piece<D> &piece) const { return scaled(piece, out_); }
    Piece<D> in(const Piece<D> &piece) const { return scaled(piece, in_); }

private:
    using Factors = std::array<PowerOfTwo, D + 1>;

    static int exponent_of(double x) {
        int exponent = 0;
        (void)std::frexp(x, &exponent);
        return exponent;
    }
    static Piece<D> scaled(Piece<D> piece, const Factors &factors) {
        for (int i = 0; i <= D; ++i) {
            for (int axis = 0; axis < D; ++axis)
                piece.corner[i][axis] = factors[axis].times(piece.corner[i][axis]);
            piece.value[i] = factors[D].times(piece.value[i]);
        }
        return piece;
    }

    std::array<int, D + 1> exponent_; ///< of the axes, then of the values
    Factors in_, out_;
    Point<D> origin_;
};

} // namespace abacus
