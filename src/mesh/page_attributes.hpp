// How many attributes are in simplex pages.
#pragma once

#include <abacus/facts.h>

namespace abacus {

/// Of each vertex of a page: all that the mesh has, or none if they are apart (src/attributes).
inline int page_attributes(const abacus_columns &columns) {
    if (columns.by_id != 0) return static_cast<int>(columns.in_pages);
    return columns.apart != 0 ? 0 : static_cast<int>(columns.attributes);
}

} // namespace abacus
