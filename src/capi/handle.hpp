// Makes and ends the objects behind the handles of abacus.h. They live in the
// host's memory and have a member `host`.
#pragma once

#include "host/host.hpp"

#include <new>
#include <utility>

namespace abacus {

template <class Handle, class... Args>
Handle *create_handle(const abacus_host *table, Args &&...args) {
    static_assert(alignof(Handle) <= 8, "what a database's allocator grants");
    const Host host(*table);
    void *block = host.resize(nullptr, sizeof(Handle));
    try {
        return new (block) Handle(table, std::forward<Args>(args)...);
    } catch (...) {
        host.release(block);
        throw;
    }
}

template <class Handle> void destroy_handle(Handle *handle) noexcept {
    if (handle == nullptr) return;
    const Host host = handle->host;
    handle->~Handle();
    host.release(handle);
}

} // namespace abacus
