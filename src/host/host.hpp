// The database as the core sees it, in four parts: abacus_host with failures turned into
// exceptions. Every floor above takes a Host&, or the part it needs. None calls the C table
// itself.
//
// Threads. A Host is for the session's thread alone, since its functions end in PostgreSQL.
// Another thread may call Control::is_interrupted(), and may use memory of a ThreadMemory that
// the session's thread has made. It may use nothing else of the host.
#pragma once

#include "host/control.hpp"
#include "host/memory.hpp"
#include "host/pages.hpp"
#include "host/spools.hpp"

#include <cstdint>

namespace abacus {

class Host : public Memory, public Control, public Pages, public Spools {
public:
    explicit Host(const abacus_host &table)
        : Memory(table.context, table.resize), Control(table), Pages(table), Spools(table) {}
};

} // namespace abacus
