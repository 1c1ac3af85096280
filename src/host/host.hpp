// The database as the core sees it: abacus_host with failures turned into
// exceptions. Every floor above takes a Host&, none calls the C table itself.
#pragma once

#include <abacus/host.h>

#include <cstddef>
#include <cstdint>
#include <new>
#include <stdexcept>
#include <string>

namespace abacus {

/// Thrown when a host function failed; the host keeps the error itself.
struct HostFailure {};

/// An error of the core's own; ends in src/capi as an abacus_error.
class Error : public std::runtime_error {
public:
    Error(abacus_error_kind kind, const std::string &message, std::string detail = {},
          std::string hint = {})
        : std::runtime_error(message), kind(kind), detail(std::move(detail)),
          hint(std::move(hint)) {}

    abacus_error_kind kind;
    std::string detail;
    std::string hint;
};

/// Stored bytes that the core did not write.
[[noreturn]] inline void throw_corrupted(const std::string &detail) {
    throw Error(ABACUS_ERROR_CORRUPTED, "mesh is corrupted", detail,
                "Run abacus_check on the mesh; restore it from a backup or build it anew.");
}

class Host {
public:
    explicit Host(const abacus_host &table) : table_(&table) {}

    void *resize(void *block, std::size_t size) const {
        void *moved = table_->resize(table_->context, block, size);
        if (moved == nullptr && size != 0) throw std::bad_alloc();
        return moved;
    }
    void release(void *block) const noexcept {
        if (block != nullptr) table_->resize(table_->context, block, 0);
    }

    /// Serves a pending interrupt; throws if it ends the statement.
    void poll() const {
        if (*table_->interrupted != 0) [[unlikely]]
            require(table_->poll(table_->context));
    }
    void progress(const abacus_progress &progress) const {
        require(table_->progress(table_->context, &progress));
    }

    /// False when there is no such page.
    bool find(abacus_page_kind kind, abacus_key key, abacus_page &page) const {
        return found(table_->find(table_->context, kind, key, &page));
    }
    /// False when it is no longer there.
    bool fetch(abacus_page_kind kind, abacus_page &page) const {
        return found(table_->fetch(table_->context, kind, &page));
    }
    bool next(abacus_page_kind kind, const abacus_key *key, abacus_page &page) const {
        return found(table_->next(table_->context, kind, key, &page));
    }
    void put(abacus_page_kind kind, abacus_page &page) const {
        require(table_->put(table_->context, kind, &page));
    }
    void erase(abacus_page_kind kind, const abacus_page &page) const {
        require(table_->erase(table_->context, kind, &page));
    }

    void *spool_create() const {
        void *spool = nullptr;
        require(table_->spool_create(table_->context, &spool));
        return spool;
    }
    void spool_write(void *spool, const void *bytes, std::size_t size) const {
        require(table_->spool_write(table_->context, spool, bytes, size));
    }
    void spool_rewind(void *spool) const { require(table_->spool_rewind(table_->context, spool)); }
    bool spool_read(void *spool, void *bytes, std::size_t size) const {
        return found(table_->spool_read(table_->context, spool, bytes, size));
    }
    void spool_close(void *spool) const { require(table_->spool_close(table_->context, spool)); }

private:
    static bool found(abacus_host_status status) {
        if (status == ABACUS_HOST_FAILED) throw HostFailure{};
        return status == ABACUS_HOST_OK;
    }
    static void require(abacus_host_status status) {
        if (status != ABACUS_HOST_OK) throw HostFailure{};
    }

    const abacus_host *table_;
};

} // namespace abacus
