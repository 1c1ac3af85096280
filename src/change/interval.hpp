// The work of one thread: along an interval of the curve it inserts points, removes points, or
// fixes the edges of segments, with a cache of its own.
//
// The interval begins and ends where pages do, and the thread loads no page of another one. So it
// shares nothing with others, takes no lock, and pays nothing where it finds a simplex in its
// cache. Where a search would leave the interval, the point is put off.
//
// Why that is right:
//
//   Inside. The search for a cavity or a star has not left the interval. So its simplices and those
//   beyond its rim belong to the interval. The key of a simplex is the greatest code of its
//   vertices.
//      Insertion: a new simplex has vertices of one that it replaces, and the point. Its key is at
//      least the point's code, and no greater than the key of the other simplex or that code. So it
//      belongs to the interval, too.
//      Removal: a simplex in the hole has vertices of the star, so its key is no greater than
//      theirs. But it lacks the vertex that made them belong to the interval. If more than D of the
//      vertex's neighbours lie before the interval, a simplex might join these alone. Then the
//      vertex is put off, too.
//      Fixing: the same holds for the vertices of the triangles that a segment crosses, on either
//      side of it.
//
//   Outside. A simplex with a neighbour in another interval is never replaced, since the search
//   would have visited that neighbour. So the key by which a page of another interval refers to it
//   stays valid, and so does the key by which it refers to its neighbour.
//
//   All together. The result is that of inserting or removing the points of all intervals one after
//   the other, in any order: no change reads what a change in another interval writes. The
//   triangulation is unique, so its simplices do not depend on the intervals. A segment may be
//   fixed in part before it is put off: its edges are those of the whole one.
//
//   The last simplices. A removal may leave points that span no simplex. Then the star has all
//   finite simplices, and all belong to the interval. Finite simplices are connected, so if another
//   interval had had one, one of these would have had a neighbour in another interval, and would
//   still be there. So the interval has had all from the beginning, and has counted them correctly.
//   It leaves that vertex to the session's thread.
//
// If one of several equal points is put off, so are those after it: the first of them in order is
// the vertex. Equal points leave together. Where there are repeated points, whose pages belong to
// the session's thread, they are left to that thread.
#pragma once

#include "change/outlay.hpp"
#include "change/simplex_changes.hpp"
#include "delaunay/insertion.hpp"
#include "delaunay/removal.hpp"

#include <abacus/facts.h>
#include <abacus/mesh_counters.h>

#include <atomic>

namespace abacus {

/// Records with their codes. They are in runs, each along the curve.
class Batch {
public:
    Batch(const Memory &memory, std::size_t stride)
        : stride_(stride), records_(memory), codes_(memory), later_runs_(memory), marks_(memory) {}

    void swap(Batch &other) noexcept {
        std::swap(stride_, other.stride_);
        records_.swap(other.records_);
        codes_.swap(other.codes_);
        later_runs_.swap(other.later_runs_);
        marks_.swap(other.marks_);
    }
    /// Starts afresh with records of this many words.
    void begin(std::size_t stride) {
        shorten(0);
        stride_ = stride;
    }
    std::size_t stride() const { return stride_; }
    void add(const std::uint64_t *record, std::uint64_t code) { add(record, stride_, &code, 1); }
    /// n records of `words` words each; words that are missing will not be read.
    void add(const std::uint64_t *records, std::size_t words, const std::uint64_t *codes,
             std::size_t n) {
        std::uint64_t *to = records_.extend(n * stride_);
        if (words == stride_)
            std::copy_n(records, n * stride_, to);
        else
            for (std::size_t i = 0; i < n; ++i, records += words, to += stride_)
                std::copy_n(records, std::min(words, stride_), to);
        std::copy_n(codes, n, codes_.extend(n));
    }
    /// The next record is the first of another run.
    void begin_run() { later_runs_.push_back(size()); }
    std::size_t runs() const { return later_runs_.size() + 1; }
    std::size_t run_begin(std::size_t run) const { return run == 0 ? 0 : later_runs_[run - 1]; }
    std::size_t run_end(std::size_t run) const {
        return run < later_runs_.size() ? later_runs_[run] : size();
    }
    std::size_t run_size(std::size_t run) const { return run_end(run) - run_begin(run); }
    /// The first of a run with this code or one behind it; the run's end if there is none.
    std::size_t first_from(std::uint64_t code, std::size_t run) const {
        return static_cast<std::size_t>(
            std::lower_bound(codes() + run_begin(run), codes() + run_end(run), code) - codes());
    }
    void reserve(std::size_t points) {
        records_.reserve(points * stride_);
        codes_.reserve(points);
    }
    std::size_t size() const { return codes_.size(); }
    /// The bytes for this many points.
    std::size_t bytes(std::size_t points) const {
        return points * (stride_ + 1) * sizeof(std::uint64_t);
    }
    const std::uint64_t *record(std::size_t i) const { return records_.data() + i * stride_; }
    std::uint64_t code(std::size_t i) const { return codes_[i]; }
    const std::uint64_t *codes() const { return codes_.begin(); }
    /// Moves the i-th to the place of the n-th, which comes before it or is the same.
    void move(std::size_t i, std::size_t n) {
        if (i == n) return;
        std::copy_n(record(i), stride_, records_.data() + n * stride_);
        codes_[n] = codes_[i];
    }
    void shorten(std::size_t size) {
        records_.resize(size * stride_);
        codes_.resize(size);
        marks_.clear();
        if (size == 0) later_runs_.clear();
    }
    /// Keeps only those with these numbers, which ascend.
    void keep(const Arena<std::size_t> &numbers) {
        Keeping keeping{*this};
        for (const std::size_t i : numbers) keeping.keep(i);
    }
    void drop_done() {
        if (marks_.empty()) return;
        Keeping keeping{*this};
        for (std::size_t i = 0; i < size(); ++i)
            if (!is_done(i)) keeping.keep(i);
    }

    /// Marks of records that are done: a bit for each, in words of 32 records, which are not set
    /// yet.
    std::uint32_t *make_marks() {
        marks_.resize((size() + marked_together - 1) / marked_together);
        return marks_.data();
    }
    static constexpr std::size_t marked_together = 32;
    bool is_done(std::size_t i) const {
        return !marks_.empty() && (marks_[i / marked_together] >> i % marked_together & 1) != 0;
    }

private:
    /// Moves records that are kept, one after the other; the others are gone with it.
    struct Keeping {
        explicit Keeping(Batch &batch) : batch_(batch) {}
        Keeping(const Keeping &) = delete;
        Keeping &operator=(const Keeping &) = delete;
        ~Keeping() {
            begin_runs(batch_.size());
            batch_.shorten(kept_);
        }
        void keep(std::size_t i) {
            begin_runs(i);
            batch_.move(i, kept_++);
        }

    private:
        void begin_runs(std::size_t i) {
            for (; run_ < batch_.later_runs_.size() && batch_.later_runs_[run_] <= i; ++run_)
                batch_.later_runs_[run_] = kept_;
        }

        Batch &batch_;
        std::size_t kept_ = 0, run_ = 0;
    };

    std::size_t stride_;
    Arena<std::uint64_t> records_, codes_;
    Arena<std::size_t> later_runs_; // where they begin, except the first
    Arena<std::uint32_t> marks_;    // none if no record is done
};

/// What is done with the records of a batch. A segment to be fixed is a record as in
/// constrain/segments.hpp.
enum class Deed { insert, remove, fix };

template <int D> class Interval {
public:
    /// What became of the points, by their numbers in the batch.
    struct Results {
        explicit Results(const Memory &memory) : left(memory), put_off(memory), gone(memory) {}

        /// In order: inserted points at vertices, or leaving ones at repeated points; and points
        /// whose search would have left the interval.
        Arena<std::size_t> left, put_off;
        /// One point for each place whose vertex is gone, if attributes are apart.
        Arena<std::size_t> gone;
        std::int64_t simplices = 0, ghosts = 0, vertices = 0; // more than before
        std::uint64_t crowded = 0;                            // came where the domain does not fit
        abacus_counters counters{};
    };
    /// How points are removed.
    struct Removing {
        bool exactly;           // see Leaving
        std::size_t want_bytes; // for the points of a place
        SharedOutlay<D> &outlay;
    };

    /// `facts` are those of the whole mesh; pages begin at the codes `first` and `last + 1`.
    /// `changes`: who wants to know which simplices come and go, or null.
    Interval(const Host &host, const abacus_facts &facts, std::uint64_t first, std::uint64_t last,
             std::size_t cache_bytes, SimplexChanges<D> *changes);

    /// Inserts points [from, to) of the batch, which are of one run. Adds to `done` as it goes.
    void insert(const Batch &batch, std::size_t from, std::size_t to, bool counts_crowded,
                std::atomic<std::uint64_t> &done, Results &results);
    /// The same, but removes points. Puts off those that remain when a new mesh of the rest is
    /// cheaper.
    void remove(const Batch &batch, std::size_t from, std::size_t to, const Removing &how,
                std::atomic<std::uint64_t> &done, Results &results);
    /// The same, but fixes the edges of segments. A segment that crosses a fixed edge is put off,
    /// too: the session's thread reports it.
    void fix(const Batch &batch, std::size_t from, std::size_t to, std::atomic<std::uint64_t> &done,
             Results &results);
    /// Writes all pages.
    void finish(Results &results);

private:
    AttributePages<D> *attributes_apart();
    /// Calls change(i), from i = from on; it returns the next i, until that is `to`.
    template <class Change>
    void each(std::size_t from, std::size_t to, std::atomic<std::uint64_t> &done, Change change);

    const Host &host_;
    const abacus_facts &facts_; // of the whole mesh, before
    Cache<D> cache_;
    Delaunay<D> mesh_;
    Insertion<D> insertion_;
    std::optional<AttributePages<D>> apart_; // read only
    Removal<D> removal_;
    std::optional<typename SimplexChanges<D>::ThreadLog> log_;
};

extern template class Interval<2>;
extern template class Interval<3>;

} // namespace abacus
