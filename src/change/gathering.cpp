#include "change/gathering.hpp"

#include "blocks/counters.hpp"
#include "host/shared_loop.hpp"
#include "keys/domain_of.hpp"
#include "sort/pacer.hpp"
#include "staging/rounds.hpp"

#include <algorithm>

namespace abacus {

namespace {

/// Points that are worth the pages written and read again, and the threads.
template <int D> constexpr std::size_t worth_sharing = D == 2 ? 1 << 16 : 1 << 15;
/// Share of the memory that gathered points may take, and bytes that they always may.
constexpr std::size_t gathered_share = 3, least_gathered = std::size_t{4} << 20;
/// Points from which on there is room for all: nothing is moved then.
constexpr std::size_t worth_reserving = 1 << 15;
/// Share of the memory that pages on their way to threads may take.
constexpr std::size_t in_hand_share = 8;
/// Points that are gathered between two looks at what threads ask for: some microseconds.
constexpr std::size_t served_every = 512;
/// For tests: points of an interval on average, unless there would be too many of them.
constexpr std::size_t tiny_interval = 4, most_tiny_intervals = 256;

} // namespace

template <int D>
Gathering<D>::Gathering(Workspace<D> &work)
    : work_(work), host_(work.host), gathered_(host_, work.record_size()),
      working_(host_, work.record_size()), left_(host_, work.record_size()) {}

template <int D> void Gathering<D>::begin(User &user, std::uint64_t points, std::size_t words) {
    user_ = &user;
    done_ = 0;
    to_do_ = points;
    gathered_.begin(words);
    // In equal parts: a small one at the end would take as many pages again.
    const std::size_t bytes = std::max(work_.cache_bytes / gathered_share, least_gathered);
    std::uint64_t room = std::max<std::uint64_t>(1, bytes / gathered_bytes(1));
    // Of several batches the next one is gathered while threads insert one.
    gathers_ahead_ = !removes() && points > room && room / 2 >= worth_sharing<D>;
    if (gathers_ahead_) room /= 2;
    const std::uint64_t parts = std::max<std::uint64_t>(1, (points + room - 1) / room);
    most_gathered_ =
        std::max((points + parts - 1) / parts, std::min<std::uint64_t>(room, worth_sharing<D>));
    work_.budget = own_cache_bytes();
    work_.core->cache.set_budget(work_.budget);
}

template <int D> bool Gathering<D>::gathers() const {
    return host_.threads() > 1 &&
           (most_gathered_ >= worth_sharing<D> || host_.has_tiny_intervals());
}

template <int D> std::size_t Gathering<D>::gathered_bytes(std::size_t points) const {
    return gathered_.bytes(user_->keeps_left() ? 2 * points : points);
}

template <int D> std::size_t Gathering<D>::own_cache_bytes() const {
    if (!gathers()) return work_.cache_bytes;
    const std::size_t gathered =
        gathered_bytes(std::min<std::uint64_t>(most_gathered_, to_do_)) * (gathers_ahead_ ? 2 : 1);
    return work_.cache_bytes - std::min(gathered, work_.cache_bytes / gathered_share);
}

template <int D>
void Gathering<D>::gather(const std::uint64_t *records, std::size_t n, std::size_t stride) {
    work_.with_codes(records, n, stride,
                     [&](const std::uint64_t *some, const std::uint64_t *codes, std::size_t count) {
                         gather(some, stride, codes, count);
                     });
}

template <int D>
void Gathering<D>::gather(const std::uint64_t *records, std::size_t words,
                          const std::uint64_t *codes, std::size_t n) {
    while (n > 0) {
        const std::size_t had = gathered_.size();
        const bool begins_round = had > 0 && codes[0] < gathered_.code(had - 1);
        if (had >= most_gathered_ || (begins_round && !takes_several_rounds()))
            change();
        else if (begins_round)
            gathered_.begin_run();
        const std::size_t room = std::min(
            {n, served_every, most_gathered_ - std::min(most_gathered_ - 1, gathered_.size())});
        std::size_t some = 1; // of one round
        while (some < room && codes[some - 1] <= codes[some]) ++some;
        if (gathered_.size() >= worth_reserving) gathered_.reserve(most_gathered_);
        gathered_.add(records, words, codes, some);
        records += some * words;
        codes += some;
        n -= some;
        if (pass_) serve();
    }
}

/// Whether the next round is dealt with together with this one. An early one is inserted here and
/// now if it is small.
template <int D> bool Gathering<D>::takes_several_rounds() const {
    if (removes()) return true;
    const std::size_t last = gathered_.run_size(gathered_.runs() - 1);
    return host_.has_tiny_intervals() ? last % 2 == 0 : last >= worth_sharing<D>;
}

template <int D> void Gathering<D>::serve() {
    if (crew_->serve()) pass_->meanwhile();
}

/// Early rounds alone are hardly worth it: their mesh is in memory, and would have to be read
/// again.
template <int D> bool Gathering<D>::is_worth_sharing() const {
    constexpr std::size_t looked_at = 8; // those of the last round are promoted by chance
    const std::size_t n = gathered_.size();
    if (n < worth_sharing<D>) return false;
    if (user_->deed() != Deed::insert) return true;
    for (std::size_t i = 1; i <= std::min(looked_at, n); ++i)
        if (!Rounds<D>::is_promoted(record_point<D>(gathered_.record(n - i)))) return true;
    return n >= (gathers_ahead_ ? most_gathered_ : most_gathered_ / 2);
}

template <int D> Cuts Gathering<D>::cuts_for_threads() const {
    Cuts cuts(host_);
    if (!user_->is_shared()) return cuts;
    if (host_.has_tiny_intervals())
        cuts.cut_at_random(gathered_,
                           std::max(tiny_interval, gathered_.size() / most_tiny_intervals));
    else if (is_worth_sharing())
        cuts.cut_evenly(gathered_, host_.threads());
    return cuts;
}

template <int D> void Gathering<D>::change() {
    end_work();
    if (gathered_.size() == 0) return;
    cuts_.emplace(cuts_for_threads());
    gathered_.swap(working_);
    gathered_.begin(working_.stride());
    const bool is_shared = cuts_->size() > 1 && begin_work();
    if (is_shared && gathers_ahead_) return; // and goes on while the threads insert
    if (is_shared)
        end_work();
    else
        change_here();
}

template <int D> void Gathering<D>::finish() {
    change();
    end_work();
}

template <int D> void Gathering<D>::change_here() {
    constexpr std::size_t most = Workspace<D>::most_at_once;
    for (std::size_t i = 0; i < working_.size(); i += most) {
        host_.poll();
        user_->take(working_.record(i), working_.codes() + i, std::min(most, working_.size() - i));
    }
    user_->finish_here();
    done_ += working_.size();
    working_.shorten(0);
}

template <int D> void Gathering<D>::report_pass(std::uint64_t done) {
    const auto now = std::chrono::steady_clock::now();
    if (now - reported_ < std::chrono::milliseconds(10)) return;
    reported_ = now;
    const PagesMoved moved = work_.pages_moved();
    const Desk &desk = crew_->desk();
    host_.progress({removes() ? ABACUS_PHASE_DELETING : ABACUS_PHASE_INSERTING, done_ + done,
                    to_do_, moved.read + desk.pages_read(), moved.written + desk.pages_written(),
                    desk.at_work()});
}

/// What the cache of each may take.
template <int D> std::size_t Gathering<D>::thread_cache_bytes() const {
    return (work_.cache_bytes - work_.cache_bytes / gathered_share - work_.in_hand.bytes()) /
           host_.threads();
}

/// Starts the first pass; false if the system grants no thread, or no points are left for it.
template <int D> bool Gathering<D>::begin_work() {
    if (!crew_) crew_.emplace(host_);
    if (!removes() && !host_.has_tiny_intervals()) insert_near_borders(*cuts_);
    if (removes()) {
        work_.repeated->flush(); // threads read them
        if (work_.apart) work_.apart->flush();
    }
    hand_over(*cuts_);
    left_.begin(working_.stride());
    how_ = user_->begin_sharing();
    if (working_.size() > 0 && begin_pass()) return true;
    working_.drop_done();
    user_->end_sharing();
    store_in_hand();
    return false;
}

template <int D> bool Gathering<D>::begin_pass() {
    pass_.emplace(work_, *crew_,
                  typename Pass<D>::Task{working_, *cuts_, thread_cache_bytes(), user_->deed(),
                                         user_->counts_crowded(), how_},
                  [this](std::uint64_t done) { report_pass(done); });
    if (!crew_->begin(host_.threads(), cuts_->size(), *pass_)) pass_.reset();
    return pass_.has_value();
}

/// Waits for the threads, if they are at work, and does what they leave.
template <int D> void Gathering<D>::end_work() {
    if (!pass_) return;
    while (end_pass() && begin_pass()) {
    }
    user_->end_sharing();
    store_in_hand();
    work_.forget_cache();
    for (std::size_t i = 0; i < left_.size(); ++i) {
        if (i % 256 == 0) host_.poll();
        user_->take_left(left_.record(i));
    }
    left_.shorten(0);
    change_here();
}

/// Returns whether so many points are left that they are worth another pass.
template <int D> bool Gathering<D>::end_pass() {
    crew_->finish();
    if (work_.changes != nullptr) work_.changes->take_handed(); // the last one
    Arena<std::size_t> put_off(host_);
    for (const auto &results : pass_->results()) take_results(results, put_off);
    pass_.reset();
    std::sort(put_off.begin(), put_off.end());
    abacus_counters &counters = work_.counters();
    ++counters.passes;
    counters.put_off += put_off.size();
    counters.waited_ns += crew_->desk().waited();
    done_ += working_.size() - put_off.size();
    working_.keep(put_off);
    cuts_->join_pairs();
    const bool is_too_much = how_ != nullptr && how_->outlay.is_too_much();
    const std::size_t least = host_.has_tiny_intervals() ? 1 : worth_sharing<D>;
    return !is_too_much && cuts_->size() > 1 && working_.size() >= least;
}

template <int D>
void Gathering<D>::take_results(const typename Interval<D>::Results &results,
                                Arena<std::size_t> &put_off) {
    abacus_census &census = work_.facts->census;
    census.simplices += static_cast<std::uint64_t>(results.simplices);
    census.ghosts += static_cast<std::uint64_t>(results.ghosts);
    census.vertices += static_cast<std::uint64_t>(results.vertices);
    census.outside += results.crowded;
    work_.counters() += results.counters;
    for (const std::size_t i : results.left) deal_with_left(i);
    for (const std::size_t i : results.put_off) put_off.push_back(i);
    for (const std::size_t i : results.gone)
        work_.apart->drop(record_point<D>(working_.record(i)), working_.code(i));
}

/// What need not wait for the last pass does not take memory until then.
template <int D> void Gathering<D>::deal_with_left(std::size_t i) {
    host_.poll();
    if (user_->keeps_left())
        left_.add(working_.record(i), working_.code(i));
    else
        user_->take_left(working_.record(i));
}

/// Threads find the points, of 32 at a time. Of points with one code all or none are inserted: so
/// of equal ones.
template <int D> void Gathering<D>::insert_near_borders(const Cuts &cuts) {
    using Border = NearBorder<D>;
    using Marks = typename Border::Marks;
    constexpr std::size_t together = Border::together;
    const std::size_t n = working_.size(), words = (n + together - 1) / together;
    Marks *const marks = working_.make_marks();
    SharedLoop(host_).each_stretch(
        words, [&](std::size_t, std::size_t first, std::size_t last, const Host &host) {
            Border border(work_.domain, domain_box<D>(work_.facts->form), cuts);
            Pacer(host).each_piece(last - first, [&](std::size_t begin, std::size_t end) {
                for (std::size_t word = first + begin; word < first + end; ++word)
                    marks[word] = near_border(border, word);
            });
        });
    Batch near(host_, working_.stride());
    const auto insert = [&] {
        if (near.size() > 0) user_->take(near.record(0), near.codes(), near.size());
        near.shorten(0);
    };
    std::uint64_t last = 0; // the code before
    bool is_near = false;
    for (std::size_t word = 0; word < words; ++word) {
        const std::size_t begin = word * together, end = std::min(begin + together, n);
        for (std::size_t i = begin; i < end && is_near != working_.is_done(i); ++i) {
            if (i == 0 || working_.code(i) != last) break;
            marks[word] ^= Marks{1} << (i - begin);
        }
        last = working_.code(end - 1);
        is_near = working_.is_done(end - 1);
        if (marks[word] == 0) continue;
        for (std::size_t i = begin; i < end; ++i) {
            if (working_.is_done(i)) near.add(working_.record(i), working_.code(i));
            if (near.size() == Workspace<D>::most_at_once) insert();
        }
        host_.poll();
    }
    insert();
}

/// Marks those of the points of a word of marks that are near a border. They may be of several
/// rounds.
template <int D>
typename NearBorder<D>::Marks Gathering<D>::near_border(NearBorder<D> &border,
                                                        std::size_t word) const {
    using Marks = typename NearBorder<D>::Marks;
    const std::size_t begin = word * border.together,
                      end = std::min(begin + border.together, working_.size());
    Marks marks = 0;
    for (std::size_t run = 0; run < working_.runs(); ++run) {
        const std::size_t from = std::max(begin, working_.run_begin(run)),
                          to = std::min(end, working_.run_end(run));
        if (from < to) marks |= border.marks(working_, from, to) << (from - begin);
    }
    return marks;
}

template <int D> void Gathering<D>::hand_over(const Cuts &cuts) {
    typename Workspace<D>::Core &core = *work_.core;
    for (std::size_t i = 1; i < cuts.size(); ++i) core.cache.cut(cuts.first(i));
    work_.in_hand.begin(ABACUS_SIMPLEX_PAGES, work_.cache_bytes / in_hand_share);
    core.cache.flush(false); // as packing would move the borders
    work_.in_hand.end(host_);
    crew_->hand_out(work_.in_hand);
    const PagesInHand::Count &kept = work_.in_hand.kept();
    core.cache.counters.stores -= kept.pages;
    core.cache.counters.rewrites -= kept.new_versions;
    core.cache.counters.bytes_written -= kept.bytes;
    work_.facts->census.simplices = static_cast<std::uint64_t>(core.mesh.simplices());
    work_.facts->census.ghosts = static_cast<std::uint64_t>(core.mesh.ghosts());
    work_.forget_cache();
}

/// Threads have counted those that they have stored, as new versions of the pages in hand.
template <int D> void Gathering<D>::store_in_hand() {
    abacus_counters &counters = work_.counters();
    const std::size_t stored_first = work_.in_hand.stored_first();
    const PagesInHand::Count rest = work_.in_hand.store(host_);
    counters.stores += rest.pages;
    counters.rewrites += rest.new_versions - stored_first;
    counters.bytes_written += rest.bytes;
}

template class Gathering<2>;
template class Gathering<3>;

} // namespace abacus
