// Decides from a few pages whether the domain of a stored mesh fits its points.
//
// If it does not, most pages lie within one code, as their keys show. The vertices of such pages
// show whether another domain would serve them far better. There may be none.
//
// Pages are found by their keys. Any distribution of codes is possible. So the next key is always
// in the middle of the widest stretch of the curve that no page seen so far owns. Empty regions
// have few pages, so the search soon leaves them.
#pragma once

#include "host/host.hpp"

#include <abacus/facts.h>

namespace abacus {

/// False where a page looked into is damaged.
template <int D> bool looks_crowded(const Host &host, const abacus_facts &facts);

} // namespace abacus
