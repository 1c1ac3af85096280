// Memory, wherever it comes from: the session's (a memory context, for the session's thread
// alone), or memory that any thread may use (thread_memory.hpp). Arrays and tables of the core use
// no other.
#pragma once

#include <abacus/host_functions.h>

#include <cstddef>
#include <new>

namespace abacus {

class Memory {
public:
    /// Like realloc(); size 0 frees and gives nullptr, as running out does.
    using Resize = void *(*)(void *context, void *block, std::size_t size);

    Memory(void *context, Resize resize) : context_(context), resize_(resize) {}

    /// Throws std::bad_alloc.
    void *resize(void *block, std::size_t size) const {
        void *moved = resize_(context_, block, size);
        if (moved == nullptr && size != 0) throw std::bad_alloc();
        return moved;
    }
    void release(void *block) const noexcept {
        if (block != nullptr) resize_(context_, block, 0);
    }

private:
    void *context_;
    Resize resize_;
};

} // namespace abacus
