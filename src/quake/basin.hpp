// The ground of a synthetic sedimentary basin, for the earthquake data sets
// (dissertation §5.1.2): soft sediments fill an irregular bowl in hard rock, and
// both get faster with depth.
//
// The domain is 100 km x 100 km x 37.5 km, the size of the dissertation's Greater
// Los Angeles Basin. Coordinates are metres; z is height, 0 at the surface and
// -37500 at the bottom.
//
// Two ways to ask: the material at a point, and the slowest shear wave in a box.
// The second is a lower bound by interval arithmetic, computed so that
//
//   a box inside another never has a lesser bound, and
//   no point of a box is slower than its bound,
//
// with all rounding errors: each step is a monotone function of interval ends, and
// rounding is monotone. An octree refined by this bound is therefore a tree
// (nothing below a leaf would be refined) and resolves every point.
//
// Only + - * / and sqrt, which IEEE 754 rounds correctly: every machine computes
// the same.
#pragma once

namespace abacus {

/// Metres a second, and kilograms a cubic metre.
struct Material {
    double vs, vp, density;
};

class Basin {
public:
    static constexpr double width = 100'000; ///< along x and y
    static constexpr double depth = 37'500;

    /// Ranges of x and y, and the upper end of a range of z; any lower end gives the same
    /// answer, since both media get faster with depth.
    struct Box {
        double lower_x, upper_x, lower_y, upper_y, upper_z;
    };

    /// z <= 0.
    static Material material(double x, double y, double z);
    /// No shear wave in the box is slower; metres a second.
    static double slowest(const Box &box);
    /// The same of the whole basin.
    static double slowest();
};

} // namespace abacus
