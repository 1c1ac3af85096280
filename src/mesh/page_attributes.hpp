// How many attributes are in simplex pages.
#pragma once

#include <abacus/mesh_header.h>

namespace abacus {

/// Of each vertex of a page: all that the mesh has, or none if they are apart (src/attributes).
inline int page_attributes(const abacus_header &header) {
    return header.apart != 0 ? 0 : static_cast<int>(header.attributes);
}

} // namespace abacus
