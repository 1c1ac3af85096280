// A switch for all tests of meshes with attributes: if ABACUS_TEST_APART is in the environment,
// attributes are in pages of their own. The answers are the same.
#pragma once

#include <abacus/mesh_header.h>

#include <cstdlib>

namespace abacus::test {

inline bool are_attributes_apart() { return std::getenv("ABACUS_TEST_APART") != nullptr; }

/// For a new mesh whose number of attributes is known.
inline void choose_where_attributes_are(abacus_header &header) {
    header.facts.columns.apart = header.facts.columns.attributes > 0 && are_attributes_apart();
}

} // namespace abacus::test
