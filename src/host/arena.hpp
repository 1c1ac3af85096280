// A growing flat array in memory of any kind (memory.hpp). Elements are trivially copyable,
// so growth is one resize(). For large arrays the C library moves pages, not bytes, and
// nothing is ever held twice.
//
// Memory is asked for as the array fills, some pages at a time (populate.h). Page by page it
// would take a fault for each; for all the room at once it would take memory that is never
// used.
//
// The array begins at a line of the processor's cache, wherever the host's memory
// begins. So an element whose size divides that of a line never lies in two lines.
#pragma once

#include "host/host.hpp"
#include "host/processor_cache.hpp"

#include <abacus/populate.h>

#include <algorithm>
#include <cstdint>
#include <cstring>
#include <type_traits>
#include <utility>

namespace abacus {

/// `Index`: what its elements are numbered by. A type of its own is taken for no other's.
template <class T, class Index = std::size_t> class Arena {
    static_assert(std::is_trivially_copyable_v<T>);

public:
    explicit Arena(const Memory &memory) : memory_(memory) {}
    Arena(const Arena &) = delete;
    Arena &operator=(const Arena &) = delete;
    Arena(Arena &&other) noexcept
        : memory_(other.memory_), block_(std::exchange(other.block_, nullptr)),
          data_(std::exchange(other.data_, nullptr)), size_(std::exchange(other.size_, 0)),
          capacity_(std::exchange(other.capacity_, 0)), ready_(std::exchange(other.ready_, 0)) {}
    ~Arena() { memory_.release(block_); }
    /// Both in the same memory.
    void swap(Arena &other) noexcept {
        std::swap(block_, other.block_);
        std::swap(data_, other.data_);
        std::swap(size_, other.size_);
        std::swap(capacity_, other.capacity_);
        std::swap(ready_, other.ready_);
    }

    T &operator[](Index i) { return data_[static_cast<std::size_t>(i)]; }
    const T &operator[](Index i) const { return data_[static_cast<std::size_t>(i)]; }
    T *data() { return data_; }
    const T *data() const { return data_; }
    T *begin() { return data_; }
    T *end() { return data_ + size_; }
    const T *begin() const { return data_; }
    const T *end() const { return data_ + size_; }
    T &back() { return data_[size_ - 1]; }
    std::size_t size() const { return size_; }
    bool empty() const { return size_ == 0; }
    std::size_t capacity() const { return capacity_; }

    /// Room for n elements, exactly. Those beyond size() stay too, which may have been written.
    void reserve(std::size_t n) {
        if (n <= capacity_) return;
        const std::size_t offset = gap(block_);
        block_ = static_cast<char *>(memory_.resize(block_, n * sizeof(T) + cache_line));
        char *const data = block_ + gap(block_);
        if (gap(block_) != offset) std::memmove(data, block_ + offset, capacity_ * sizeof(T));
        data_ = reinterpret_cast<T *>(data);
        capacity_ = n;
    }
    /// New elements are uninitialized.
    void resize(std::size_t n) {
        if (n > ready_) [[unlikely]]
            make_ready(n);
        size_ = n;
    }
    void push_back(T value) { *extend(1) = value; } // by value: it may be an element
    /// Adds n uninitialized elements; returns the first.
    T *extend(std::size_t n) {
        if (size_ + n > ready_) [[unlikely]]
            make_ready(size_ + n);
        size_ += n;
        return data_ + (size_ - n);
    }
    void pop_back() { --size_; }
    void clear() { size_ = 0; }
    /// Gives the memory back.
    void reset() {
        memory_.release(block_);
        block_ = nullptr;
        data_ = nullptr;
        size_ = capacity_ = ready_ = 0;
    }

private:
    /// Elements that get memory at once, in arrays of more; 16 pages of 4 KB.
    static constexpr std::size_t populated_at_once = (std::size_t{64} << 10) / sizeof(T) + 1;

    /// Room and memory for n elements and some more.
    void make_ready(std::size_t n) {
        if (n > capacity_) reserve(std::max(n, capacity_ + capacity_ / 4 + 64));
        if (capacity_ <= populated_at_once) {
            ready_ = capacity_;
            return;
        }
        const std::size_t ready = std::min(capacity_, std::max(n, ready_ + populated_at_once));
        abacus_populate(data_ + ready_, (ready - ready_) * sizeof(T));
        ready_ = ready;
    }

    /// Bytes from a block's begin to that of a line.
    static std::size_t gap(const char *block) {
        return -reinterpret_cast<std::uintptr_t>(block) % cache_line;
    }

    Memory memory_;
    char *block_ = nullptr; // from the host
    T *data_ = nullptr;
    std::size_t size_ = 0;
    std::size_t capacity_ = 0;
    std::size_t ready_ = 0; // elements that have memory, not only addresses
};

} // namespace abacus
