// Whether this is a build with sanitizers, where slow inputs are smaller. Tests ask for it at run
// time, since one build's tests are linked with another's core (test/CMakeLists.txt).
#pragma once

namespace abacus::test {

extern const bool sanitized;

} // namespace abacus::test
