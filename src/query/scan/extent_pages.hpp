// Which pages a question about a region has to read.
#pragma once

#include "query/scan/range_scan.hpp"

#include <abacus/extent.h>

namespace abacus {

/// Those in which the extent's region may be; empty if all are wanted.
template <int D> typename RangeScan<D>::Wants pages_in(const abacus_extent &extent) {
    if (extent.region == no_region) return {};
    return
        [region = extent.region](const PageView<D> &page) { return page.may_have_region(region); };
}

} // namespace abacus
