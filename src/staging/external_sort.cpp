#include "staging/external_sort.hpp"

#include <algorithm>

namespace abacus {
namespace {

/// What an open spool costs the host: a database buffers a page of each file.
constexpr std::size_t host_bytes_per_spool = 8192;
/// More spools at once would only make the writes smaller.
constexpr unsigned most_spools = 256;
constexpr std::size_t least_piece_bytes = 8192, most_piece_bytes = 65536;
/// Page being filled, handle, lists of parts.
constexpr std::size_t overhead = 65536;
/// Share of the memory that a part is meant to fill; the rest is for the errors
/// of the sample.
constexpr double fill = 0.75;
/// A part that is sorted in the processor's cache: its records come to the sink without
/// misses. Smaller ones than memory holds, then, where spools can be had for them.
constexpr std::size_t cached_part_bytes = std::size_t{1} << 20;
/// Records that are copied together from where they lie in memory. Each is a miss of all
/// caches, that of page addresses included; in a loop of its own many are under way at once.
constexpr std::size_t gathered_at_once = 64;

} // namespace

SortBudget::SortBudget(std::size_t memory, std::size_t record_bytes, std::size_t dimension) {
    // A sample takes three words beside its points while it is sorted.
    const std::size_t sample_bytes = 8 * dimension + 24;
    std::size_t left = std::max(memory, least) - overhead;
    sampled = std::clamp<std::size_t>(left / 16 / sample_bytes, 256, 16384);
    left -= sampled * sample_bytes;
    // The spools that wait, at all depths, are at most twice as many as are written at
    // once: a quarter of the memory.
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

template <int D> void ExternalSort<D>::run(Spool &spool, const Slice<D> &slice) {
    const std::uint64_t n = spool.size();
    open_spools_ = 1;
    Arena<Part> parts(host_);
    pacer_.begin(ABACUS_PHASE_SORTING, n);
    cut(spool, slice, parts, true);
    pacer_.begin(sink_.phase(), n);
    sort_parts(parts);
}

template <int D> void ExternalSort<D>::sort_parts(Arena<Part> &parts) {
    for (Part &part : parts) sort_spool(part.spool, part.slice);
}

template <int D> void ExternalSort<D>::sort_spool(Spool &spool, const Slice<D> &slice) {
    const std::uint64_t n = spool.size();
    if (n <= budget_.records) {
        records_.reserve(n * stride_);
        spool.rewind(host_);
        for (std::size_t at = 0; at < n; pacer_.poll())
            at += spool.read(host_, records_.data() + at * stride_, budget_.piece, stride_);
        close(spool);
        emit(records_.data(), sort_.sort(records_.data(), n, slice, pacer_), n);
        return;
    }
    sort_.release();
    const Box<D> box = survey(spool);
    if (slice.has_one_code() && box.is_point()) return emit_as_is(spool);
    Arena<Part> parts(host_);
    cut(spool, slice.has_one_code() ? Slice<D>{Domain<D>(box.lower, box.upper)} : slice, parts,
        false);
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

/// How many parts a slice is cut into. Spools that wait at the depths above
/// leave fewer and fewer to the depths below.
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

/// Distributes a spool over spools, one for each part of its slice.
template <int D>
void ExternalSort<D>::cut(Spool &spool, const Slice<D> &slice, Arena<Part> &parts, bool report) {
    const Splitters<D> splitters(host_, slice, sample_, parts_for(spool.size(), slice));
    parts.reserve(splitters.size());
    for (unsigned i = 0; i < splitters.size(); ++i) parts.push_back({Spool(), splitters.slice(i)});
    distribute(spool, splitters, parts, report);
    close(spool);
}

template <int D>
void ExternalSort<D>::distribute(Spool &spool, const Splitters<D> &splitters, Arena<Part> &parts,
                                 bool report) {
    const std::size_t piece = budget_.piece, piece_words = piece * stride_;
    records_.reset();
    records_.reserve((parts.size() + 1) * piece_words);
    std::uint64_t *const input = records_.data() + parts.size() * piece_words;
    Arena<std::size_t> waiting(host_); // records in the buffer of each part
    waiting.resize(parts.size());
    std::fill(waiting.begin(), waiting.end(), 0);
    const auto write = [&](std::size_t part) {
        if (parts[part].spool.size() == 0) ++open_spools_;
        parts[part].spool.write(host_, records_.data() + part * piece_words, waiting[part],
                                stride_);
        waiting[part] = 0;
    };

    spool.rewind(host_);
    std::uint64_t done = 0;
    while (const std::size_t n = spool.read(host_, input, piece, stride_)) {
        for (std::size_t i = 0; i < n; ++i) {
            const std::uint64_t *record = input + i * stride_;
            const unsigned part = splitters.part(record_point<D>(record));
            std::uint64_t *to = records_.data() + part * piece_words + waiting[part] * stride_;
            for (std::size_t word = 0; word < stride_; ++word) to[word] = record[word];
            if (++waiting[part] == piece) write(part);
        }
        done += n;
        report ? pacer_.reached(done) : pacer_.poll();
    }
    for (std::size_t part = 0; part < parts.size(); ++part)
        if (waiting[part] > 0) write(part);
    records_.reset();
}

template <int D>
void ExternalSort<D>::emit(const std::uint64_t *records, const std::uint64_t *order,
                           std::size_t n) {
    gathered_.reserve(gathered_at_once * stride_);
    pacer_.each_piece(n, [&](std::size_t begin, std::size_t end) {
        for (std::size_t first = begin; first < end; first += gathered_at_once) {
            const std::size_t some = std::min(gathered_at_once, end - first);
            std::uint64_t *to = gathered_.data();
            for (std::size_t i = 0; i < some; ++i, to += stride_) {
                const std::uint64_t *record = records + (order[first + i] & index_mask) * stride_;
                for (std::size_t word = 0; word < stride_; ++word) to[word] = record[word];
            }
            for (std::size_t i = 0; i < some; ++i) sink_.add(gathered_.data() + i * stride_);
        }
        handed_on(end - begin);
    });
}

/// Equal points are in order already.
template <int D> void ExternalSort<D>::emit_as_is(Spool &spool) {
    spool.rewind(host_);
    while (const std::size_t n = spool.read(host_, records_.data(), budget_.piece, stride_)) {
        for (std::size_t i = 0; i < n; ++i) sink_.add(records_.data() + i * stride_);
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
