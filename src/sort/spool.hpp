// Spools of records. Only close() closes a spool. After a failure the core may not call
// the host, and open spools go away with the transaction.
#pragma once

#include "host/host.hpp"

#include <algorithm>
#include <cstdint>
#include <utility>

namespace abacus {

class Spool {
public:
    Spool() = default;

    /// Appends n records of `stride` words.
    void write(const Host &host, const std::uint64_t *records, std::size_t n, std::size_t stride) {
        if (handle_ == nullptr) handle_ = host.spool_create();
        host.spool_write(handle_, records, n * stride * sizeof *records);
        size_ += n;
    }
    /// Number of records.
    std::uint64_t size() const { return size_; }

    void rewind(const Host &host) {
        if (handle_ != nullptr) host.spool_rewind(handle_);
        left_ = size_;
    }
    /// Reads the next records, at most `most`, and returns how many; 0 at the end.
    std::size_t read(const Host &host, std::uint64_t *to, std::size_t most, std::size_t stride) {
        const std::size_t n = std::min<std::uint64_t>(left_, most);
        if (n > 0 && !host.spool_read(handle_, to, n * stride * sizeof *to))
            throw Error(ABACUS_ERROR_INTERNAL, "a spool is shorter than the data that was written");
        left_ -= n;
        return n;
    }
    void close(const Host &host) {
        if (handle_ != nullptr) host.spool_close(std::exchange(handle_, nullptr));
        size_ = left_ = 0;
    }

private:
    void *handle_ = nullptr;
    std::uint64_t size_ = 0;
    std::uint64_t left_ = 0; ///< not read yet
};

} // namespace abacus
