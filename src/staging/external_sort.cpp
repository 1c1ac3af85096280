#include "staging/external_sort.hpp"

#include "points/spread.hpp"

#include <algorithm>
#include <cmath>

namespace abacus {
namespace {

/// What an open spool costs the host: a database buffers a page of each file.
constexpr std::size_t host_bytes_per_spool = 8192;
/// More spools at once would only make the writes smaller.
constexpr unsigned most_spools = 256;
constexpr std::size_t least_piece_bytes = 8192, most_piece_bytes = 16384;
/// The page being filled, the handle, the lists of parts.
constexpr std::size_t overhead = 65536;
/// Share of the memory that a part should fill; the rest allows for errors of the sample.
constexpr double fill = 0.75;
/// The size of a part that is sorted in the processor's cache: its records come to the sink without
/// misses. So parts are smaller than memory if there are spools for them.
constexpr std::size_t cached_part_bytes = std::size_t{1} << 20;
/// Records that are copied together from their places in memory. Each copy misses all caches, even
/// that of page addresses. In a loop of their own, many of these misses overlap.
constexpr std::size_t gathered_at_once = 64;
/// Parts that a thread sorts at a time: more of them would leave the processor's cache.
constexpr std::size_t parts_a_thread = 2;

} // namespace

SortBudget::SortBudget(std::size_t memory, std::size_t record_bytes, std::size_t dimension) {
    // A sample takes three words beside its points while it is sorted.
    const std::size_t sample_bytes = 8 * dimension + 24;
    std::size_t left = std::max(memory, least) - overhead -
                       (dimension == 2 ? Spread<2>::most_bytes : Spread<3>::most_bytes);
    sampled = std::clamp<std::size_t>(left / 16 / sample_bytes, 256, 16384);
    left -= sampled * sample_bytes;
    // The waiting spools, at all depths, are at most twice as many as are written at once. They get
    // a quarter of the memory.
    spools = static_cast<unsigned>(
        std::clamp<std::size_t>(left / 8 / host_bytes_per_spool, 4, most_spools));
    left -= 2 * spools * host_bytes_per_spool;
    piece = std::clamp(left / (spools + 1), least_piece_bytes, most_piece_bytes) / record_bytes;
    records = std::min(left / (record_bytes + sort_bytes_per_record), most_sorted_records);
}

template <int D>
ExternalSort<D>::ExternalSort(const Host &host, std::size_t stride, const SortBudget &budget,
                              Sample<D> &sample, Pacer &pacer, RecordSink &sink)
    : host_(host), stride_(stride), budget_(budget), sample_(sample), pacer_(pacer), sink_(sink),
      sort_(host, stride), records_(host), gathered_(host) {}

template <int D>
void ExternalSort<D>::run(const std::uint64_t *records, std::size_t n, const Slice<D> &slice) {
    pacer_.begin(ABACUS_PHASE_SORTING, n);
    const std::uint64_t *order = sort_.sort(records, n, slice, pacer_);
    pacer_.begin(sink_.phase(), n);
    emit(records, order, n);
}

template <int D> void ExternalSort<D>::run(Arena<Spool> &spools, const Slice<D> &slice) {
    std::uint64_t n = 0;
    for (const Spool &spool : spools) n += spool.size();
    open_spools_ = static_cast<unsigned>(spools.size());
    pacer_.begin(ABACUS_PHASE_SORTING, n);
    Arena<Part<D>> parts = cut(spools.data(), spools.size(), slice, true);
    pacer_.begin(sink_.phase(), n);
    sort_parts(parts);
}

template <int D> void ExternalSort<D>::run(Arena<Part<D>> &parts) {
    std::uint64_t n = 0;
    for (const Part<D> &part : parts) {
        n += part.spool.size();
        open_spools_ += part.spool.size() > 0;
    }
    pacer_.begin(ABACUS_PHASE_SORTING, n); // continues between the sink's steps
    pacer_.poll();
    pacer_.begin(sink_.phase(), n);
    sort_parts(parts);
}

template <int D> void ExternalSort<D>::sort_parts(Arena<Part<D>> &parts) {
    for (std::size_t at = 0; at < parts.size();) {
        const std::size_t n = parts_at_once(parts, at);
        if (n > 1)
            sort_together(&parts[at], n);
        else
            sort_spool(parts[at].spool, parts[at].slice);
        at += n;
    }
}

/// How many parts from this one on are sorted together: as many as the threads can use, or as are
/// needed to be worth it, if they fit into memory.
template <int D>
std::size_t ExternalSort<D>::parts_at_once(const Arena<Part<D>> &parts, std::size_t first) const {
    if (host_.threads() == 1) return 1;
    const std::size_t usual = parts_a_thread * host_.threads();
    std::uint64_t records = 0;
    std::size_t n = 0;
    for (; first + n < parts.size() && (n < usual || !sort_.is_shared(records)); ++n) {
        const std::uint64_t more = parts[first + n].spool.size();
        if (records + more > budget_.records) break;
        records += more;
    }
    return n > 1 && sort_.is_shared(records) ? n : 1;
}

template <int D> void ExternalSort<D>::sort_together(Part<D> *parts, std::size_t n) {
    Arena<typename CurveSort<D>::Run> runs(host_);
    std::size_t end = 0;
    for (std::size_t i = 0; i < n; ++i) {
        const std::size_t begin = end;
        runs.push_back({begin, end += parts[i].spool.size(), parts[i].slice});
    }
    records_.reserve(end * stride_);
    for (std::size_t i = 0; i < n; ++i)
        read(parts[i].spool, records_.data() + runs[i].begin * stride_);
    const std::uint64_t *order = sort_.sort_each(records_.data(), runs, pacer_);
    emit(records_.data(), order, end);
}

/// Reads all records of a spool, and closes it.
template <int D> void ExternalSort<D>::read(Spool &spool, std::uint64_t *to) {
    spool.rewind(host_);
    while (const std::size_t n = spool.read(host_, to, budget_.piece, stride_)) {
        to += n * stride_;
        sink_.meanwhile();
        pacer_.poll();
    }
    close(spool);
}

template <int D> void ExternalSort<D>::sort_spool(Spool &spool, const Slice<D> &slice) {
    const std::uint64_t n = spool.size();
    if (n <= budget_.records) {
        records_.reserve(n * stride_);
        read(spool, records_.data());
        emit(records_.data(), sort_.sort(records_.data(), n, slice, pacer_), n);
        return;
    }
    sort_.release();
    const Box<D> box = survey(spool);
    if (slice.has_one_code() && box.is_point()) return emit_as_is(spool);
    Arena<Part<D>> parts = cut(
        &spool, 1, slice.has_one_code() ? Slice<D>{Domain<D>(box.lower, box.upper)} : slice, false);
    sort_parts(parts);
}

/// Takes a sample and the bounding box of a spool.
template <int D> Box<D> ExternalSort<D>::survey(Spool &spool) {
    records_.reset();
    records_.reserve(budget_.piece * stride_);
    sample_.clear();
    Box<D> box;
    spool.rewind(host_);
    while (const std::size_t n = spool.read(host_, records_.data(), budget_.piece, stride_)) {
        for (std::size_t i = 0; i < n; ++i) {
            const Point<D> point = record_point<D>(records_.data() + i * stride_);
            box.extend(point);
            sample_.add(point);
        }
        pacer_.poll();
    }
    return box;
}

/// How many parts a slice is cut into. Waiting spools at upper depths leave fewer for the depths
/// below.
template <int D>
unsigned ExternalSort<D>::parts_for(std::uint64_t records, const Slice<D> &slice) const {
    const unsigned rounds = slice.rounds == nullptr ? 0 : slice.rounds->size();
    const unsigned room = (2 * budget_.spools - std::min(2 * budget_.spools, open_spools_)) / 2;
    const double part = std::min(fill * static_cast<double>(budget_.records),
                                 static_cast<double>(cached_part_bytes / (8 * stride_)));
    const double wanted = std::ceil(static_cast<double>(records) / part);
    // Cutting between rounds and rounding up add one part a round.
    return static_cast<unsigned>(
        std::min<double>(wanted, std::max(3u, room > rounds ? room - rounds : 0)));
}

/// Distributes spools over spools, one for each part of their slice, and closes them.
template <int D>
Arena<Part<D>> ExternalSort<D>::cut(Spool *spools, std::size_t n, const Slice<D> &slice,
                                    bool report) {
    std::uint64_t records = 0;
    for (std::size_t i = 0; i < n; ++i) records += spools[i].size();
    // The room of a spool that is read is freed only at its end.
    if (n == 1) host_.spool_expect(static_cast<double>(records * stride_ * sizeof(std::uint64_t)));
    Distributor<D> distributor(host_, stride_, budget_.piece, slice, sample_,
                               parts_for(records, slice));
    records_.reset();
    records_.reserve(budget_.piece * stride_);
    for (std::size_t i = 0; i < n; ++i) {
        spools[i].rewind(host_);
        while (const std::size_t read =
                   spools[i].read(host_, records_.data(), budget_.piece, stride_)) {
            for (std::size_t r = 0; r < read; ++r) distributor.add(records_.data() + r * stride_);
            report ? pacer_.reached(distributor.size()) : pacer_.poll();
        }
        close(spools[i]);
    }
    records_.reset();
    Arena<Part<D>> parts = distributor.finish();
    for (const Part<D> &part : parts) open_spools_ += part.spool.size() > 0;
    return parts;
}

template <int D>
void ExternalSort<D>::emit(const std::uint64_t *records, const std::uint64_t *order,
                           std::size_t n) {
    if (sink_.takes_codes() && sort_.is_shared(n) && n > stride_)
        return emit_by_threads(records, order, n);
    gathered_.reserve(gathered_at_once * stride_);
    pacer_.each_piece(n, [&](std::size_t begin, std::size_t end) {
        for (std::size_t first = begin; first < end; first += gathered_at_once) {
            const std::size_t some = std::min(gathered_at_once, end - first);
            gather(records, order + first, some, gathered_.data());
            sink_.add(gathered_.data(), some, stride_);
        }
        handed_on(end - begin);
    });
}

/// Copies records in their order.
template <int D>
void ExternalSort<D>::gather(const std::uint64_t *records, const std::uint64_t *order,
                             std::size_t n, std::uint64_t *to) const {
    for (std::size_t i = 0; i < n; ++i, to += stride_) {
        const std::uint64_t *record = records + (order[i] & index_mask) * stride_;
        for (std::size_t word = 0; word < stride_; ++word) to[word] = record[word];
    }
}

/// As many at a time as the words that the sort no longer needs have room for, with their codes.
template <int D>
void ExternalSort<D>::emit_by_threads(const std::uint64_t *records, const std::uint64_t *order,
                                      std::size_t n) {
    const std::size_t room = n / (stride_ + 1);
    std::uint64_t *const codes = sort_.free_words(), *const gathered = codes + room;
    for (std::size_t first = 0; first < n; first += room) {
        const std::size_t some = std::min(room, n - first);
        sort_.each_piece(some, [&](std::size_t begin, std::size_t end) {
            std::uint64_t *const to = gathered + begin * stride_;
            gather(records, order + first + begin, end - begin, to);
            sink_.find_codes(to, end - begin, stride_, codes + begin);
        });
        pacer_.each_piece(some, [&](std::size_t begin, std::size_t end) {
            sink_.add(gathered + begin * stride_, codes + begin, end - begin, stride_);
            handed_on(end - begin);
        });
    }
}

/// Equal points are already in order.
template <int D> void ExternalSort<D>::emit_as_is(Spool &spool) {
    spool.rewind(host_);
    while (const std::size_t n = spool.read(host_, records_.data(), budget_.piece, stride_)) {
        sink_.add(records_.data(), n, stride_);
        handed_on(n);
    }
    close(spool);
}

template <int D> void ExternalSort<D>::close(Spool &spool) {
    if (spool.size() > 0) --open_spools_;
    spool.close(host_);
}

template class ExternalSort<2>;
template class ExternalSort<3>;

} // namespace abacus
