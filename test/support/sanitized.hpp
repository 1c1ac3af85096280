// Whether this is a build with sanitizers, where inputs that take long are smaller.
#pragma once

namespace abacus::test {

#ifdef ABACUS_SANITIZED // CMakeLists.txt; of the compilers each has another word for it
constexpr bool sanitized = true;
#else
constexpr bool sanitized = false;
#endif

} // namespace abacus::test
