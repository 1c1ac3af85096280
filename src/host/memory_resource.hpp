// Memory of the host, or of threads, for standard containers.
#pragma once

#include "host/host.hpp"

#include <memory_resource>

namespace abacus {

class HostMemory final : public std::pmr::memory_resource {
public:
    explicit HostMemory(const Memory &memory) : memory_(memory) {}

private:
    void *do_allocate(std::size_t bytes, std::size_t) override {
        return memory_.resize(nullptr, bytes > 0 ? bytes : 1);
    }
    void do_deallocate(void *block, std::size_t, std::size_t) override { memory_.release(block); }
    bool do_is_equal(const std::pmr::memory_resource &other) const noexcept override {
        return this == &other;
    }

    Memory memory_;
};

} // namespace abacus
