#include "sanitized.hpp"

namespace abacus::test {

#ifdef ABACUS_SANITIZED // CMakeLists.txt; of the compilers each has another word for it
const bool sanitized = true;
#else
const bool sanitized = false;
#endif

} // namespace abacus::test
