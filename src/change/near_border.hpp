// Guesses which points of a batch are so near to a border of intervals that threads would put them
// off.
//
// They are better inserted before the threads begin: while the mesh is still coarse and in memory,
// each is searched for once, and few pages are made twice. It is only a guess. A point that it
// misses is put off; one that it wrongly picks is inserted by one thread instead of several.
//
// A point is put off where its cavity, in the mesh of the rounds before, reaches beyond the
// border. So the distance between vertices of that mesh matters. It is guessed from points that
// follow one another on the curve, which are close to one another.
//
// The hull of that mesh has few vertices: some dozens in a square, some hundreds in a cube. So its
// simplices reach far along the sides, and so do the cavities of points beside them. The box of
// the mesh tells where that may be.
#pragma once

#include "change/cuts.hpp"
#include "geometry/box.hpp"
#include "keys/locational_code.hpp"
#include "points/record.hpp"

#include <cmath>

namespace abacus {

template <int D> class NearBorder {
public:
    /// The number of points examined together, at most.
    static constexpr std::size_t together = Batch::marked_together;
    using Marks = std::uint32_t; ///< a bit for each of them

    /// `box`: of the points of the mesh, or of most of them.
    NearBorder(const Domain<D> &domain, const Box<D> &box, const Cuts &cuts)
        : domain_(domain), box_(box), cuts_(cuts) {}

    /// Marks those of the points [begin, end), at most `together` of them, that are near a border.
    /// Of points with one code, which come one after the other, all are marked or none.
    Marks marks(const Batch &batch, std::size_t begin, std::size_t end) {
        if (!look_at(batch, begin, end)) return 0;
        Marks marks = 0;
        bool marked = false;
        for (std::size_t i = begin; i < end; ++i) {
            const std::uint64_t code = batch.code(i);
            if (i == begin || code != batch.code(i - 1))
                marked = is_near(record_point<D>(batch.record(i)), code);
            marks |= Marks{marked} << (i - begin);
        }
        return marks;
    }

private:
    /// Examines the points. False if none of them is near a border.
    bool look_at(const Batch &batch, std::size_t begin, std::size_t end) {
        Box<D> box;
        for (std::size_t i = begin; i < end; ++i) box.extend(record_point<D>(batch.record(i)));
        double volume = 1;
        for (int axis = 0; axis < D; ++axis) volume *= box.upper[axis] - box.lower[axis];
        const double each = volume / static_cast<double>(end - begin);
        const double step = D == 2 ? std::sqrt(each) : std::cbrt(each);
        reach_ = reach_in_steps * step;
        layer_ = layer_in_steps * step;
        if (is_at_side(box)) return true;
        const std::size_t interval = cuts_.interval(batch.code(begin));
        if (interval != cuts_.interval(batch.code(end - 1))) return true;
        for (int corner = 0; corner < 1 << D; ++corner) {
            Point<D> p;
            for (int axis = 0; axis < D; ++axis)
                p[axis] =
                    (corner >> axis & 1) != 0 ? box.upper[axis] + reach_ : box.lower[axis] - reach_;
            if (cuts_.interval(domain_.code(p)) != interval) return true;
        }
        return false;
    }
    /// For a point with this code, one of those examined.
    bool is_near(const Point<D> &p, std::uint64_t code) const {
        const std::size_t interval = cuts_.interval(code);
        const bool is_far = is_at_side({p, p});
        for (int axis = 0; axis < D; ++axis) {
            const double side = box_.upper[axis] - box_.lower[axis];
            double reach = reach_;
            for (int looks = is_far ? most_looks : 1; looks > 0; --looks) {
                for (const double away : {-reach, reach}) {
                    Point<D> q = p;
                    q[axis] += away;
                    if (cuts_.interval(domain_.code(q)) != interval) return true;
                }
                reach *= 2;
                if (reach >= side_reach * side) break;
            }
        }
        return false;
    }
    /// Whether a box reaches into the layer of points that may be beside the hull.
    bool is_at_side(const Box<D> &box) const {
        for (int axis = 0; axis < D; ++axis)
            if (box.lower[axis] < box_.lower[axis] + layer_ ||
                box.upper[axis] > box_.upper[axis] - layer_)
                return true;
        return false;
    }

    /// In distances between neighbours once all points are in. Measured.
    static constexpr double reach_in_steps = D == 2 ? 3 : 2.8, layer_in_steps = 0.2;
    /// In sides of the box.
    static constexpr double side_reach = 0.5;
    static constexpr int most_looks = 16; ///< each twice as far

    const Domain<D> &domain_;
    const Box<D> box_;
    const Cuts &cuts_;
    double reach_ = 0, layer_ = 0;
};

} // namespace abacus
