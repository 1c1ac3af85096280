// More attributes for owners that have some.
#pragma once

#include "attributes/attribute_pages.hpp"

namespace abacus {

/// Writes all pages of a kind anew, since how many attributes share a page depends on how many
/// there are. The new ones come behind the others and are NULL. Returns how many pages it has
/// moved.
template <int D, int K>
abacus_counters widen_attributes(const Host &host, const Domain<D> &domain, unsigned attributes,
                                 unsigned more);

extern template abacus_counters widen_attributes<2, 3>(const Host &, const Domain<2> &, unsigned,
                                                       unsigned);
extern template abacus_counters widen_attributes<3, 4>(const Host &, const Domain<3> &, unsigned,
                                                       unsigned);

} // namespace abacus
