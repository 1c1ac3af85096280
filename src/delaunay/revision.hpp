// Where a stage hands on other attributes for points that stay where they are.
//
// Attributes that are apart are found by the place alone, so no simplex page is read or written,
// unless several points are at the place, or wait. Otherwise all pages that have the vertex are.
// Only where points are equal it matters which of them is meant: the one with the row's id, or else
// the first, which is the vertex, whose id a simplex page tells.
#pragma once

#include "delaunay/build.hpp"
#include "points/waiting_changes.hpp"

#include <algorithm>

namespace abacus {

template <int D> class Build<D>::Revision final : public RecordSink {
public:
    /// The values of a record are those of the attributes `which`.
    Revision(Build &build, std::span<const std::uint32_t> which)
        : build_(build), which_(which), waiting_(build.host_, build.attributes_, which),
          wants_(build.host_), values_(build.host_) {}

    void add(const std::uint64_t *record) override {
        if (!build_.has_simplices()) {
            waiting_.want(record);
            if (waiting_.is_full()) change_waiting();
            return;
        }
        if (++done_ % 256 == 0) build_.host_.poll();
        const Point<D> p = record_point<D>(record);
        if (!wants_.empty() && (!(p == place_) || is_full())) revise_place();
        place_ = p;
        wants_.push_back({record_id(record), static_cast<std::uint32_t>(wants_.size()), false});
        std::copy_n(record_attributes<D>(record), which_.size(), values_.extend(which_.size()));
    }
    void finish() override {
        if (!wants_.empty()) revise_place();
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
    static constexpr std::size_t most = std::size_t{1} << 20; // bytes of what is wanted at a place

    struct Want {
        std::int64_t id;
        std::uint32_t order;
        bool is_met;
    };

    void change_waiting() {
        changed_ += waiting_.apply(build_.header_->inserted, build_.header_->staged, missing_);
    }
    bool is_full() const { return wants_.size() * (sizeof(Want) + 8 * which_.size()) >= most; }
    const double *values(const Want &want) const {
        return values_.data() + want.order * which_.size();
    }
    /// All wants for a place at once, so that the points that equal its vertex are read once.
    void revise_place() {
        if (build_.header_->duplicates > 0 && build_.repeated_->contains(place_)) revise_repeated();
        for (const Want &want : wants_) {
            if (want.is_met || set_of_vertex(values(want)))
                ++changed_;
            else if (!missing_)
                fill_record<D>(missing_.emplace().data(), want.id, place_, nullptr, 0);
        }
        wants_.clear();
        values_.clear();
    }
    /// Leaves those for the vertex.
    void revise_repeated() {
        const std::optional<std::int64_t> first = build_.core_->removal.id_at(place_);
        if (!first) throw_corrupted("A repeated point equals no vertex of the mesh.");
        std::sort(wants_.begin(), wants_.end(), [](const Want &a, const Want &b) {
            return a.id < b.id || (a.id == b.id && a.order < b.order);
        });
        std::size_t left = 0; // ids
        for (const Want *w = wants_.begin(); w != wants_.end(); ++w)
            left += w->id != *first && (w == wants_.begin() || w->id != w[-1].id);
        build_.repeated_->change(place_, [&](std::uint64_t *record, bool &is_changed) {
            const std::int64_t id = record_id(record);
            const auto by_id = [](const Want &want, std::int64_t sought) {
                return want.id < sought;
            };
            Want *w = std::lower_bound(wants_.begin(), wants_.end(), id, by_id);
            if (left == 0 || id == *first || w == wants_.end() || w->id != id || w->is_met)
                return left > 0;
            for (; w != wants_.end() && w->id == id; ++w) {
                w->is_met = true;
                for (std::size_t i = 0; i < which_.size(); ++i)
                    record[1 + D + which_[i]] = std::bit_cast<std::uint64_t>(values(*w)[i]);
            }
            is_changed = true;
            return --left > 0;
        });
        std::sort(wants_.begin(), wants_.end(),
                  [](const Want &a, const Want &b) { return a.order < b.order; });
    }
    bool set_of_vertex(const double *values) {
        if (build_.apart_)
            return build_.apart_->set(place_, build_.domain_.code(place_), which_, values);
        return build_.core_->removal.set_attributes(place_, which_, values);
    }

    Build &build_;
    const std::span<const std::uint32_t> which_;
    WaitingChanges<D> waiting_;
    Point<D> place_{};
    Arena<Want> wants_; // at the place
    Arena<double> values_;
    std::optional<std::array<std::uint64_t, 1 + D>> missing_;
    std::uint64_t changed_ = 0;
    std::uint64_t done_ = 0;
};

} // namespace abacus
