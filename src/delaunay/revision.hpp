// Where a stage hands on other attributes for points that stay where they are.
//
// Attributes that are apart are found by the place alone, so no simplex page is read or written.
// Otherwise all pages that have the vertex are. Only where points are equal it matters which of
// them is meant: the one with the row's id, or else the first, which is the vertex.
#pragma once

#include "delaunay/build.hpp"
#include "points/waiting_changes.hpp"

namespace abacus {

template <int D> class Build<D>::Revision final : public RecordSink {
public:
    /// The values of a record are those of the attributes `which`.
    Revision(Build &build, std::span<const std::uint32_t> which)
        : build_(build), which_(which), waiting_(build.host_, build.attributes_, which) {}

    void add(const std::uint64_t *record) override {
        if (!build_.has_simplices()) {
            waiting_.want(record);
            if (waiting_.is_full()) change_waiting();
            return;
        }
        if (++done_ % 256 == 0) build_.host_.poll();
        if (revise(record))
            ++changed_;
        else if (!missing_)
            std::copy_n(record, 1 + D, missing_.emplace().begin());
    }
    void finish() override {
        if (!build_.has_simplices()) change_waiting();
    }

    abacus_phase phase() const override { return ABACUS_PHASE_FLUSHING; }
    PagesMoved pages_moved() const override {
        return {build_.core_->cache.counters.loads, build_.core_->cache.counters.stores};
    }

    /// How many records were for a point that is there.
    std::uint64_t changed() const { return changed_; }
    /// Id and place of the first one that was not.
    const std::optional<std::array<std::uint64_t, 1 + D>> &missing() const { return missing_; }

private:
    void change_waiting() {
        changed_ += waiting_.apply(build_.header_->inserted, build_.header_->staged, missing_);
    }
    bool revise(const std::uint64_t *record) {
        const Point<D> p = record_point<D>(record);
        const double *values = record_attributes<D>(record);
        if (build_.header_->duplicates > 0 && build_.repeated_->contains(p)) {
            const std::optional<std::int64_t> id = build_.core_->removal.id_at(p);
            if (!id) throw_corrupted("A repeated point equals no vertex of the mesh.");
            if (*id != record_id(record) &&
                build_.repeated_->set_attributes(p, record_id(record), which_, values))
                return true;
        }
        if (build_.apart_) return build_.apart_->set(p, build_.domain_.code(p), which_, values);
        return build_.core_->removal.set_attributes(p, which_, values);
    }

    Build &build_;
    const std::span<const std::uint32_t> which_;
    WaitingChanges<D> waiting_;
    std::optional<std::array<std::uint64_t, 1 + D>> missing_;
    std::uint64_t changed_ = 0;
    std::uint64_t done_ = 0;
};

} // namespace abacus
