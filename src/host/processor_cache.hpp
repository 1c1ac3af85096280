// What of the processor's cache matters to the core: how long its lines are, and how to ask for
// memory that will be read soon, so that many places come at once.
//
// touch() is a load whose value nobody waits for, and not a prefetch instruction: that may be
// dropped where the processor has not the translation of the address at hand, as in cold memory
// nearly always. With loads a page is made of vertices that nobody used for long in half of the
// time. Where prefetch instructions stand, loads were measured to gain nothing.
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
