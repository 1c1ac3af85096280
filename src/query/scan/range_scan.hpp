// The pages of a mesh with simplices that meet a convex region, such as a window: found through the
// page index, each read once, and none that is far away.
//
// A simplex is stored under the greatest code of its vertices. So a simplex that reaches into a
// window may lie in a page whose stretch of the curve is far away, and no list of stretches of the
// curve is exact. But the simplices of a Delaunay mesh fill their convex hull, and neighbours know
// one another's keys. So the pages are flooded (page_flood.hpp), from one simplex that meets the
// region, across all facets that meet it.
//
// That finds all of them. Let R be the region and C the hull, both closed and convex; so their
// intersection is connected, and the simplices that meet it, finitely many closed sets, cover it.
// So from any of them to any other leads a chain in which each has a point x of R in common with
// the next. The simplices around x fill all of C near x, and C is convex, so they are connected
// across facets that contain x, and x is in R. Whether a facet meets R need not be decided exactly:
// crossing too many facets costs pages and loses nothing. The facet's box is compared with the
// window, coordinate by coordinate and so without rounding.
//
// Where to begin: a walk leads to a point p of R, chosen near the middle of the domain. If p lies
// in C, the simplex around it meets R. Otherwise the walk ends at a ghost whose facet p sees,
// strictly from beyond. The straight line from p to any point q of both R and C is inside R and
// enters C at a facet that p sees; so some facet that p sees meets R. The facets that p sees are
// connected across ridges. So they are flooded first, and those that may meet R begin the other
// flood. If R lies wholly beyond one of them, it does not meet C, and there is nothing to read. As
// a rule the first one already shows this. In the worst case p sees many facets, up to half of the
// hull.
//
// A mesh that is not Delaunay may have holes and pieces. The simplices in a window need not be
// connected there, and only the pages show where they are. So all pages are read once, and those
// whose boxes do not meet the region are skipped. The same is done where the region covers much of
// the domain, since a pass over all pages takes less time than a flood.
//
// A flood visits pages in the order of the curve as far as it knows them; rewind() returns them
// again, strictly in that order.
#pragma once

#include "geometry/simplex_box.hpp"
#include "query/pages/page_flood.hpp"
#include "query/pages/page_scan.hpp"

#include <abacus/facts.h>

#include <functional>
#include <optional>

namespace abacus {

/// A closed convex part of the plane or of space.
template <int D> class Region {
public:
    virtual ~Region() = default;

    /// A point in it, at or near the middle of the domain.
    virtual Point<D> inside(const Domain<D> &domain) const = 0;
    /// Whether the hull of n points may meet it, n from 2 to 4. True if it does.
    virtual bool may_meet(const Point<D> *const *points, int n) const = 0;
    /// The same for a box.
    virtual bool may_meet(const Box<D> &box) const = 0;
    /// Whether all of it lies strictly beyond a ghost's facet; the last corner is not read. False
    /// if it does not.
    virtual bool lies_beyond(const Corners<D> &) const { return false; }
    /// Whether so much of the domain lies in it that all pages should be read.
    virtual bool has_much_of(const Domain<D> &) const { return false; }
};

template <int D> class BoxRegion final : public Region<D> {
public:
    explicit BoxRegion(const Box<D> &box) : box_(box) {}

    Point<D> inside(const Domain<D> &domain) const override;
    bool may_meet(const Point<D> *const *points, int n) const override;
    bool may_meet(const Box<D> &box) const override { return box_.meets(box); }
    bool lies_beyond(const Corners<D> &facet) const override;
    bool has_much_of(const Domain<D> &domain) const override;

private:
    const Box<D> box_;
};

template <int D> class RangeScan {
public:
    /// Whether a page is wanted, decided by its heads: see PageView::open().
    using Wants = std::function<bool(const PageView<D> &)>;

    /// Of all pages if `region` is null. It is read as long as the scan. Pages that `wants` refuses
    /// are passed over; many of them are not decoded.
    RangeScan(const Host &host, const abacus_facts &facts, const Region<D> *region,
              Wants wants = {});

    /// Goes to the next page whose box may meet the region; false after the last. The caller
    /// decides which of its simplices do, for a window by meets(). Throws if a page is damaged or
    /// missing.
    bool advance();
    /// After the last page: begins again, in the order of the curve.
    void rewind();

    const PageView<D> &page() const { return whole_ ? whole_->page() : flood_->page(); }
    /// Pages read so far, including useless ones and those read again.
    std::uint64_t pages_read() const {
        return whole_ ? whole_->pages_read() : flood_->pages_read();
    }

private:
    bool advance_any();
    /// Reaches the first pages of the flood.
    void begin();
    void begin_outside(const Point<D> &p, const Key &page);
    bool may_cross(int simplex, int facet) const;

    const Host &host_;
    const abacus_facts facts_;
    const Region<D> *const region_;
    const Wants wants_;
    // One of these two is used.
    std::optional<PageScan<D>> whole_;
    std::optional<PageFlood<D>> flood_;
};

extern template class BoxRegion<2>;
extern template class BoxRegion<3>;
extern template class RangeScan<2>;
extern template class RangeScan<3>;

} // namespace abacus
