// Memory that any thread may use. The session's thread reserves it and counts it. What is left of
// it is freed with the ThreadMemory, whatever became of the threads.
//
// Invariants
//   1. used() never exceeds reserved(): a request for more is refused as if memory had run out.
//   2. Every block handed out is on the list, so the destructor finds it.
//
// The blocks come from the C library, whose large ones grow without being copied and whose small
// ones have an arena for each thread. The list has a lock, which is held for some instructions:
// arrays of the core grow seldom.
#pragma once

#include "host/memory.hpp"

#include <mutex>

namespace abacus {

class ThreadMemory {
public:
    ThreadMemory() = default;
    ThreadMemory(const ThreadMemory &) = delete;
    ThreadMemory &operator=(const ThreadMemory &) = delete;
    /// Frees what is left. No other thread may use it any more.
    ~ThreadMemory();

    /// For the session's thread: so many bytes may be used in all.
    void reserve(std::size_t bytes);
    std::size_t reserved() const;
    /// Bytes in use, those that keep account of them included.
    std::size_t used() const;

    /// For any thread; good as long as this is.
    Memory memory() { return Memory(this, resize); }

private:
    struct Block;

    static void *resize(void *context, void *block, std::size_t size);
    void *resize(Block *block, std::size_t size);
    void unlink(Block &block);
    void link(Block &block);

    mutable std::mutex lock_;
    Block *first_ = nullptr;
    std::size_t reserved_ = 0;
    std::size_t used_ = 0;
};

} // namespace abacus
