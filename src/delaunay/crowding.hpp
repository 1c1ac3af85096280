// Whether the domain of a stored mesh fits its points, by a look into a few pages.
//
// Where it does not, most pages lie inside of one code, which their keys tell. Of such pages the
// vertices say whether another domain would serve them better by far: there may be none.
//
// Pages are found by their keys. Any distribution of codes is possible, so the next key is always
// in the middle of the widest stretch of the curve that no page looked into owns. What is empty
// has few pages, and is soon done with.
#pragma once

#include "host/host.hpp"

#include <abacus/header.h>

namespace abacus {

/// False where a page looked into is damaged.
template <int D> bool looks_crowded(const Host &host, const abacus_header &header);

} // namespace abacus
