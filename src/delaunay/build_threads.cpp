// Points inserted, or taken away, by several threads.
//
// Points come in rounds, each along the curve. Those that come are gathered until the next round
// begins; those that leave, in rounds from the last to the first, are gathered over all rounds: the
// mesh is in no memory yet, and is read once. Either until they take a share of the memory that the
// build has. A few are dealt with here and now, as with one thread: those of early rounds, or a
// small change. Many are dealt with together:
//
//   1. The mesh is cut where the threads' intervals begin (cuts.hpp). Points near the borders are
//      inserted by the session's thread (near_border.hpp), and all pages are written.
//   2. Each thread inserts or takes away the points of its interval, in a cache of its own
//      (interval.hpp), and writes its pages. The session's thread serves it.
//   3. Some points near borders have been put off. Each two intervals are joined, and what was
//      put off there is dealt with in the same way: the border is within, now.
//   4. When there is one interval left, or few points are, the session's thread does the rest.
//
// Points that equal a vertex are dealt with by the session's thread after each pass, in their
// order, since their pages are its own; at the end if they give the vertex another id. Those points
// that are at a place with such ones leave at the end.
//
// No points near borders leave first. The session's thread would have to read the mesh for them,
// and the stars of the full mesh are small.
#include "delaunay/build.hpp"

#include "blocks/counters.hpp"
#include "delaunay/near_border.hpp"
#include "delaunay/outlet.hpp"
#include "staging/rounds.hpp"

#include <algorithm>
#include <deque>

namespace abacus {

namespace {

/// Points that are worth the pages written and read again, and the threads.
template <int D> constexpr std::size_t worth_sharing = D == 2 ? 1 << 16 : 1 << 15;
/// Share of the memory that gathered points may take, and bytes that they always may.
constexpr std::size_t gathered_share = 3, least_gathered = std::size_t{4} << 20;
/// Points from which on there is room for all: nothing is moved then.
constexpr std::size_t worth_reserving = 1 << 15;
/// For tests: points of an interval on average, unless there would be too many of them.
constexpr std::size_t tiny_interval = 4, most_tiny_intervals = 256;

} // namespace

/// One pass of all threads: each takes one interval after the other.
template <int D> class Build<D>::Pass final : public Crew::Work {
public:
    /// With `how`, points are taken away.
    Pass(Build &build, const Cuts &cuts, const typename Interval<D>::Removing *how)
        : build_(build), cuts_(cuts), how_(how), host_memory_(build.host_),
          results_(&host_memory_) {
        for (std::size_t i = 0; i < cuts.size(); ++i)
            results_.emplace_back(build.crew_->memory().memory());
        if (build.changes_ != nullptr) build.changes_->work_with(*build.crew_);
    }
    Pass(const Pass &) = delete;
    Pass &operator=(const Pass &) = delete;
    ~Pass() {
        if (build_.changes_ != nullptr) build_.changes_->drop_handed();
    }

    void piece(std::size_t number, const Host &host) override {
        const Batch &batch = build_.gathered_;
        std::optional<Interval<D>> interval;
        for (std::size_t run = 0; run < batch.runs(); ++run) {
            const std::size_t begin = cuts_.begin(number, batch, run),
                              end = cuts_.end(number, batch, run);
            if (begin == end) continue;
            if (!interval)
                interval.emplace(host, *build_.facts_, cuts_.first(number), cuts_.last(number),
                                 build_.thread_cache_bytes(), build_.changes_);
            if (how_ != nullptr)
                interval->remove(batch, begin, end, *how_, done_, results_[number]);
            else
                interval->insert(batch, begin, end, build_.counts_crowded_, done_,
                                 results_[number]);
        }
        if (interval) interval->finish(results_[number]);
    }
    void meanwhile() override {
        if (build_.changes_ != nullptr) build_.changes_->take_handed();
        build_.report_pass(done_.load(std::memory_order_relaxed));
    }
    using AllResults = std::pmr::deque<typename Interval<D>::Results>;
    /// Of each interval.
    const AllResults &results() const { return results_; }

private:
    Build &build_;
    const Cuts &cuts_;
    const typename Interval<D>::Removing *const how_;
    HostMemory host_memory_;
    AllResults results_;
    std::atomic<std::uint64_t> done_ = 0;
};

template <int D> void Build<D>::begin_to_gather(std::uint64_t points, std::size_t words) {
    done_ = 0;
    to_do_ = points;
    gathered_.begin(words);
    // In equal parts: a small one at the end would take as many pages again.
    const std::uint64_t room = std::max<std::uint64_t>(
        1, std::max(cache_bytes_ / gathered_share, least_gathered) / gathered_bytes(1));
    const std::uint64_t parts = std::max<std::uint64_t>(1, (points + room - 1) / room);
    most_gathered_ =
        std::max((points + parts - 1) / parts, std::min<std::uint64_t>(room, worth_sharing<D>));
    core_->cache.set_budget(own_cache_bytes());
}

template <int D> bool Build<D>::gathers() const {
    return host_.threads() > 1 &&
           (most_gathered_ >= worth_sharing<D> || host_.has_tiny_intervals());
}

template <int D> std::size_t Build<D>::gathered_bytes(std::size_t points) const {
    const bool may_wait = outlet_ != nullptr || on_duplicate_ == ABACUS_REPLACE;
    return gathered_.bytes(may_wait ? 2 * points : points);
}

template <int D> std::size_t Build<D>::own_cache_bytes() const {
    if (!gathers()) return cache_bytes_;
    const std::size_t gathered = gathered_bytes(std::min<std::uint64_t>(most_gathered_, to_do_));
    return cache_bytes_ - std::min(gathered, cache_bytes_ / gathered_share);
}

template <int D>
void Build<D>::gather_one(const std::uint64_t *record, std::size_t words, std::uint64_t code) {
    const std::size_t n = gathered_.size();
    const bool begins_round = n > 0 && code < gathered_.code(n - 1);
    if (n >= most_gathered_ || (begins_round && outlet_ == nullptr))
        change_gathered();
    else if (begins_round)
        gathered_.begin_run();
    if (gathered_.size() == worth_reserving) gathered_.reserve(most_gathered_);
    gathered_.add(record, words, code);
}

/// An early round is hardly worth it: its mesh is in memory, and would have to be read again.
template <int D> bool Build<D>::is_worth_sharing() const {
    constexpr std::size_t looked_at = 8; // those of the last round are promoted by chance
    const std::size_t n = gathered_.size();
    if (n < worth_sharing<D>) return false;
    if (outlet_ != nullptr) return true;
    for (std::size_t i = 0; i < looked_at; ++i)
        if (!Rounds<D>::is_promoted(record_point<D>(gathered_.record(i)))) return true;
    return n >= most_gathered_ / 2;
}

template <int D> Cuts Build<D>::cuts_for_threads() const {
    Cuts cuts(host_);
    if (outlet_ != nullptr && !outlet_->is_shared()) return cuts;
    if (host_.has_tiny_intervals())
        cuts.cut_at_random(gathered_,
                           std::max(tiny_interval, gathered_.size() / most_tiny_intervals));
    else if (is_worth_sharing())
        cuts.cut_evenly(gathered_, host_.threads());
    return cuts;
}

template <int D> void Build<D>::change_gathered() {
    if (gathered_.size() == 0) return;
    Cuts cuts = cuts_for_threads();
    if (cuts.size() > 1) change_on_threads(cuts);
    outlet_ != nullptr ? remove_gathered_here() : insert_gathered_here();
}

template <int D> void Build<D>::insert_gathered_here() {
    for (std::size_t i = 0; i < gathered_.size(); i += most_at_once) {
        host_.poll();
        insert_some(gathered_.record(i), gathered_.codes() + i,
                    std::min(most_at_once, gathered_.size() - i));
    }
    done_ += gathered_.size();
    gathered_.shorten(0);
}

template <int D> void Build<D>::remove_gathered_here() {
    for (std::size_t i = 0; i < gathered_.size(); ++i) outlet_->take(gathered_.record(i));
    outlet_->finish_place();
    done_ += gathered_.size();
    gathered_.shorten(0);
}

template <int D> void Build<D>::report_pass(std::uint64_t done) {
    const auto now = std::chrono::steady_clock::now();
    if (now - reported_ < std::chrono::milliseconds(10)) return;
    reported_ = now;
    const abacus_counters &counters = core_->cache.counters;
    const Desk &desk = crew_->desk();
    host_.progress({outlet_ != nullptr ? ABACUS_PHASE_DELETING : ABACUS_PHASE_INSERTING,
                    done_ + done, to_do_, counters.loads + desk.pages_read(),
                    counters.stores + desk.pages_written(), desk.at_work()});
}

/// What the cache of each may take.
template <int D> std::size_t Build<D>::thread_cache_bytes() const {
    return (cache_bytes_ - cache_bytes_ / gathered_share) / host_.threads();
}

template <int D> void Build<D>::change_on_threads(Cuts &cuts) {
    if (!crew_) crew_.emplace(host_);
    const bool leave = outlet_ != nullptr;
    if (!leave && !host_.has_tiny_intervals()) insert_near_borders(cuts);
    if (leave) {
        repeated_->flush(); // threads read them
        if (apart_) apart_->flush();
    }
    hand_over(cuts);
    Batch left(host_, gathered_.stride());
    if (leave)
        outlet_->share([&](const auto &how) { run_passes(cuts, left, &how); });
    else
        run_passes(cuts, left, nullptr);
    forget_cache();
    for (std::size_t i = 0; i < left.size(); ++i) {
        if (i % 256 == 0) host_.poll();
        leave ? outlet_->take(left.record(i)) : add_duplicate(left.record(i));
    }
}

template <int D>
void Build<D>::run_passes(Cuts &cuts, Batch &left, const typename Interval<D>::Removing *how) {
    std::size_t least = 1; // points that are worth a pass: of the first one any number
    for (; cuts.size() > 1 && gathered_.size() >= least; cuts.join_pairs()) {
        Pass pass(*this, cuts, how);
        if (!crew_->run(host_.threads(), cuts.size(), pass)) return;
        if (changes_ != nullptr) changes_->take_handed(); // the last one
        Arena<std::size_t> put_off(host_);
        for (const auto &results : pass.results()) {
            facts_->census.simplices += static_cast<std::uint64_t>(results.simplices);
            facts_->census.ghosts += static_cast<std::uint64_t>(results.ghosts);
            facts_->census.vertices += static_cast<std::uint64_t>(results.vertices);
            facts_->census.outside += results.crowded;
            core_->cache.counters += results.counters;
            for (const std::size_t i : results.left) deal_with_left(i, left);
            for (const std::size_t i : results.put_off) put_off.push_back(i);
            for (const std::size_t i : results.gone)
                apart_->drop(record_point<D>(gathered_.record(i)), gathered_.code(i));
        }
        std::sort(put_off.begin(), put_off.end());
        abacus_counters &counters = core_->cache.counters;
        ++counters.passes;
        counters.put_off += put_off.size();
        counters.waited_ns += crew_->desk().waited();
        done_ += gathered_.size() - put_off.size();
        gathered_.keep(put_off);
        if (!host_.has_tiny_intervals()) least = worth_sharing<D>;
        if (how != nullptr && how->outlay.is_too_much()) return;
    }
}

/// What need not wait for the last pass does not take memory until then.
template <int D> void Build<D>::deal_with_left(std::size_t i, Batch &left) {
    host_.poll();
    if (outlet_ != nullptr || on_duplicate_ == ABACUS_REPLACE)
        left.add(gathered_.record(i), gathered_.code(i));
    else
        add_duplicate(gathered_.record(i));
}

/// Of points with one code, which come one after the other, all or none: so of equal ones.
template <int D> void Build<D>::insert_near_borders(const Cuts &cuts) {
    NearBorder<D> border(domain_, cuts);
    Batch near(host_, gathered_.stride());
    const auto insert = [&] {
        if (near.size() > 0) insert_some(near.record(0), near.codes(), near.size());
        done_ += near.size();
        near.shorten(0);
    };
    std::size_t kept = 0;
    std::uint64_t last = 0;
    bool is_near = false;
    for (std::size_t begin = 0; begin < gathered_.size(); begin += border.together) {
        const std::size_t end = std::min(begin + border.together, gathered_.size());
        const bool may_be_near = border.look_at(gathered_, begin, end);
        for (std::size_t i = begin; i < end; ++i) {
            const std::uint64_t code = gathered_.code(i);
            if (i == 0 || code != last)
                is_near = may_be_near && border.is_near(record_point<D>(gathered_.record(i)), code);
            last = code;
            if (is_near)
                near.add(gathered_.record(i), gathered_.code(i));
            else
                gathered_.move(i, kept++);
            if (near.size() == most_at_once) insert();
        }
        host_.poll();
    }
    insert();
    gathered_.shorten(kept);
}

template <int D> void Build<D>::hand_over(const Cuts &cuts) {
    for (std::size_t i = 1; i < cuts.size(); ++i) core_->cache.cut(cuts.first(i));
    core_->cache.flush(false); // as packing would move the borders
    facts_->census.simplices = static_cast<std::uint64_t>(core_->mesh.simplices());
    facts_->census.ghosts = static_cast<std::uint64_t>(core_->mesh.ghosts());
    forget_cache();
}

template <int D> void Build<D>::forget_cache() {
    const abacus_counters counters = core_->cache.counters;
    make_core(*facts_, own_cache_bytes());
    core_->cache.counters = counters;
}

template void Build<2>::begin_to_gather(std::uint64_t, std::size_t);
template void Build<3>::begin_to_gather(std::uint64_t, std::size_t);
template bool Build<2>::gathers() const;
template bool Build<3>::gathers() const;
template void Build<2>::gather_one(const std::uint64_t *, std::size_t, std::uint64_t);
template void Build<3>::gather_one(const std::uint64_t *, std::size_t, std::uint64_t);
template void Build<2>::change_gathered();
template void Build<3>::change_gathered();
template std::size_t Build<2>::thread_cache_bytes() const;
template std::size_t Build<3>::thread_cache_bytes() const;
template void Build<2>::forget_cache();
template void Build<3>::forget_cache();

} // namespace abacus
