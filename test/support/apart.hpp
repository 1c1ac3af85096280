// A switch for all tests of meshes with attributes: with ABACUS_TEST_APART in the environment they
// have them in pages of their own. Answers are the same.
#pragma once

#include <abacus/mesh_header.h>

#include <cstdlib>

namespace abacus::test {

inline bool are_attributes_apart() { return std::getenv("ABACUS_TEST_APART") != nullptr; }

/// For a new mesh whose attributes have been counted.
inline void choose_where_attributes_are(abacus_header &header) {
    header.facts.columns.apart = header.facts.columns.attributes > 0 && are_attributes_apart();
}

} // namespace abacus::test
