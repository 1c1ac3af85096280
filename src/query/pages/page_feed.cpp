#include "query/pages/page_feed.hpp"

#include <algorithm>
#include <chrono>
#include <cstring>

namespace abacus {

namespace {
/// A thread without work checks this often whether it has to end.
constexpr std::chrono::milliseconds longest_wait{20};
} // namespace

PageFeed::PageFeed(const Memory &memory, std::size_t batches, std::size_t pages)
    : pages_(pages), batches_(memory), queue_(memory) {
    batches_.resize(batches);
    for (Batch &batch : batches_) batch.is_free = true;
    queue_.reserve(batches);
}

PageFeed::Batch *PageFeed::free_batch() {
    const auto found = std::find_if(batches_.begin(), batches_.end(),
                                    [](const Batch &batch) { return batch.is_free; });
    return found == batches_.end() ? nullptr : found;
}

bool PageFeed::has_to_read() const {
    const std::lock_guard guard(lock_);
    return !has_ended_ && std::any_of(batches_.begin(), batches_.end(),
                                      [](const Batch &batch) { return batch.is_free; });
}

void PageFeed::fetch(const Host &host, const Key *key) {
    host.poll();
    abacus_page page{};
    has_page_ = host.next(ABACUS_SIMPLEX_PAGES, key, page);
    if (!has_page_) return;
    page_.key = page.key;
    page_.size = page.size;
    std::memcpy(page_.bytes, page.bytes, std::min(page.size, sizeof page_.bytes));
}

void PageFeed::read(const Host &host) {
    Batch *batch;
    {
        const std::lock_guard guard(lock_);
        batch = free_batch();
    }
    if (!has_begun_) fetch(host, nullptr);
    has_begun_ = true;
    for (batch->size = 0; batch->size < pages_ && has_page_; ++batch->size) {
        Page &page = batch->pages[batch->size];
        page.key = page_.key;
        page.size = page_.size;
        std::memcpy(page.bytes, page_.bytes, std::min(page_.size, sizeof page_.bytes));
        fetch(host, &page.key);
    }
    batch->beyond = has_page_ ? page_.key : end_key;
    if (batch->size > 0) keep_border(batch->pages[0].key);
    const std::lock_guard guard(lock_);
    has_ended_ = !has_page_;
    if (batch->size > 0) {
        batch->is_free = false;
        queue_.push_back(batch);
    }
    has_ended_ ? filled_.notify_all() : filled_.notify_one();
}

PageFeed::Batch *PageFeed::take(const Host &host) {
    std::unique_lock guard(lock_);
    while (queue_.empty() && !has_ended_) {
        filled_.wait_for(guard, longest_wait);
        guard.unlock();
        host.poll();
        guard.lock();
    }
    if (queue_.empty()) return nullptr;
    Batch *const batch = queue_[0];
    std::move(queue_.begin() + 1, queue_.end(), queue_.begin());
    queue_.pop_back();
    return batch;
}

void PageFeed::give_back(Batch &batch) {
    const std::lock_guard guard(lock_);
    batch.is_free = true;
}

void PageFeed::end() {
    has_ended_ = true;
    batches_.reset();
    queue_.reset();
}

void PageFeed::keep_border(const Key &key) {
    if (read_++ % each_kept_ != 0) return;
    if (borders_kept_ == borders_.size()) {
        for (std::size_t i = 0; 2 * i < borders_kept_; ++i) borders_[i] = borders_[2 * i];
        borders_kept_ /= 2;
        each_kept_ *= 2;
        if ((read_ - 1) % each_kept_ != 0) return;
    }
    borders_[borders_kept_++] = key;
}

} // namespace abacus
