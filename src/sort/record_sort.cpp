#include "sort/record_sort.hpp"

#include "sort/shared_sort.hpp"

#include <bit>
#include <cstring>

namespace abacus {

namespace {

constexpr std::size_t host_bytes_per_spool = 8192; // a database buffers a page of each
constexpr std::size_t least_piece_bytes = 8192, most_piece_bytes = 65536;
constexpr unsigned least_fan_in = 4, most_fan_in = 64;
constexpr std::uint64_t poll_every = 4096;

} // namespace

RecordSort::RecordSort(const Host &host, std::size_t stride, std::size_t key, std::size_t memory)
    : host_(host), pacer_(host), stride_(stride), key_(key), records_(host), words_(host),
      runs_(host), pieces_(host), heap_(host) {
    memory = std::max(memory, least);
    const std::size_t bytes = stride * sizeof(std::uint64_t);
    const std::size_t piece_bytes = std::clamp(memory / 64, least_piece_bytes, most_piece_bytes);
    piece_ = std::max<std::size_t>(1, piece_bytes / bytes);
    // A quarter of the memory for merging; runs of two levels wait.
    fan_in_ = static_cast<unsigned>(std::clamp<std::size_t>(
        memory / 4 / (piece_bytes + 2 * host_bytes_per_spool), least_fan_in, most_fan_in));
    room_ = std::clamp<std::size_t>(memory / 8 * 5 / (bytes + sort_bytes_per_record), 16,
                                    most_sorted_records);
}

void RecordSort::order_few(std::size_t begin, std::size_t end, std::size_t word) {
    std::sort(words_.data() + begin, words_.data() + end, [&](std::uint64_t a, std::uint64_t b) {
        const std::uint64_t *x = record(a), *y = record(b);
        for (std::size_t i = word; i < key_; ++i)
            if (x[i] != y[i]) return x[i] < y[i];
        return (a & index_mask) < (b & index_mask);
    });
}

RecordSort::Digits RecordSort::digits(std::size_t word, const Range &range) {
    const int bits = std::bit_width(range.most - range.least);
    return {word, range.least, std::min(bits, key_bits), std::max(0, bits - key_bits)};
}

RecordSort::Range RecordSort::range(std::size_t begin, std::size_t end, std::size_t word,
                                    const Pacer &pacer) const {
    Range range;
    pacer.each_piece(end - begin, [&](std::size_t from, std::size_t to) {
        for (std::size_t i = begin + from; i < begin + to; ++i) {
            const std::uint64_t value = record(words_[i])[word];
            range.least = std::min(range.least, value);
            range.most = std::max(range.most, value);
        }
    });
    return range;
}

void RecordSort::set_words(std::uint64_t *to, std::size_t begin, std::size_t end,
                           const Digits &digits) {
    for (std::size_t i = begin; i < end; ++i)
        to[i] = digits.of(record(words_[i])) << index_bits | (words_[i] & index_mask);
}

void RecordSort::order(std::size_t begin, std::size_t end, std::size_t word, const Pacer &pacer) {
    const std::size_t n = end - begin;
    if (n <= few) return order_few(begin, end, word);
    const Range all = range(begin, end, word, pacer);
    if (all.least == all.most) {
        if (word + 1 < key_) order(begin, end, word + 1, pacer);
        return;
    }
    const Digits by = digits(word, all);
    std::uint64_t *const words = words_.data(), *const scratch = words + count_;
    pacer.each_piece(n, [&](std::size_t from, std::size_t to) {
        set_words(scratch, begin + from, begin + to, by);
    });
    radix_sort_into(words + begin, scratch + begin, n, pacer);
    order_ties(begin, end, by, pacer);
}

void RecordSort::order_ties(std::size_t begin, std::size_t end, const Digits &digits,
                            const Pacer &pacer) {
    const bool is_last = digits.shift == 0; // of this word
    if (is_last && digits.word + 1 == key_) return;
    const std::uint64_t *const words = words_.data();
    for (std::size_t i = begin + 1; i < end; ++i) {
        const std::uint64_t key = words[i - 1] >> index_bits;
        if (words[i] >> index_bits != key) continue;
        const std::size_t first = i - 1;
        while (++i < end && words[i] >> index_bits == key) {
        }
        order(first, i, is_last ? digits.word + 1 : digits.word, pacer);
    }
}

void RecordSort::order_together() {
    SharedSort shared(host_);
    Arena<Range> ranges(host_);
    ranges.resize(shared.stretches());
    for (std::size_t word = 0; word < key_; ++word) {
        shared.each_stretch(
            count_, [&](std::size_t stretch, std::size_t begin, std::size_t end, const Host &host) {
                ranges[stretch] = range(begin, end, word, Pacer(host));
            });
        Range all;
        for (const Range &range : ranges) {
            all.least = std::min(all.least, range.least);
            all.most = std::max(all.most, range.most);
        }
        if (all.least == all.most) continue;
        const Digits by = digits(word, all);
        return shared.sort(
            words_.data(), words_.data() + count_, count_, by.bits,
            [&](std::uint64_t *to, std::size_t begin, std::size_t end) {
                set_words(to, begin, end, by);
            },
            [&](std::size_t begin, std::size_t end, const Pacer &pacer) {
                order_ties(begin, end, by, pacer);
            });
    }
}

void RecordSort::sort_buffer() {
    words_.resize(2 * count_);
    for (std::size_t i = 0; i < count_; ++i) words_[i] = i;
    if (SharedSort::is_worth_while(host_, count_))
        order_together();
    else
        order(0, count_, 0, pacer_);
    at_ = 0;
}

/// Makes a run from the buffer.
void RecordSort::spill() {
    sort_buffer();
    Run run{Spool(), 0, 0, 0};
    pieces_.resize(piece_ * stride_);
    std::size_t waiting = 0;
    for (std::size_t i = 0; i < count_; ++i) {
        std::memcpy(pieces_.data() + waiting++ * stride_, record(words_[i]),
                    stride_ * sizeof(std::uint64_t));
        if (waiting < piece_ && i + 1 < count_) continue;
        run.spool.write(host_, pieces_.data(), waiting, stride_);
        waiting = 0;
        host_.poll();
    }
    count_ = 0;
    runs_.push_back(run);
    merge_level(0);
}

/// Merges the last runs into one, if there are enough of this level.
void RecordSort::merge_level(unsigned level) {
    std::size_t first = runs_.size();
    while (first > 0 && runs_[first - 1].level == level) --first;
    if (runs_.size() - first < fan_in_) return;
    double merging = 0; // records, which exist twice until all are merged
    for (std::size_t i = first; i < runs_.size(); ++i)
        merging += static_cast<double>(runs_[i].spool.size());
    host_.spool_expect(merging * record_bytes());
    open(first);
    Run merged{Spool(), level + 1, 0, 0};
    Arena<std::uint64_t> output(host_);
    output.resize(piece_ * stride_);
    std::size_t waiting = 0;
    const auto write = [&] {
        if (waiting > 0) merged.spool.write(host_, output.data(), waiting, stride_);
        waiting = 0;
    };
    while (const std::uint64_t *record = pop()) {
        std::memcpy(output.data() + waiting++ * stride_, record, stride_ * sizeof *record);
        if (waiting == piece_) write();
    }
    write();
    for (std::size_t i = first; i < runs_.size(); ++i) runs_[i].spool.close(host_);
    runs_.resize(first);
    runs_.push_back(merged);
    merge_level(level + 1);
}

void RecordSort::finish() {
    if (in_memory()) {
        sort_buffer();
        return;
    }
    if (count_ > 0) spill();
    records_.reset();
    words_.reset();
    open(0);
}

const std::uint64_t *RecordSort::next() {
    if (!in_memory()) return pop();
    if (at_ == count_) return nullptr;
    if (at_ % poll_every == 0) host_.poll();
    return record(words_[at_++]);
}

void RecordSort::rewind() {
    if (in_memory())
        at_ = 0;
    else
        open(0);
}

void RecordSort::close() {
    for (Run &run : runs_) run.spool.close(host_);
    runs_.reset();
    pieces_.reset();
    heap_.reset();
    records_.reset();
    words_.reset();
    count_ = at_ = 0;
}

void RecordSort::open(std::size_t first) {
    first_ = first;
    advance_ = false;
    heap_.clear();
    pieces_.resize((runs_.size() - first) * piece_ * stride_);
    for (std::size_t i = first; i < runs_.size(); ++i) {
        runs_[i].spool.rewind(host_);
        if (fill(runs_[i], i - first)) heap_.push_back(head_of(i));
    }
    for (std::size_t i = heap_.size(); i-- > 0;) sift(i);
}

/// Reads the next piece of a run; false at its end.
bool RecordSort::fill(Run &run, std::size_t place) {
    host_.poll();
    run.at = 0;
    run.end = run.spool.read(host_, pieces_.data() + place * piece_ * stride_, piece_, stride_);
    return run.end > 0;
}

void RecordSort::sift(std::size_t at) {
    const Head sunk = heap_[at];
    for (std::size_t child; (child = 2 * at + 1) < heap_.size(); at = child) {
        if (child + 1 < heap_.size() && before(heap_[child + 1], heap_[child])) ++child;
        if (!before(heap_[child], sunk)) break;
        heap_[at] = heap_[child];
    }
    heap_[at] = sunk;
}

const std::uint64_t *RecordSort::pop() {
    if (advance_) {
        const std::size_t at = heap_[0].run;
        Run &run = runs_[at];
        if (++run.at < run.end || fill(run, at - first_)) {
            heap_[0] = head_of(at);
        } else {
            heap_[0] = heap_.back();
            heap_.pop_back();
        }
        if (!heap_.empty()) sift(0);
    }
    advance_ = !heap_.empty();
    return advance_ ? head(heap_[0].run) : nullptr;
}

} // namespace abacus
