#include "host/thread_memory.hpp"

#include <cstdlib>

namespace abacus {

/// The head of each allocated block, which keeps malloc()'s alignment.
struct alignas(std::max_align_t) ThreadMemory::Block {
    Block *previous;
    Block *next;
    std::size_t bytes; // this included
};

ThreadMemory::~ThreadMemory() {
    while (Block *block = first_) {
        first_ = block->next;
        std::free(block);
    }
}

void ThreadMemory::reserve(std::size_t bytes) {
    const std::lock_guard guard(lock_);
    reserved_ = bytes;
}

std::size_t ThreadMemory::reserved() const {
    const std::lock_guard guard(lock_);
    return reserved_;
}

std::size_t ThreadMemory::used() const {
    const std::lock_guard guard(lock_);
    return used_;
}

void *ThreadMemory::resize(void *context, void *block, std::size_t size) {
    return static_cast<ThreadMemory *>(context)->resize(
        block == nullptr ? nullptr : static_cast<Block *>(block) - 1, size);
}

void *ThreadMemory::resize(Block *block, std::size_t size) {
    const std::lock_guard guard(lock_);
    const std::size_t before = block == nullptr ? 0 : block->bytes;
    if (size == 0) {
        if (block != nullptr) unlink(*block);
        used_ -= before;
        std::free(block);
        return nullptr;
    }
    const std::size_t bytes = size + sizeof(Block);
    if (bytes < size || (bytes > before && bytes - before > reserved_ - used_)) return nullptr;
    if (block != nullptr) unlink(*block);
    auto *const moved = static_cast<Block *>(std::realloc(block, bytes));
    if (moved == nullptr) {
        if (block != nullptr) link(*block);
        return nullptr;
    }
    moved->bytes = bytes;
    link(*moved);
    used_ = used_ - before + bytes;
    return moved + 1;
}

void ThreadMemory::unlink(Block &block) {
    (block.previous != nullptr ? block.previous->next : first_) = block.next;
    if (block.next != nullptr) block.next->previous = block.previous;
}

void ThreadMemory::link(Block &block) {
    block.previous = nullptr;
    block.next = first_;
    if (first_ != nullptr) first_->previous = &block;
    first_ = &block;
}

} // namespace abacus
