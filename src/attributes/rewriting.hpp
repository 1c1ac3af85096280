// All attributes of a kind of owners written anew, or erased.
#pragma once

#include "attributes/attribute_pages.hpp"

namespace abacus {

/// More attributes for owners that have some: the new ones come behind the others and are NULL. How
/// many share a page depends on how many there are, so every page is another one. Returns the pages
/// that have been moved.
template <int D, int K>
abacus_counters widen_attributes(const Host &host, const Domain<D> &domain, unsigned attributes,
                                 unsigned more);

/// Other keys: those over another domain.
template <int D, int K>
abacus_counters rekey_attributes(const Host &host, const Domain<D> &from, const Domain<D> &to,
                                 unsigned attributes, std::size_t memory,
                                 unsigned first = first_group<K>);

/// No owner has any.
void erase_attributes(const Host &host, unsigned first);

} // namespace abacus
