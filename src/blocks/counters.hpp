// Sums of what meshes and octrees count.
#pragma once

#include <abacus/mesh_counters.h>

#include <algorithm>
#include <array>

namespace abacus {

/// Adds up counters of several builds; peaks are maxima.
constexpr abacus_counters &operator+=(abacus_counters &sum, const abacus_counters &more) {
    using C = abacus_counters;
    constexpr std::array added{
        &C::insertions,     &C::removals,      &C::steps,          &C::misses,
        &C::link_probes,    &C::quick_probes,  &C::ray_probes,     &C::concentric_probes,
        &C::incircle_tests, &C::incircle_hits, &C::walks,          &C::created,
        &C::deleted,        &C::loads,         &C::stores,         &C::rewrites,
        &C::splits,         &C::merges,        &C::evictions,      &C::eviction_batches,
        &C::bytes_read,     &C::bytes_written, &C::translation_ns, &C::total_ns,
        &C::passes,         &C::put_off,       &C::waited_ns};
    constexpr std::array greatest{&C::peak_bytes};
    static_assert((added.size() + greatest.size()) * sizeof(uint64_t) == sizeof(C));
    for (const auto counter : added) sum.*counter += more.*counter;
    for (const auto counter : greatest) sum.*counter = std::max(sum.*counter, more.*counter);
    return sum;
}

} // namespace abacus
