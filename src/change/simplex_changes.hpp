// The simplices that a change of a mesh has created and removed, in total.
//
// The session's thread and each other one have a log in memory (simplex_log.hpp). The entries of a
// full log are sorted by what distinguishes simplices, within memory and beyond it in spools. Then
// all entries of one simplex come together, and their sum shows whether it is new, or gone, or
// neither.
//
// Only the session's thread may use spools. So another thread puts the contents of its log into a
// box, which all threads share, and goes on with an empty log; it waits while the box is full. The
// session's thread empties the box between requests for pages. The contents of the box are in
// memory of the threads, which drop_handed() returns before that memory goes away.
#pragma once

#include "delaunay/simplex_log.hpp"
#include "host/crew.hpp"
#include "sort/record_sort.hpp"

#include <abacus/facts.h>

#include <condition_variable>
#include <mutex>
#include <optional>

namespace abacus {

template <int D> class SimplexChanges final : private SimplexLog<D>::Overflow {
public:
    using Log = SimplexLog<D>;
    using Entries = Arena<SimplexWords<D>>;

    /// `host` computes with one thread: the sort may run in the middle of others' work.
    SimplexChanges(const Host &host, const abacus_facts &, std::size_t memory, unsigned threads,
                   bool has_tiny_logs);

    /// The log of the session's thread.
    Log &log() { return log_; }

    /// A log of another thread, which uses the memory of `host`.
    class ThreadLog final : private Log::Overflow {
    public:
        ThreadLog(SimplexChanges &changes, const Host &host)
            : changes_(changes), host_(host), log_(host, changes.thread_bytes_, *this) {}

        Log &log() { return log_; }
        /// No more entries come.
        void finish() { take(log_); }

    private:
        void take(Log &log) override {
            if (!log.empty()) changes_.hand_over(log, host_);
        }

        SimplexChanges &changes_;
        const Host &host_;
        Log log_;
    };

    /// From now on threads of this crew have logs.
    void work_with(Crew &crew) { crew_ = &crew; }
    /// For the session's thread: takes what a thread has handed over.
    void take_handed();
    /// When no thread is at work: returns the memory of what has not been taken.
    void drop_handed() noexcept { handed_.reset(); }

    /// Calls visit(simplex) for each simplex created or removed, in their order; its change is 1 or
    /// -1. Then forgets all of them.
    template <class Visit> void each(Visit visit) {
        take(log_);
        sort_.finish();
        std::optional<SimplexWords<D>> sum;
        const auto pass_on = [&] {
            if (sum && sum->change != 0) visit(*sum);
        };
        while (const std::uint64_t *record = sort_.next()) {
            SimplexWords<D> next;
            std::memcpy(&next, record, sizeof next);
            if (sum && sum->is_same_as(next)) {
                sum->change += next.change;
                continue;
            }
            pass_on();
            sum = next;
        }
        pass_on();
        sort_.close();
    }

private:
    void take(Log &log) override {
        sort(log.entries());
        log.clear();
    }
    void sort(const Entries &entries);
    /// For a thread.
    void hand_over(Log &log, const Host &host);

    const Host &host_;
    const std::size_t thread_bytes_; // of a log
    Log log_;
    RecordSort sort_;
    Crew *crew_ = nullptr;

    std::mutex lock_; // of what follows
    std::condition_variable is_free_;
    std::optional<Entries> handed_; // the box
};

extern template class SimplexChanges<2>;
extern template class SimplexChanges<3>;

} // namespace abacus
