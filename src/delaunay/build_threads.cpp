// Points inserted by several threads.
//
// Points come in rounds, each along the curve. They are gathered until the next one lies behind, or
// until they take a share of the memory that the build has. A few are inserted here and now, as
// with one thread: those of early rounds, or a small change. Many are inserted together:
//
//   1. The mesh is cut where the threads' intervals begin (cuts.hpp). Points near the borders are
//      inserted by the session's thread (near_border.hpp), and all pages are written.
//   2. Each thread inserts the points of its interval, in a cache of its own (interval.hpp), and
//      writes its pages. The session's thread serves it.
//   3. Some points near borders have been put off. Each two intervals are joined, and what was
//      put off there is inserted in the same way: the border is within, now.
//   4. When there is one interval left, or few points are, the session's thread inserts the rest.
//
// Points that equal a vertex are dealt with at the end, in their order, since their pages are
// those of the session's thread.
#include "delaunay/build.hpp"

#include "delaunay/near_border.hpp"
#include "mesh/counters.hpp"
#include "staging/rounds.hpp"

#include <algorithm>
#include <deque>

namespace abacus {

namespace {

/// Points that are worth the pages written and read again, and the threads.
template <int D> constexpr std::size_t worth_sharing = D == 2 ? 1 << 16 : 1 << 15;
/// Share of the memory that gathered points may take.
constexpr std::size_t gathered_share = 3;
/// Points from which on there is room for all: nothing is moved then.
constexpr std::size_t worth_reserving = 1 << 15;
/// For tests: points of an interval on average, unless there would be too many of them.
constexpr std::size_t tiny_interval = 4, most_tiny_intervals = 256;

} // namespace

/// One pass of all threads: each takes one interval after the other.
template <int D> class Build<D>::Pass final : public Crew::Work {
public:
    Pass(Build &build, const Cuts &cuts, std::size_t cache_bytes)
        : build_(build), cuts_(cuts), cache_bytes_(cache_bytes), host_memory_(build.host_),
          results_(&host_memory_) {
        for (std::size_t i = 0; i < cuts.size(); ++i)
            results_.emplace_back(build.crew_->memory().memory());
    }

    void piece(std::size_t number, const Host &host) override {
        const Batch &batch = build_.gathered_;
        const std::size_t begin = cuts_.begin(number, batch), end = cuts_.end(number, batch);
        if (begin == end) return;
        Interval<D>(host, *build_.header_, cuts_.first(number), cuts_.last(number), cache_bytes_)
            .insert(batch, begin, end, build_.counts_crowded_, done_, results_[number]);
    }
    void meanwhile() override { build_.report_pass(done_.load(std::memory_order_relaxed)); }
    using AllResults = std::pmr::deque<typename Interval<D>::Results>;
    /// Of each interval.
    const AllResults &results() const { return results_; }

private:
    Build &build_;
    const Cuts &cuts_;
    const std::size_t cache_bytes_;
    HostMemory host_memory_;
    AllResults results_;
    std::atomic<std::uint64_t> done_ = 0;
};

template <int D> void Build<D>::begin_to_gather(std::uint64_t points) {
    done_ = 0;
    to_do_ = points;
    // In equal parts: a small one at the end would take as many pages again.
    const std::uint64_t room = std::max<std::uint64_t>(
        cache_bytes_ / gathered_share / gathered_.bytes(1), worth_sharing<D>);
    const std::uint64_t parts = std::max<std::uint64_t>(1, (points + room - 1) / room);
    most_gathered_ = std::max<std::uint64_t>((points + parts - 1) / parts, worth_sharing<D>);
}

template <int D> void Build<D>::gather(const std::uint64_t *record, std::uint64_t code) {
    const std::size_t n = gathered_.size();
    if (n > 0 && (code < gathered_.code(n - 1) || n >= most_gathered_)) insert_gathered();
    if (gathered_.size() == worth_reserving) gathered_.reserve(most_gathered_);
    gathered_.add(record, code);
}

/// An early round is hardly worth it: its mesh is in memory, and would have to be read again.
template <int D> bool Build<D>::is_worth_sharing() const {
    constexpr std::size_t looked_at = 8; // those of the last round are promoted by chance
    const std::size_t n = gathered_.size();
    if (n < worth_sharing<D>) return false;
    for (std::size_t i = 0; i < looked_at; ++i)
        if (!Rounds<D>::is_promoted(record_point<D>(gathered_.record(i)))) return true;
    return n >= most_gathered_ / 2;
}

template <int D> void Build<D>::insert_gathered() {
    if (gathered_.size() == 0) return;
    Cuts cuts(host_);
    if (host_.has_tiny_intervals())
        cuts.cut_at_random(gathered_,
                           std::max(tiny_interval, gathered_.size() / most_tiny_intervals));
    else if (is_worth_sharing())
        cuts.cut_evenly(gathered_, host_.threads());
    if (cuts.size() > 1) insert_on_threads(cuts);
    insert_gathered_here();
}

template <int D> void Build<D>::insert_gathered_here() {
    for (std::size_t i = 0; i < gathered_.size(); i += most_at_once) {
        host_.poll();
        insert_some(gathered_.record(i), gathered_.begin() + i,
                    std::min(most_at_once, gathered_.size() - i));
    }
    done_ += gathered_.size();
    gathered_.shorten(0);
}

template <int D> void Build<D>::report_pass(std::uint64_t done) {
    const auto now = std::chrono::steady_clock::now();
    if (now - reported_ < std::chrono::milliseconds(10)) return;
    reported_ = now;
    const abacus_counters &counters = core_->cache.counters;
    const Desk &desk = crew_->desk();
    host_.progress({ABACUS_PHASE_INSERTING, done_ + done, to_do_,
                    counters.loads + desk.pages_read(), counters.stores + desk.pages_written()});
}

template <int D> void Build<D>::insert_on_threads(Cuts &cuts) {
    const unsigned threads = host_.threads();
    std::size_t least = 1; // points that are worth a pass: of the first one any number
    if (!crew_) crew_.emplace(host_);
    if (!host_.has_tiny_intervals()) insert_near_borders(cuts);
    hand_over(cuts);
    Batch repeated(host_, record_words(D, attributes_));
    for (; cuts.size() > 1 && gathered_.size() >= least; cuts.join_pairs()) {
        Pass pass(*this, cuts, (cache_bytes_ - cache_bytes_ / gathered_share) / threads);
        if (!crew_->run(threads, cuts.size(), pass)) break;
        std::size_t put_off = 0;
        for (const auto &results : pass.results()) {
            header_->simplices += static_cast<std::uint64_t>(results.simplices);
            header_->ghosts += static_cast<std::uint64_t>(results.ghosts);
            header_->vertices += results.vertices;
            header_->outside += results.crowded;
            core_->cache.counters += results.counters;
            for (const std::size_t i : results.is_vertex)
                repeated.add(gathered_.record(i), gathered_.code(i));
            for (const std::size_t i : results.put_off) gathered_.move(i, put_off++);
        }
        done_ += gathered_.size() - put_off;
        gathered_.shorten(put_off);
        if (!host_.has_tiny_intervals()) least = worth_sharing<D>;
    }
    forget_cache();
    for (std::size_t i = 0; i < repeated.size(); ++i) {
        if (i % 256 == 0) host_.poll();
        add_duplicate(repeated.record(i));
    }
}

/// Of equal points, which come one after the other, all or none.
template <int D> void Build<D>::insert_near_borders(const Cuts &cuts) {
    NearBorder<D> border(domain_, cuts);
    Batch near(host_, record_words(D, attributes_));
    const auto insert = [&] {
        if (near.size() > 0) insert_some(near.record(0), near.begin(), near.size());
        done_ += near.size();
        near.shorten(0);
    };
    std::size_t kept = 0;
    Point<D> last{};
    bool is_near = false;
    for (std::size_t begin = 0; begin < gathered_.size(); begin += border.together) {
        const std::size_t end = std::min(begin + border.together, gathered_.size());
        const bool may_be_near = border.look_at(gathered_, begin, end);
        for (std::size_t i = begin; i < end; ++i) {
            const Point<D> p = record_point<D>(gathered_.record(i));
            if (i == 0 || !(p == last))
                is_near = may_be_near && border.is_near(p, gathered_.code(i));
            last = p;
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
    header_->simplices = static_cast<std::uint64_t>(core_->mesh.simplices());
    header_->ghosts = static_cast<std::uint64_t>(core_->mesh.ghosts());
    forget_cache();
}

template <int D> void Build<D>::forget_cache() {
    const abacus_counters counters = core_->cache.counters;
    make_core(*header_);
    core_->cache.counters = counters;
}

template void Build<2>::begin_to_gather(std::uint64_t);
template void Build<3>::begin_to_gather(std::uint64_t);
template void Build<2>::gather(const std::uint64_t *, std::uint64_t);
template void Build<3>::gather(const std::uint64_t *, std::uint64_t);
template void Build<2>::insert_gathered();
template void Build<3>::insert_gathered();
template void Build<2>::forget_cache();
template void Build<3>::forget_cache();

} // namespace abacus
