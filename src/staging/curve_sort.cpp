#include "staging/curve_sort.hpp"

#include <cstring>

namespace abacus {

template <int D>
const std::uint64_t *CurveSort<D>::sort(const std::uint64_t *records, std::size_t n,
                                        const Slice<D> &slice, Pacer &pacer) {
    begin(records, n, pacer);
    if (is_shared(n)) {
        shared_.sort(
            words_, scratch_, n, slice.first_bits(),
            [&](std::uint64_t *to, std::size_t from, std::size_t end) {
                set_words(to, from, end, slice);
            },
            [&](std::size_t from, std::size_t end, const Pacer &piece) {
                refine_ties(from, end, slice, piece);
            });
    } else {
        sort_run({0, n, slice}, pacer);
    }
    return words_;
}

template <int D>
const std::uint64_t *CurveSort<D>::sort_each(const std::uint64_t *records, const Arena<Run> &runs,
                                             Pacer &pacer) {
    begin(records, runs[runs.size() - 1].end, pacer);
    shared_.each(runs.size(),
                 [&](std::size_t i, const Host &host) { sort_run(runs[i], Pacer(host)); });
    return words_;
}

template <int D>
void CurveSort<D>::begin(const std::uint64_t *records, std::size_t n, const Pacer &pacer) {
    records_ = records;
    // This may be much memory, and a single request for all of it could not be interrupted.
    memory_.reserve(2 * n);
    pacer.each_piece(2 * n, [&](std::size_t, std::size_t end) { memory_.resize(end); });
    words_ = memory_.data();
    scratch_ = words_ + n;
}

template <int D>
void CurveSort<D>::set_words(std::uint64_t *to, std::size_t begin, std::size_t end,
                             const Slice<D> &slice) const {
    for (std::size_t i = begin; i < end; ++i)
        to[i] = slice.first_key(record_point<D>(records_ + i * stride_)) << index_bits | i;
}

template <int D> void CurveSort<D>::sort_run(const Run &run, const Pacer &pacer) {
    const std::size_t n = run.end - run.begin;
    pacer.each_piece(n, [&](std::size_t begin, std::size_t end) {
        set_words(scratch_, run.begin + begin, run.begin + end, run.slice);
    });
    radix_sort_into(words_ + run.begin, scratch_ + run.begin, n, pacer);
    refine_ties(run.begin, run.end, run.slice, pacer);
}

template <int D>
template <class Key>
void CurveSort<D>::set_keys(std::size_t begin, std::size_t end, Key key) {
    for (std::size_t i = begin; i < end; ++i)
        words_[i] = key(point(words_[i])) << index_bits | (words_[i] & index_mask);
}

template <int D>
void CurveSort<D>::sort_words(std::size_t begin, std::size_t end, const Pacer &pacer) {
    const std::size_t n = end - begin;
    std::uint64_t *words = words_ + begin;
    if (n <= few) return sort_few(words, n);
    const std::uint64_t *sorted = radix_sort(words, scratch_ + begin, n, pacer);
    if (sorted != words) std::memcpy(words, sorted, n * sizeof(std::uint64_t));
}

/// Calls each(begin, end) for all runs of two or more equal keys.
template <int D>
template <class Each>
void CurveSort<D>::each_tie(std::size_t begin, std::size_t end, Each each) {
    for (std::size_t i = begin + 1; i < end; ++i) {
        const std::uint64_t key = words_[i - 1] >> index_bits;
        if (words_[i] >> index_bits != key) [[likely]]
            continue;
        const std::size_t first = i - 1;
        while (++i < end && words_[i] >> index_bits == key) {
        }
        each(first, i);
    }
}

/// Orders records with equal first keys, among sorted ones.
template <int D>
void CurveSort<D>::refine_ties(std::size_t begin, std::size_t end, const Slice<D> &slice,
                               const Pacer &pacer) {
    each_tie(begin, end, [&](std::size_t b, std::size_t e) { refine(b, e, slice, pacer); });
}

/// Orders records with equal first keys.
template <int D>
void CurveSort<D>::refine(std::size_t begin, std::size_t end, const Slice<D> &slice,
                          const Pacer &pacer) {
    if (slice.second_bits() == 0) return zoom(begin, end, pacer);
    set_keys(begin, end, [&](const Point<D> &p) { return slice.second_key(p); });
    sort_words(begin, end, pacer);
    each_tie(begin, end, [&](std::size_t b, std::size_t e) { zoom(b, e, pacer); });
}

/// Orders records with equal codes: by the codes of their own bounding box.
template <int D> void CurveSort<D>::zoom(std::size_t begin, std::size_t end, const Pacer &pacer) {
    Box<D> box;
    for (std::size_t i = begin; i < end; ++i) box.extend(point(words_[i]));
    if (box.is_point()) return;
    const Slice<D> slice{Domain<D>(box.lower, box.upper)};
    set_keys(begin, end, [&](const Point<D> &p) { return slice.first_key(p); });
    sort_words(begin, end, pacer);
    refine_ties(begin, end, slice, pacer);
}

template class CurveSort<2>;
template class CurveSort<3>;

} // namespace abacus
