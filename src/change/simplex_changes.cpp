#include "change/simplex_changes.hpp"

#include <chrono>
#include <utility>

namespace abacus {

namespace {

/// Shares of the memory: of the log, and of the logs of all threads. The sort has the rest.
constexpr std::size_t log_share = 4, threads_share = 4;
/// For tests.
constexpr std::size_t tiny_log = 1;
/// A waiting thread checks this often whether it has to end.
constexpr std::chrono::milliseconds longest_wait{20};

} // namespace

/// Besides the threads' logs there may be one in the box, and one that is being sorted.
template <int D>
SimplexChanges<D>::SimplexChanges(const Host &host, const abacus_facts &, std::size_t memory,
                                  unsigned threads, bool has_tiny_logs)
    : host_(host), thread_bytes_(has_tiny_logs ? tiny_log : memory / threads_share / (threads + 2)),
      log_(host, has_tiny_logs ? tiny_log : memory / log_share, *this),
      sort_(host, SimplexWords<D>::words, SimplexWords<D>::key,
            memory - memory / log_share - memory / threads_share) {}

template <int D> void SimplexChanges<D>::sort(const Entries &entries) {
    for (std::size_t i = 0; i < entries.size(); ++i) {
        if (i % 1024 == 0) host_.poll();
        std::memcpy(sort_.add(), &entries[i], sizeof entries[i]);
    }
}

template <int D> void SimplexChanges<D>::hand_over(Log &log, const Host &host) {
    std::unique_lock guard(lock_);
    while (handed_) {
        is_free_.wait_for(guard, longest_wait);
        guard.unlock();
        host.poll();
        guard.lock();
    }
    handed_.emplace(log.take());
    guard.unlock();
    crew_->ring();
}

template <int D> void SimplexChanges<D>::take_handed() {
    std::optional<Entries> taken;
    {
        const std::lock_guard guard(lock_);
        if (!handed_) return;
        taken.emplace(std::move(*handed_));
        handed_.reset();
    }
    is_free_.notify_one();
    sort(*taken);
}

template class SimplexChanges<2>;
template class SimplexChanges<3>;

} // namespace abacus
