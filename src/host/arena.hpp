// A growing flat array in the host's memory. Elements are trivially copyable,
// so that growth is one resize(): for large arrays the C library moves pages,
// not bytes, and nothing is ever held twice.
#pragma once

#include "host/host.hpp"

#include <algorithm>
#include <type_traits>
#include <utility>

namespace abacus {

template <class T> class Arena {
    static_assert(std::is_trivially_copyable_v<T>);

public:
    explicit Arena(const Host &host) : host_(&host) {}
    Arena(const Arena &) = delete;
    Arena &operator=(const Arena &) = delete;
    Arena(Arena &&other) noexcept
        : host_(other.host_), data_(std::exchange(other.data_, nullptr)),
          size_(std::exchange(other.size_, 0)), capacity_(std::exchange(other.capacity_, 0)) {}
    ~Arena() { host_->release(data_); }

    T &operator[](std::size_t i) { return data_[i]; }
    const T &operator[](std::size_t i) const { return data_[i]; }
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

    /// Room for n elements, exactly; those beyond size() are uninitialized.
    void reserve(std::size_t n) {
        if (n <= capacity_) return;
        data_ = static_cast<T *>(host_->resize(data_, n * sizeof(T)));
        capacity_ = n;
    }
    /// New elements are uninitialized.
    void resize(std::size_t n) {
        if (n > capacity_) reserve(std::max(n, capacity_ + capacity_ / 4 + 64));
        size_ = n;
    }
    void push_back(T value) { *extend(1) = value; } // by value: it may be an element
    /// Adds n uninitialized elements; returns the first.
    T *extend(std::size_t n) {
        if (size_ + n > capacity_) [[unlikely]] resize(size_ + n);
        else size_ += n;
        return data_ + (size_ - n);
    }
    void pop_back() { --size_; }
    void clear() { size_ = 0; }
    /// Gives the memory back.
    void reset() {
        host_->release(data_);
        data_ = nullptr;
        size_ = capacity_ = 0;
    }

private:
    const Host *host_;
    T *data_ = nullptr;
    std::size_t size_ = 0;
    std::size_t capacity_ = 0;
};

} // namespace abacus
