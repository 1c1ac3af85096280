// An external merge sort of records of words, read back as a stream.
//
// The external sort of staging finds its order while sorting: it distributes points
// along the curve and refines points that share a code by their own box. Here the order
// is known: the words at the head of the records. The result must be a stream that can
// be joined with others and read again. So there are sorted runs, which are merged when
// they are read. Runs are sorted by the same radix sort, on words that hold 33 bits of a
// key above a number; what these bits do not tell apart is refined with the next ones.
//
// Many records of a run are sorted by several threads.
//
// A sort takes no more than its share of memory. Runs go to spools. As many runs of one
// level as can be merged at once become one of the next level.
#pragma once

#include "host/arena.hpp"
#include "sort/radix_sort.hpp"
#include "sort/spool.hpp"

namespace abacus {

class RecordSort {
public:
    /// Least share of memory, bytes.
    static constexpr std::size_t least = std::size_t{192} << 10;

    /// Records of `stride` words, ordered by their first `key` words as unsigned numbers.
    RecordSort(const Host &host, std::size_t stride, std::size_t key, std::size_t memory);

    /// Room for one more record, to be filled before the next call.
    std::uint64_t *add() {
        if (count_ == room_) spill();
        ++size_;
        return grow() + count_++ * stride_;
    }
    std::uint64_t size() const { return size_; }
    /// That so many records take in spools: none if memory has room for them.
    double spool_bytes(double records) const {
        return records > static_cast<double>(room_) ? records * record_bytes() : 0;
    }
    /// At least so many records will be added in all: throws if spools have no room for them.
    void expect(double records) const {
        if (in_memory()) host_.spool_expect(spool_bytes(records));
    }

    /// Ends adding; next() then gives the records in order.
    void finish();
    /// The next record, valid until the next call; null after the last.
    const std::uint64_t *next();
    /// To the first record again.
    void rewind();
    /// Gives memory and spools back.
    void close();

private:
    struct Run {
        Spool spool;
        unsigned level;
        std::size_t at, end; // of the records of its piece in memory
    };

    bool in_memory() const { return runs_.empty(); }
    double record_bytes() const { return static_cast<double>(stride_ * sizeof(std::uint64_t)); }
    std::uint64_t *grow() {
        if ((count_ + 1) * stride_ > records_.size()) [[unlikely]]
            records_.resize(std::min(room_, std::max<std::size_t>(2 * count_, 64)) * stride_);
        return records_.data();
    }
    bool less(const std::uint64_t *a, const std::uint64_t *b) const {
        for (std::size_t i = 0; i < key_; ++i)
            if (a[i] != b[i]) return a[i] < b[i];
        return false;
    }
    const std::uint64_t *record(std::uint64_t word) const {
        return records_.data() + (word & index_mask) * stride_;
    }

    struct Range {
        std::uint64_t least = ~std::uint64_t{0}, most = 0;
    };
    /// A piece of a word of the key: less the least one, without the last bits.
    struct Digits {
        std::size_t word;
        std::uint64_t least;
        int bits, shift;

        std::uint64_t of(const std::uint64_t *record) const {
            return (record[word] - least) >> shift;
        }
    };
    /// Orders words_[begin, end), equal in the key words before `word`.
    void order(std::size_t begin, std::size_t end, std::size_t word, const Pacer &pacer);
    void order_few(std::size_t begin, std::size_t end, std::size_t word);
    /// Orders all, by several threads.
    void order_together();
    static Digits digits(std::size_t word, const Range &range);
    /// Of a word of the records of words_[begin, end).
    Range range(std::size_t begin, std::size_t end, std::size_t word, const Pacer &pacer) const;
    void set_words(std::uint64_t *to, std::size_t begin, std::size_t end, const Digits &digits);
    /// Orders what digits do not tell apart, of sorted words.
    void order_ties(std::size_t begin, std::size_t end, const Digits &digits, const Pacer &pacer);
    void sort_buffer();
    void spill();
    void merge_level(unsigned level);

    // Reading runs from `first` on, merged.
    void open(std::size_t first);
    bool fill(Run &run, std::size_t place);
    const std::uint64_t *head(std::size_t run) const {
        return pieces_.data() + ((run - first_) * piece_ + runs_[run].at) * stride_;
    }
    /// A run that has records left, and the first word of the next one: that decides mostly.
    struct Head {
        std::uint64_t word;
        std::size_t run;
    };
    Head head_of(std::size_t run) const { return {*head(run), run}; }
    bool before(const Head &a, const Head &b) const {
        return a.word != b.word ? a.word < b.word : less(head(a.run), head(b.run));
    }
    void sift(std::size_t at);
    const std::uint64_t *pop();

    const Host &host_;
    Pacer pacer_;
    const std::size_t stride_, key_;
    std::size_t room_, piece_; // records in the buffer; read or written at once
    unsigned fan_in_;
    std::uint64_t size_ = 0;

    Arena<std::uint64_t> records_; // the buffer
    std::size_t count_ = 0;
    Arena<std::uint64_t> words_; // its order, and as much again for sorting
    std::size_t at_ = 0;         // next of it, when all is in the buffer

    Arena<Run> runs_;
    Arena<std::uint64_t> pieces_;
    Arena<Head> heap_; // the least first
    std::size_t first_ = 0;
    bool advance_ = false; // the head was handed out
};

} // namespace abacus
