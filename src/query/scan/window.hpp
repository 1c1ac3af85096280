// The part of a mesh that a query selects by place: all of it, a box, or a ball; closed, and
// decided exactly.
//
// Or simplices whose bounding boxes meet a box, as spatial indexes find them. Such a simplex may
// pass the box at any distance, and no chain of such simplices need lead to it. But on each axis it
// reaches from one side of the box to the other or into it; so, being convex, it meets the slab
// that the box cuts out of one axis. A slab is convex: its pages are found like those of any
// region.
#pragma once

#include "geometry/segment.hpp"
#include "query/scan/range_scan.hpp"

#include <abacus/windows.h>

#include <optional>

namespace abacus {

template <int D> class BallRegion final : public Region<D> {
public:
    explicit BallRegion(const Ball<D> &ball) : ball_(ball), around_(box_around(ball)) {}

    Point<D> inside(const Domain<D> &) const override { return ball_.center; }
    bool may_meet(const Point<D> *const *points, int n) const override;
    bool may_meet(const Box<D> &box) const override;
    bool has_much_of(const Domain<D> &domain) const override {
        return BoxRegion<D>(around_).has_much_of(domain);
    }

private:
    static Box<D> box_around(const Ball<D> &ball);

    const Ball<D> ball_;
    const Box<D> around_;
};

template <int D> class Window {
public:
    /// The whole mesh if there is none.
    explicit Window(const abacus_window &window);

    /// Null: the whole mesh.
    const Region<D> *region() const {
        if (slab_region_) return &*slab_region_;
        if (box_) return &*box_region_;
        return ball_ ? &*ball_region_ : nullptr;
    }
    bool contains(const Point<D> &p) const {
        return box_ ? box_->contains(p) : !ball_ || ball_->contains(p);
    }
    /// Whether a finite simplex of positive orientation meets it.
    bool meets(const Corners<D> &corners) const {
        if (slab_region_) return BoxRegion<D>(*box_).may_meet(corners.data(), D + 1);
        if (box_) return abacus::meets<D>(corners, *box_);
        return !ball_ ||
               (ball_region_->may_meet(corners.data(), D + 1) && abacus::meets<D>(corners, *ball_));
    }
    /// The same for an edge.
    bool meets(const Point<D> &a, const Point<D> &b) const {
        if (box_) return abacus::meets<D>(a, b, *box_);
        const Point<D> *const ends[2] = {&a, &b};
        return !ball_ || (ball_region_->may_meet(ends, 2) && abacus::meets<D>(a, b, *ball_));
    }

private:
    std::optional<Box<D>> box_;
    std::optional<BoxRegion<D>> box_region_;
    std::optional<BoxRegion<D>> slab_region_; // then bounding boxes are compared with box_
    std::optional<Ball<D>> ball_;
    std::optional<BallRegion<D>> ball_region_;
};

extern template class BallRegion<2>;
extern template class BallRegion<3>;
extern template class Window<2>;
extern template class Window<3>;

} // namespace abacus
