// The pages of a mesh in key order, read by the session's thread and given to idle threads a few at
// a time.
//
// How many pages there are and where their keys lie is known only once they have been read. So no
// part of the curve is assigned to a thread. The beginnings of batches are kept, thinned out if
// there are many. So the curve can afterwards be cut into parts of equally many pages.
#pragma once

#include "host/arena.hpp"
#include "keys/key.hpp"

#include <abacus/facts.h>

#include <array>
#include <condition_variable>
#include <mutex>

namespace abacus {

class PageFeed {
public:
    struct Page {
        Key key;
        std::size_t size;
        alignas(8) unsigned char bytes[ABACUS_PAGE_BYTES];
    };
    /// Consecutive pages.
    struct Batch {
        static constexpr std::size_t most = 8;
        bool is_free;
        std::size_t size;
        Key beyond; // of the page behind them; end_key if there is none
        Page pages[most];
    };

    /// Created by the session's thread: this many batches, of this many pages each, are in memory
    /// at once.
    PageFeed(const Memory &memory, std::size_t batches, std::size_t pages);

    /// For the session's thread: whether there is room for a batch, and pages to read.
    bool has_to_read() const;
    /// Reads a batch.
    void read(const Host &host);
    /// For a thread, with its host: the next batch, once there is one; nullptr after the last.
    /// The thread returns it when it is no longer needed.
    Batch *take(const Host &host);
    void give_back(Batch &batch);

    /// Between two runs: frees the memory of batches.
    void end();

    /// Once all pages have been read: where the i-th of n parts with about equally many pages
    /// begins; part 0 begins with the curve, and n gives its end.
    Key border(std::size_t i, std::size_t n) const {
        return i == 0 ? first_key : i == n ? end_key : borders_[borders_kept_ * i / n];
    }
    std::size_t most_parts() const { return borders_kept_ > 0 ? borders_kept_ : 1; }
    /// The key of the first page, if there is any.
    const Key &first() const { return borders_[0]; }

private:
    Batch *free_batch();
    void fetch(const Host &host, const Key *key);
    void keep_border(const Key &key);

    // For the session's thread.
    const std::size_t pages_; // of a batch
    Page page_;               // the next one, if there is any
    bool has_begun_ = false, has_page_ = false;
    std::size_t read_ = 0, each_kept_ = 1; // batches
    std::size_t borders_kept_ = 0;
    std::array<Key, 1024> borders_;

    mutable std::mutex lock_; // of what follows, except what is in batches
    std::condition_variable filled_;
    bool has_ended_ = false;
    Arena<Batch> batches_;
    Arena<Batch *> queue_; // not yet taken by a thread
};

} // namespace abacus
