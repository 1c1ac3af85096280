// What the core hears from the session, and what others hear of its work: interrupts and
// progress. It is for the session's thread; another thread may call is_interrupted().
#pragma once

#include "host/error.hpp"

namespace abacus {

class Control {
public:
    explicit Control(const abacus_host &table) : table_(&table) {}

    /// Whether poll() has something to do.
    bool is_interrupted() const { return *table_->interrupted != 0; }
    /// Serves a pending interrupt; throws if it ends the statement.
    void poll() const {
        if (is_interrupted()) [[unlikely]]
            host::require(table_->poll(table_->context));
    }
    void progress(const abacus_progress &progress) const {
        host::require(table_->progress(table_->context, &progress));
    }

private:
    const abacus_host *table_;
};

} // namespace abacus
