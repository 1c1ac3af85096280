// Whether this is a build with sanitizers, where inputs that take long are smaller. It is asked
// when a test runs, since one build's tests are linked with another's core (test/CMakeLists.txt).
#pragma once

namespace abacus::test {

extern const bool sanitized;

} // namespace abacus::test
