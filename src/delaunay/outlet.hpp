// Where a stage hands on the points to be taken away. They are taken out of the triangulation;
// once there is none, out of the waiting points, many at a time. When removals get too
// expensive, vertices that leave are only noted from then on, and the rest is triangulated
// anew.
//
// Equal points come one after the other, in the order of the rows, and are taken out of the
// triangulation together. If they were taken out singly, the pages of their place would be
// searched and written for each of them.
#pragma once

#include "delaunay/build.hpp"
#include "points/waiting_points.hpp"

namespace abacus {

template <int D> class Build<D>::Outlet final : public RecordSink {
public:
    Outlet(Build &build, const Stage<D> &stage, bool exactly)
        : build_(build), memory_(stage.memory()),
          outlay_(stage.points(), build.header_->vertices, build.simplices(),
                  build.core_->removal.effort()),
          leaving_(build.host_, build.cache_bytes_ / 16, exactly, build.attributes_),
          waiting_(build.host_, build.attributes_, exactly) {}

    void add(const std::uint64_t *record) override {
        const Point<D> p = record_point<D>(record);
        if (!leaving_.empty() && (leaving_.is_full() || !(p == place_))) leave();
        if (build_.has_simplices()) {
            place_ = p;
            leaving_.want(record_id(record), record_attributes<D>(record));
            ++wanted_;
            if (++done_ % 256 == 0) build_.host_.poll();
        } else if (build_.has_waiting()) {
            waiting_.want(p, record_id(record), record_attributes<D>(record));
            if (waiting_.is_full()) take();
        }
    }
    void finish() override {
        if (!leaving_.empty()) leave();
        if (build_.has_waiting()) take();
    }
    /// Points taken away.
    std::uint64_t taken() const { return taken_; }

    abacus_phase phase() const override { return ABACUS_PHASE_DELETING; }
    PagesMoved pages_moved() const override {
        return {build_.core_->cache.counters.loads, build_.core_->cache.counters.stores};
    }

private:
    void leave() {
        taken_ += build_.erase(place_, leaving_);
        leaving_.clear();
        if (!build_.rest_ && build_.has_simplices() &&
            outlay_.is_too_much(build_.core_->removal.effort(), wanted_))
            build_.put_off_removals(memory_);
        wanted_ = 0;
    }
    void take() { taken_ += waiting_.take(build_.header_->inserted, build_.header_->staged); }

    Build &build_;
    const std::size_t memory_; // for sorting
    Outlay<D> outlay_;
    Leaving leaving_;          // those of one place
    std::uint64_t wanted_ = 0; // how many
    Point<D> place_{};
    WaitingPoints<D> waiting_;
    std::uint64_t taken_ = 0;
    std::uint64_t done_ = 0;
};

} // namespace abacus
