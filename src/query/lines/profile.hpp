// An attribute along a path of straight lines: at its corners, and wherever it crosses a facet of
// the mesh. Between two such places it is linear.
//
// Outside the mesh there is no value. A place where the path leaves or enters the mesh is reported
// twice, with its value and without; so a curve drawn from place to place has gaps where the mesh
// has.
#pragma once

#include "query/lines/line_scan.hpp"
#include "query/values/interpolation.hpp"

namespace abacus {

template <int D> class Profile {
public:
    /// report(distance, place, value): the value is NaN outside, and where it is missing.
    using Report = std::function<void(double, const Point<D> &, double)>;

    /// Simplices outside of the extent count as outside.
    Profile(Reader<D> &reader, std::uint32_t attribute, Report report,
            const abacus_extent &extent = {});

    /// For a path with the corners corner(0) to corner(n - 1); a corner equal to the one before it
    /// is skipped.
    void along(std::size_t n, const std::function<Point<D>(std::size_t)> &corner);

private:
    struct Row {
        double distance;
        Point<D> place;
        bool is_inside;
    };

    void put(const Row &row, double value);
    void put_outside(double distance, const Point<D> &place);
    /// A corner of the path, which it reaches inside the mesh or outside.
    void put_corner(const Point<D> &place, bool comes_inside);
    /// The straight line from one corner to the next.
    void put_line(const Point<D> &from, const Point<D> &to);

    Reader<D> &reader_;
    Interpolation<D> interpolation_;
    abacus_interpolation how_{};
    const Report report_;
    double distance_ = 0; // at the last corner added
    std::optional<Row> last_;
};

extern template class Profile<2>;
extern template class Profile<3>;

} // namespace abacus
