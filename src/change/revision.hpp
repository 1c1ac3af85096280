// Takes new attributes for points that stay where they are from a stage.
//
// Attributes that are apart are found by the place alone, so no simplex page is read or written,
// unless several points are at the place, or wait. Otherwise all pages that have the vertex are
// read and written. Only where points are equal does it matter which of them is meant: the one with
// the row's id, or else the first, which is the vertex; its id is in a simplex page.
//
// A mesh that follows a table is changed `exactly`: a point matches a row only if it has the
// attributes that the row had before and, where points are equal, its id (points/identities.hpp).
// Each row then stands for a different point. So a row is missing if the mesh has missed a change
// of it.
#pragma once

#include "change/workspace.hpp"
#include "points/identities.hpp"
#include "points/waiting_changes.hpp"

#include <algorithm>
#include <array>
#include <bit>
#include <optional>
#include <span>

namespace abacus {

template <int D> class Revision final : public RecordSink {
public:
    /// The values of a record are those of the attributes `which`; with `exactly`, those of all
    /// attributes before the change come behind them.
    Revision(Workspace<D> &work, std::span<const std::uint32_t> which, bool exactly)
        : work_(work), which_(which), exactly_(exactly),
          waiting_(work.host, work.attributes, which),
          identities_(work.host, exactly ? work.attributes : 0), wants_(work.host),
          values_(work.host) {}

    void add(const std::uint64_t *record) override {
        if (!work_.has_simplices()) {
            wait_for(record);
            return;
        }
        if (++done_ % 256 == 0) work_.host.poll();
        const Point<D> p = record_point<D>(record);
        if (!wants_.empty() && (!(p == place_) || is_full())) revise_place();
        place_ = p;
        const double *values = record_attributes<D>(record);
        const std::int64_t id = record_id(record);
        wants_.push_back({id, exactly_ ? identities_.enter(id, values + which_.size()) : id,
                          static_cast<std::uint32_t>(wants_.size())});
        std::copy_n(values, which_.size(), values_.extend(which_.size()));
    }
    void finish() override {
        if (!wants_.empty()) revise_place();
        if (!work_.has_simplices()) change_waiting();
    }

    abacus_phase phase() const override { return ABACUS_PHASE_FLUSHING; }
    PagesMoved pages_moved() const override { return work_.pages_moved(); }

    /// How many records had a point in the mesh.
    std::uint64_t changed() const { return changed_; }
    /// Id and place of the first record that had none.
    const std::optional<std::array<std::uint64_t, 1 + D>> &missing() const { return missing_; }

private:
    static constexpr std::size_t most = std::size_t{1} << 20; // bytes for the wants at a place

    struct Want {
        std::int64_t id;
        std::int64_t identity; ///< what identifies the point: its id, or a number of identities_
        std::uint32_t order;
        bool is_met = false;
        bool is_of_vertex = false;
        std::uint32_t dealt_with = 0; ///< in the first one of an identity: how many of these
    };

    /// There is no exact search for points that wait.
    void wait_for(const std::uint64_t *record) {
        if (exactly_) {
            miss(record_id(record), record_point<D>(record));
            return;
        }
        waiting_.want(record);
        if (waiting_.is_full()) change_waiting();
    }
    void miss(std::int64_t id, const Point<D> &p) {
        if (!missing_) fill_record<D>(missing_.emplace().data(), id, p, nullptr, 0);
    }
    void change_waiting() {
        changed_ +=
            waiting_.apply(work_.facts->census.inserted, work_.facts->census.staged, missing_);
    }
    bool is_full() const {
        return wants_.size() * (sizeof(Want) + 8 * which_.size() + identities_.bytes_each()) >=
               most;
    }
    const double *values(const Want &want) const {
        return values_.data() + want.order * which_.size();
    }
    /// All wants for a place at once, so that the points that equal its vertex are read once.
    void revise_place() {
        if (work_.facts->census.duplicates > 0 && work_.repeated->contains(place_))
            revise_repeated();
        else if (!exactly_)
            for (Want &want : wants_) want.is_of_vertex = true;
        else // an attribute page does not have the id
            wants_[0].is_of_vertex = vertex_has(wants_[0]);
        for (const Want &want : wants_) {
            if (want.is_met || (want.is_of_vertex && set_of_vertex(values(want))))
                ++changed_;
            else
                miss(want.id, place_);
        }
        wants_.clear();
        values_.clear();
        identities_.clear();
    }
    /// Fulfils the wants for repeated points; leaves those for the vertex.
    void revise_repeated() {
        std::sort(wants_.begin(), wants_.end(), [](const Want &a, const Want &b) {
            return a.identity < b.identity || (a.identity == b.identity && a.order < b.order);
        });
        std::size_t left = wants_.size() - give_to_vertex();
        work_.repeated->change(place_, [&](std::uint64_t *record, bool &is_changed) {
            if (left > 0) {
                const std::size_t met =
                    give(identity(record_id(record), record_attributes<D>(record)), record);
                is_changed = met > 0;
                left -= met;
            }
            return left > 0;
        });
        std::sort(wants_.begin(), wants_.end(),
                  [](const Want &a, const Want &b) { return a.order < b.order; });
        if (!exactly_) // no other point has the id
            for (Want &want : wants_) want.is_of_vertex = !want.is_met;
    }
    std::int64_t identity(std::int64_t id, const double *attributes) {
        return exactly_ ? identities_.find(id, attributes) : id;
    }
    /// The first want for a point of this identity that is still open, or the end.
    Want *next_for(std::int64_t identity, Want *&first) {
        first = std::lower_bound(
            wants_.begin(), wants_.end(), identity,
            [](const Want &want, std::int64_t sought) { return want.identity < sought; });
        if (first == wants_.end() || first->identity != identity) return wants_.end();
        Want *next = first + first->dealt_with;
        return next == wants_.end() || next->identity != identity ? wants_.end() : next;
    }
    /// Closes the wants that a point of this identity fulfils: one if exactly, or else all.
    template <class Take> std::size_t deal_with(std::int64_t identity, Take take) {
        std::size_t n = 0;
        Want *first;
        for (Want *want;
             (want = next_for(identity, first)) != wants_.end() && (n == 0 || !exactly_); ++n) {
            take(*want);
            ++first->dealt_with;
        }
        return n;
    }
    /// How many wants are for the vertex.
    std::size_t give_to_vertex() {
        const std::optional<std::int64_t> id = read_vertex();
        if (!id) throw_corrupted("A repeated point equals no vertex of the mesh.");
        return deal_with(identity(*id, now_.data()), [](Want &want) { want.is_of_vertex = true; });
    }
    /// How many wants are for a repeated point.
    std::size_t give(std::int64_t identity, std::uint64_t *record) {
        return deal_with(identity, [&](Want &want) {
            want.is_met = true;
            for (std::size_t i = 0; i < which_.size(); ++i)
                record[1 + D + which_[i]] = std::bit_cast<std::uint64_t>(values(want)[i]);
        });
    }
    /// The id of the vertex; exactly, now_ becomes what attributes it has.
    std::optional<std::int64_t> read_vertex() {
        const std::size_t compared = exactly_ ? work_.attributes : 0;
        return work_.core->removal.id_at(place_, {now_.data(), compared});
    }
    /// Whether the vertex has the attributes that a want is for.
    bool vertex_has(const Want &want) {
        if (work_.apart) {
            const std::uint64_t code = work_.domain.code(place_);
            if (!work_.apart->contains(place_, code)) return false;
            work_.apart->get(place_, code, now_.data());
        } else if (!read_vertex()) {
            return false;
        }
        return identities_.find(want.id, now_.data()) == want.identity;
    }
    bool set_of_vertex(const double *values) {
        if (work_.apart) return work_.apart->set(place_, work_.domain.code(place_), which_, values);
        return work_.core->removal.set_attributes(place_, which_, values);
    }

    Workspace<D> &work_;
    const std::span<const std::uint32_t> which_;
    const bool exactly_;
    WaitingChanges<D> waiting_;
    Identities identities_; // wanted at the place, exactly
    Point<D> place_{};
    Arena<Want> wants_; // at the place
    Arena<double> values_;
    std::array<double, ABACUS_MAX_ATTRIBUTES> now_; // of the vertex
    std::optional<std::array<std::uint64_t, 1 + D>> missing_;
    std::uint64_t changed_ = 0;
    std::uint64_t done_ = 0;
};

} // namespace abacus
