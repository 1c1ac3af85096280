// The database as the core sees it: abacus_host with failures turned into exceptions, in four
// parts. Every floor above takes a Host&, or the part it needs; none calls the C table itself.
//
// Threads. A Host is for the session's thread alone: its functions end in PostgreSQL. Another
// thread may ask Control::is_interrupted(), and use memory of a ThreadMemory that the session's
// thread has made; nothing else of the host.
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
