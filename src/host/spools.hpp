// Temporary files, written from start to end, then read from start to end. For the session's
// thread.
#pragma once

#include "host/error.hpp"

#include <cstddef>

namespace abacus {

class Spools {
public:
    explicit Spools(const abacus_host &table) : table_(&table) {}

    void *spool_create() const {
        void *spool = nullptr;
        host::require(table_->spool_create(table_->context, &spool));
        return spool;
    }
    void spool_write(void *spool, const void *bytes, std::size_t size) const {
        host::require(table_->spool_write(table_->context, spool, bytes, size));
    }
    void spool_rewind(void *spool) const {
        host::require(table_->spool_rewind(table_->context, spool));
    }
    /// False at the end.
    bool spool_read(void *spool, void *bytes, std::size_t size) const {
        return host::found(table_->spool_read(table_->context, spool, bytes, size));
    }
    void spool_close(void *spool) const {
        host::require(table_->spool_close(table_->context, spool));
    }
    /// At least so many bytes are about to be written, and will be there at one time; throws if
    /// there is no room for them.
    void spool_expect(double bytes) const {
        if (bytes > 0) host::require(table_->spool_expect(table_->context, bytes));
    }
    /// Whether there is room for so many bytes. If not, the caller counts what it really needs.
    bool spool_fits(double bytes) const {
        return host::found(table_->spool_fits(table_->context, bytes));
    }

private:
    const abacus_host *table_;
};

} // namespace abacus
