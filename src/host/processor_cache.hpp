// What matters to the core about the processor's cache: the length of its lines, and how to ask
// for memory that will be read soon, so that many places come at once.
//
// touch() is a load whose value nobody waits for. It is no prefetch instruction, since the
// processor may drop that where it lacks the translation of the address, as nearly always in
// cold memory. With loads, making a page of vertices that were not used for long takes half the
// time. Where prefetch instructions stand, loads gain nothing.
#pragma once

#include <cstddef>

namespace abacus {

inline constexpr std::size_t cache_line = 64; // bytes

/// Reads from each line of an object.
template <class T> inline void touch(const T *object) {
    const auto *const bytes = reinterpret_cast<const volatile char *>(object);
    for (std::size_t at = 0; at < sizeof(T); at += cache_line) static_cast<void>(bytes[at]);
    if constexpr (cache_line % sizeof(T) != 0) static_cast<void>(bytes[sizeof(T) - 1]);
}

/// Asks for so many objects in a row by prefetch instructions.
template <class T> inline void prefetch(const T *objects, std::size_t count) {
    const auto *const bytes = reinterpret_cast<const char *>(objects);
    for (std::size_t at = 0; at < count * sizeof(T); at += cache_line)
        __builtin_prefetch(bytes + at);
}

} // namespace abacus
