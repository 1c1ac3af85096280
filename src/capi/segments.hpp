// Segments of lines behind the C interface, for the functions that take them.
#pragma once

#include "constrain/segments.hpp"

#include <abacus/constrain.h>

struct abacus_segments {
    abacus_segments(const abacus_host *table, const abacus_facts &facts, std::size_t memory)
        : host(*table), segments(host, facts, memory) {}

    const abacus::Host host;
    abacus::Segments segments;
};
