// Takes the points to be removed from a stage. They are removed from the triangulation or, once
// there is none, from the waiting points, many at a time. When removals get too expensive, the
// vertices to be removed are only noted from then on, and the rest is triangulated again. With
// several threads, points are gathered first, and the threads remove what they can (gathering.hpp).
//
// Equal points come one after the other, in the order of the rows, and are removed from the
// triangulation together. If they were removed singly, the pages of their place would be searched
// and written for each of them.
#pragma once

#include "change/coded_sink.hpp"
#include "change/deleting.hpp"
#include "change/outlay.hpp"
#include "points/waiting_points.hpp"

namespace abacus {

template <int D> class Deleting<D>::Outlet final : public CodedSink<D>, private Gathering<D>::User {
public:
    Outlet(Deleting &deleting, const Stage<D> &stage, bool exactly)
        : CodedSink<D>(deleting.work_), deleting_(deleting), gathering_(deleting.gathering_),
          memory_(stage.memory()), exactly_(exactly),
          words_(record_words(D, exactly ? work_.attributes : 0)),
          outlay_(stage.points(), work_.facts->census.vertices, work_.simplices()),
          leaving_(work_.host, work_.cache_bytes / want_share, exactly, work_.attributes),
          waiting_(work_.host, work_.attributes, exactly) {
        gathering_.begin(*this, stage.points(), words_);
    }
    Outlet(const Outlet &) = delete;
    Outlet &operator=(const Outlet &) = delete;

    void add(const std::uint64_t *record) override { add(record, 1, words_); }
    void add(const std::uint64_t *records, std::size_t n, std::size_t stride) override {
        if (is_shared()) return gathering_.gather(records, n, stride);
        gathering_.finish(); // if any points are left
        for (; n > 0; --n, records += stride) take_left(records);
    }
    void add(const std::uint64_t *records, const std::uint64_t *codes, std::size_t n,
             std::size_t stride) override {
        if (is_shared()) return gathering_.gather(records, stride, codes, n);
        add(records, n, stride);
    }
    void finish() override {
        gathering_.finish();
        finish_here();
        if (work_.has_waiting()) take_waiting();
    }
    std::size_t held_back() const override { return gathering_.size(); }

    /// Points removed.
    std::uint64_t taken() const { return taken_; }

    abacus_phase phase() const override { return ABACUS_PHASE_DELETING; }

private:
    using CodedSink<D>::work_;

    /// The part of the memory that the wants of a place may take.
    static constexpr std::size_t want_share = 16;

    Deed deed() const override { return Deed::remove; }
    bool is_shared() const override {
        return gathering_.gathers() && work_.has_simplices() && !deleting_.rest_;
    }
    bool keeps_left() const override { return true; }
    void take(const std::uint64_t *records, const std::uint64_t *, std::size_t n) override {
        for (; n > 0; --n, records += words_) take_left(records);
    }
    void finish_here() override {
        if (!leaving_.empty()) leave();
    }
    /// Removes a point.
    void take_left(const std::uint64_t *record) override {
        const Point<D> p = record_point<D>(record);
        if (!leaving_.empty() && (leaving_.is_full() || !(p == place_))) leave();
        if (work_.has_simplices()) {
            place_ = p;
            leaving_.want(record_id(record), record_attributes<D>(record));
            ++wanted_;
            if (++done_ % 256 == 0) work_.host.poll();
        } else if (work_.has_waiting()) {
            waiting_.want(p, record_id(record), record_attributes<D>(record));
            if (waiting_.is_full()) take_waiting();
        }
    }
    const typename Gathering<D>::Removing *begin_sharing() override {
        had_ = work_.facts->census.vertices;
        shared_outlay_.emplace(outlay_);
        const std::size_t want_bytes = gathering_.thread_cache_bytes() / want_share;
        shared_.emplace(typename Gathering<D>::Removing{exactly_, want_bytes, *shared_outlay_});
        return &*shared_;
    }
    void end_sharing() override {
        taken_ += had_ - work_.facts->census.vertices;
        if (shared_outlay_->is_too_much()) deleting_.put_off_removals(memory_);
    }
    bool counts_crowded() const override { return false; }

    void leave() {
        taken_ += deleting_.erase(place_, leaving_);
        leaving_.clear();
        if (!deleting_.rest_ && work_.has_simplices() &&
            outlay_.is_too_much(work_.core->removal.take_effort(), wanted_))
            deleting_.put_off_removals(memory_);
        wanted_ = 0;
    }
    void take_waiting() {
        abacus_census &census = work_.facts->census;
        taken_ += waiting_.take(census.inserted, census.staged);
    }

    Deleting &deleting_;
    Gathering<D> &gathering_;
    const std::size_t memory_; // for sorting
    const bool exactly_;
    const std::size_t words_; // of a record, those that are used
    Outlay<D> outlay_;
    std::optional<SharedOutlay<D>> shared_outlay_; // while threads remove points
    std::optional<typename Gathering<D>::Removing> shared_;
    std::uint64_t had_ = 0;    // vertices before them
    Leaving leaving_;          // those of one place
    std::uint64_t wanted_ = 0; // how many
    Point<D> place_{};
    WaitingPoints<D> waiting_;
    std::uint64_t taken_ = 0;
    std::uint64_t done_ = 0;
};

} // namespace abacus
