#include "sort/record_sort.hpp"

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
    // A quarter for merging; runs of two levels wait.
    fan_in_ = static_cast<unsigned>(std::clamp<std::size_t>(
        memory / 4 / (piece_bytes + 2 * host_bytes_per_spool), least_fan_in, most_fan_in));
    room_ = std::clamp<std::size_t>(memory / 8 * 5 / (bytes + sort_bytes_per_record), 16,
                                    most_sorted_records);
}

void RecordSort::order(std::size_t begin, std::size_t end, std::size_t word) {
    std::uint64_t *const words = words_.data();
    const std::size_t n = end - begin;
    if (n <= few) {
        std::sort(words + begin, words + end, [&](std::uint64_t a, std::uint64_t b) {
            const std::uint64_t *x = record(a), *y = record(b);
            for (std::size_t i = word; i < key_; ++i)
                if (x[i] != y[i]) return x[i] < y[i];
            return (a & index_mask) < (b & index_mask);
        });
        return;
    }
    std::uint64_t least = ~0ull, most = 0;
    pacer_.each_piece(n, [&](std::size_t from, std::size_t to) {
        for (std::size_t i = begin + from; i < begin + to; ++i) {
            const std::uint64_t value = record(words[i])[word];
            least = std::min(least, value);
            most = std::max(most, value);
        }
    });
    if (least == most) {
        if (word + 1 < key_) order(begin, end, word + 1);
        return;
    }
    const int shift = std::max(0, static_cast<int>(std::bit_width(most - least)) - key_bits);
    pacer_.each_piece(n, [&](std::size_t from, std::size_t to) {
        for (std::size_t i = begin + from; i < begin + to; ++i)
            words[i] =
                ((record(words[i])[word] - least) >> shift) << index_bits | (words[i] & index_mask);
    });
    std::uint64_t *const scratch = words + count_ + begin;
    const std::uint64_t *sorted = radix_sort(words + begin, scratch, n, pacer_);
    if (sorted != words + begin) std::memcpy(words + begin, sorted, n * sizeof *words);
    if (shift == 0 && word + 1 == key_) return;
    for (std::size_t i = begin + 1; i < end; ++i) {
        const std::uint64_t key = words[i - 1] >> index_bits;
        if (words[i] >> index_bits != key) continue;
        const std::size_t first = i - 1;
        while (++i < end && words[i] >> index_bits == key) {
        }
        order(first, i, shift == 0 ? word + 1 : word);
    }
}

void RecordSort::sort_buffer() {
    words_.resize(2 * count_);
    for (std::size_t i = 0; i < count_; ++i) words_[i] = i;
    order(0, count_, 0);
    at_ = 0;
}

/// Makes a run of the buffer.
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

/// Makes one run of the last ones, if there are enough of this level.
void RecordSort::merge_level(unsigned level) {
    std::size_t first = runs_.size();
    while (first > 0 && runs_[first - 1].level == level) --first;
    if (runs_.size() - first < fan_in_) return;
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
        if (fill(runs_[i], i - first)) heap_.push_back(i);
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
    for (;;) {
        std::size_t least = at;
        for (std::size_t child = 2 * at + 1; child <= 2 * at + 2 && child < heap_.size(); ++child)
            if (before(child, least)) least = child;
        if (least == at) return;
        std::swap(heap_[at], heap_[least]);
        at = least;
    }
}

const std::uint64_t *RecordSort::pop() {
    if (advance_) {
        Run &run = runs_[heap_[0]];
        if (++run.at == run.end && !fill(run, heap_[0] - first_)) {
            heap_[0] = heap_.back();
            heap_.pop_back();
        }
        if (!heap_.empty()) sift(0);
    }
    advance_ = !heap_.empty();
    return advance_ ? head(heap_[0]) : nullptr;
}

} // namespace abacus
