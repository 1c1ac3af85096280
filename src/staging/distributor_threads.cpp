#include "staging/distributor_threads.hpp"

#include <algorithm>
#include <chrono>
#include <utility>

namespace abacus {

namespace {
/// The session's thread looks for interrupts so often while it waits.
constexpr std::chrono::milliseconds longest_wait{20};
} // namespace

template <int D>
DistributorThreads<D>::DistributorThreads(const Host &host, Distributor<D> &distributor,
                                          std::size_t stride, std::size_t piece)
    : host_(host), distributor_(distributor), stride_(stride), room_(block_pieces * piece),
      threads_(std::min(host.threads(), most_threads)), memory_(host), part_memory_(host),
      blocks_(host), empty_(host), crew_(host) {
    const std::size_t blocks = blocks_for(threads_);
    memory_.resize((blocks * room_ + pieces * piece) * stride);
    part_memory_.resize(blocks * room_);
    std::uint64_t *at = memory_.data();
    for (std::size_t i = 0; i < blocks; ++i, at += room_ * stride)
        blocks_.push_back({at, part_memory_.data() + i * room_, 0});
    empty_.reserve(pieces);
    for (std::size_t i = 0; i < pieces; ++i, at += piece * stride) empty_.push_back(at);
}

// ---- The session's thread ---------------------------------------------------------------

template <int D> template <class IsReady> void DistributorThreads<D>::wait(IsReady is_ready) {
    for (bool ready = false, failed = false; !ready; empty_outbox()) {
        {
            std::unique_lock guard(lock_);
            for_session_.wait_for(guard, longest_wait,
                                  [&] { return is_ready() || written_ < sent_ || gives_up_; });
            ready = is_ready();
            failed = gives_up_;
        }
        host_.poll();
        if (failed) crew_.finish(); // throws what a thread has thrown
    }
}

template <int D> std::uint64_t *DistributorThreads<D>::room(std::size_t n) {
    if (filled_ + n > room_) bring();
    if (filled_ == 0) wait([&] { return brought_ - dealt_ < blocks_.size(); });
    return blocks_[brought_ % blocks_.size()].records + filled_ * stride_;
}

template <int D> void DistributorThreads<D>::bring() {
    blocks_[brought_ % blocks_.size()].n = std::exchange(filled_, 0);
    const std::lock_guard guard(lock_);
    ++brought_;
    for_blocks_.notify_one();
}

template <int D> void DistributorThreads<D>::finish() {
    if (filled_ > 0) bring();
    {
        const std::lock_guard guard(lock_);
        is_over_ = true;
        for_blocks_.notify_all();
    }
    wait([&] { return dealt_ == brought_; });
    crew_.finish();
}

template <int D> void DistributorThreads<D>::empty_outbox() {
    const auto next = [&]() -> const FullPiece * {
        const std::lock_guard guard(lock_);
        return written_ < sent_ ? &outbox_[written_ % pieces] : nullptr;
    };
    while (const FullPiece *full = next()) {
        distributor_.write(full->part, full->records);
        const std::lock_guard guard(lock_);
        empty_.push_back(full->records);
        ++written_;
        for_pieces_.notify_one();
    }
}

// ---- The other threads ------------------------------------------------------------------

template <int D> void DistributorThreads<D>::piece(std::size_t, const Host &) {
    for (std::uint64_t number; take(number);) {
        const Block &block = blocks_[number % blocks_.size()];
        for (std::size_t i = 0; i < block.n; ++i)
            block.parts[i] = distributor_.part_of(block.records + i * stride_);
        if (!wait_for_turn(number) || !deal_out(block)) return;
        count_dealt();
    }
}

template <int D> bool DistributorThreads<D>::take(std::uint64_t &number) {
    std::unique_lock guard(lock_);
    for_blocks_.wait(guard, [&] { return gives_up_ || is_over_ || taken_ < brought_; });
    if (gives_up_ || taken_ == brought_) return false;
    number = taken_++;
    return true;
}

template <int D> bool DistributorThreads<D>::wait_for_turn(std::uint64_t number) {
    std::unique_lock guard(lock_);
    for_turns_.wait(guard, [&] { return gives_up_ || dealt_ == number; });
    return !gives_up_;
}

template <int D> bool DistributorThreads<D>::deal_out(const Block &block) {
    for (std::size_t i = 0; i < block.n; ++i)
        if (distributor_.put(block.parts[i], block.records + i * stride_) && !send(block.parts[i]))
            return false;
    return true;
}

template <int D> bool DistributorThreads<D>::send(unsigned part) {
    std::unique_lock guard(lock_);
    for_pieces_.wait(guard, [&] { return gives_up_ || empty_.size() > 0; });
    if (gives_up_) return false;
    std::uint64_t *const empty = empty_.back();
    empty_.pop_back();
    outbox_[sent_++ % pieces] = {part, distributor_.exchange(part, empty)};
    for_session_.notify_one();
    return true;
}

template <int D> void DistributorThreads<D>::count_dealt() {
    const std::lock_guard guard(lock_);
    ++dealt_;
    for_turns_.notify_all();
    for_session_.notify_one();
}

template <int D> void DistributorThreads<D>::give_up() noexcept {
    const std::lock_guard guard(lock_);
    gives_up_ = true;
    for_blocks_.notify_all();
    for_turns_.notify_all();
    for_pieces_.notify_all();
}

template class DistributorThreads<2>;
template class DistributorThreads<3>;

} // namespace abacus
