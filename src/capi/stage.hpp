// The stage behind the C interface, for the functions that take one.
#pragma once

#include "capi/dimension.hpp"
#include "staging/stage.hpp"

#include <abacus/build.h>

struct abacus_stage {
    abacus_stage(const abacus_host *table, const abacus_facts &facts, std::size_t memory)
        : host(*table), stage(host, facts, memory) {}

    const abacus::Host host;
    abacus::ByDimension<abacus::Stage> stage;
};
