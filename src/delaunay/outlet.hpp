// Takes the points to be removed from a stage. They are removed from the triangulation or, once
// there is none, from the waiting points, many at a time. When removals get too expensive, the
// vertices to be removed are only noted from then on, and the rest is triangulated again. With
// several threads, points are gathered first, and the threads remove what they can
// (build_threads.cpp).
//
// Equal points come one after the other, in the order of the rows, and are removed from the
// triangulation together. If they were removed singly, the pages of their place would be searched
// and written for each of them.
#pragma once

#include "delaunay/build.hpp"
#include "points/waiting_points.hpp"

namespace abacus {

template <int D> class Build<D>::Outlet final : public RecordSink {
public:
    Outlet(Build &build, const Stage<D> &stage, bool exactly)
        : build_(build), memory_(stage.memory()), exactly_(exactly),
          words_(record_words(D, exactly ? build.attributes_ : 0)),
          outlay_(stage.points(), build.facts_->census.vertices, build.simplices()),
          leaving_(build.host_, build.cache_bytes_ / want_share, exactly, build.attributes_),
          waiting_(build.host_, build.attributes_, exactly) {
        build_.outlet_ = this;
        build_.begin_to_gather(stage.points(), words_);
    }
    Outlet(const Outlet &) = delete;
    Outlet &operator=(const Outlet &) = delete;
    ~Outlet() { build_.outlet_ = nullptr; }

    void add(const std::uint64_t *record) override { add(record, 1, words_); }
    void add(const std::uint64_t *records, std::size_t n, std::size_t stride) override {
        if (is_shared()) return build_.gather(records, n, stride);
        build_.change_gathered(); // if any points are left
        for (; n > 0; --n, records += stride) take(records);
    }
    void finish() override {
        build_.change_gathered();
        finish_place();
        if (build_.has_waiting()) take_waiting();
    }
    std::size_t held_back() const override { return build_.gathered_.size(); }

    /// Whether threads may remove points, too.
    bool is_shared() const { return build_.gathers() && build_.has_simplices() && !build_.rest_; }
    /// Removes a point.
    void take(const std::uint64_t *record) {
        const Point<D> p = record_point<D>(record);
        if (!leaving_.empty() && (leaving_.is_full() || !(p == place_))) leave();
        if (build_.has_simplices()) {
            place_ = p;
            leaving_.want(record_id(record), record_attributes<D>(record));
            ++wanted_;
            if (++done_ % 256 == 0) build_.host_.poll();
        } else if (build_.has_waiting()) {
            waiting_.want(p, record_id(record), record_attributes<D>(record));
            if (waiting_.is_full()) take_waiting();
        }
    }
    /// After a point that threads may go on from.
    void finish_place() {
        if (!leaving_.empty()) leave();
    }
    /// Lets threads remove points, by use(how).
    template <class Use> void share(Use use) {
        SharedOutlay<D> shared(outlay_);
        const std::uint64_t before = build_.facts_->census.vertices;
        const std::size_t want_bytes = build_.thread_cache_bytes() / want_share;
        use(typename Interval<D>::Removing{exactly_, want_bytes, shared});
        taken_ += before - build_.facts_->census.vertices;
        if (shared.is_too_much()) build_.put_off_removals(memory_);
    }
    /// Points removed.
    std::uint64_t taken() const { return taken_; }

    abacus_phase phase() const override { return ABACUS_PHASE_DELETING; }
    PagesMoved pages_moved() const override {
        return {build_.core_->cache.counters.loads, build_.core_->cache.counters.stores};
    }

private:
    /// The part of the memory that the wants of a place may take.
    static constexpr std::size_t want_share = 16;

    void leave() {
        taken_ += build_.erase(place_, leaving_);
        leaving_.clear();
        if (!build_.rest_ && build_.has_simplices() &&
            outlay_.is_too_much(build_.core_->removal.take_effort(), wanted_))
            build_.put_off_removals(memory_);
        wanted_ = 0;
    }
    void take_waiting() {
        taken_ += waiting_.take(build_.facts_->census.inserted, build_.facts_->census.staged);
    }

    Build &build_;
    const std::size_t memory_; // for sorting
    const bool exactly_;
    const std::size_t words_; // of a record, those that are used
    Outlay<D> outlay_;
    Leaving leaving_;          // those of one place
    std::uint64_t wanted_ = 0; // how many
    Point<D> place_{};
    WaitingPoints<D> waiting_;
    std::uint64_t taken_ = 0;
    std::uint64_t done_ = 0;
};

} // namespace abacus
