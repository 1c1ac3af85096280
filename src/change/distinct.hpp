// Points on their way to the waiting ones, one for each place.
//
// Equal points come one after the other. The last of them goes on to another stage, and points that
// wait at its place are removed, many at a time, since they are in no order. Or the second point at
// a place is refused. All this is only needed while there is no triangulation; with one, each point
// meets the vertex it equals.
#pragma once

#include "change/workspace.hpp"
#include "points/waiting_points.hpp"
#include "staging/stage.hpp"

#include <string>

namespace abacus {

[[noreturn]] inline void throw_duplicate(const std::string &message) {
    throw Error(ABACUS_ERROR_DUPLICATE, message, {},
                "Use on_duplicate => 'replace' to replace the points that are there, or 'keep' to "
                "keep all of them.");
}
[[noreturn]] inline void throw_duplicate(std::int64_t id) {
    throw_duplicate("point " + std::to_string(id) + " is at the place of another point");
}

template <int D> class Distinct final : public RecordSink {
public:
    Distinct(Workspace<D> &work, Stage<D> &onward, bool refuses)
        : work_(work), stride_(work.record_size()), onward_(onward), refuses_(refuses),
          last_(work.host), waiting_(work.host, work.attributes, false) {}

    void add(const std::uint64_t *record) override {
        if (!last_.empty()) {
            const bool is_same = record_point<D>(last_.data()) == record_point<D>(record);
            if (is_same && refuses_) throw_duplicate(record_id(record));
            if (!is_same) pass_on();
            last_.clear();
        }
        std::copy_n(record, stride_, last_.extend(stride_));
    }
    void finish() override {
        if (!last_.empty()) pass_on();
        displace();
    }

    abacus_phase phase() const override { return ABACUS_PHASE_STAGING; }
    PagesMoved pages_moved() const override { return work_.pages_moved(); }

private:
    void pass_on() {
        onward_.add(last_.data(), 1);
        if (!work_.has_waiting()) return;
        waiting_.want(record_point<D>(last_.data()), 0, nullptr);
        if (waiting_.is_full()) displace();
    }
    void displace() {
        if (!work_.has_waiting()) return;
        const std::uint64_t displaced =
            waiting_.take_all(work_.facts->census.inserted, work_.facts->census.staged);
        if (displaced > 0 && refuses_)
            throw_duplicate("a point is at the place of point " +
                            std::to_string(waiting_.last_taken()) + ", which waits");
    }

    Workspace<D> &work_;
    const std::size_t stride_;
    Stage<D> &onward_;
    const bool refuses_;
    Arena<std::uint64_t> last_; // the last record, if any
    WaitingPoints<D> waiting_;
};

} // namespace abacus
