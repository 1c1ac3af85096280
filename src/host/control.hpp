// What the core hears from the session, and what others hear of its work: interrupts and
// progress. It is for the session's thread; another thread may call is_interrupted().
#pragma once

#include "host/error.hpp"

#include <cstddef>

namespace abacus {

class Control {
public:
    explicit Control(const abacus_host &table) : table_(&table) {}

    /// Whether poll() has something to do.
    bool is_interrupted() const {
        return __atomic_load_n(table_->interrupted, __ATOMIC_RELAXED) != 0;
    }
    /// Serves a pending interrupt; throws if it ends the statement.
    void poll() const {
        if (is_interrupted()) [[unlikely]]
            host::require(table_->poll(table_->context));
    }
    /// Threads that may compute, at least one: the session's.
    unsigned threads() const { return table_->threads > 1 ? table_->threads : 1; }
    /// For tests: threads share even little work, in many pieces cut at random.
    bool has_tiny_intervals() const { return table_->tiny_intervals != 0; }
    /// For tests: bytes that threads may have in all; 0: any number.
    std::size_t most_thread_bytes() const { return table_->most_thread_bytes; }
    /// Whether both are of one host.
    bool is_same(const Control &other) const { return table_ == other.table_; }
    void progress(const abacus_progress &progress) const {
        host::require(table_->progress(table_->context, &progress));
    }

private:
    const abacus_host *table_;
};

} // namespace abacus
