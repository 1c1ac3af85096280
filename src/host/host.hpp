// The database as the core sees it, in four parts: abacus_host with failures turned into
// exceptions. Every floor above takes a Host&, or the part it needs. None calls the C table
// itself.
//
// Threads. The session's Host is for the session's thread alone, since its functions end in
// PostgreSQL. Another thread has a Host of its own, whose functions ask the session's thread
// (desk.hpp), with memory of a ThreadMemory. It may use nothing else of the session's.
#pragma once

#include "host/control.hpp"
#include "host/memory.hpp"
#include "host/pages.hpp"
#include "host/spools.hpp"

#include <cstdint>

namespace abacus {

class Host : public Memory, public Control, public Pages, public Spools {
public:
    /// `watch` gets to know of stored pages, unless it is null.
    explicit Host(const abacus_host &table, PageWatch *watch = nullptr)
        : Memory(table.context, table.resize), Control(table), Pages(table, watch), Spools(table) {}
    /// The same host, but for pages that are kept.
    Host(const Host &host, PageKeeper &keeper)
        : Memory(host), Control(host), Pages(host, keeper), Spools(host) {}
};

} // namespace abacus
