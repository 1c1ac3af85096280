// The sizes of the parts of a mesh, and what they have in common.
#pragma once

#include "query/shares/cut.hpp"

#include <functional>

namespace abacus {

/// Calls visit(part) for all parts, also those without simplices. Reads all pages twice.
template <int D>
void part_sizes(const Host &host, const abacus_facts &facts, const Cut<D> &cut, std::size_t memory,
                const std::function<void(const abacus_part &)> &visit);

extern template void part_sizes<2>(const Host &, const abacus_facts &, const Cut<2> &, std::size_t,
                                   const std::function<void(const abacus_part &)> &);
extern template void part_sizes<3>(const Host &, const abacus_facts &, const Cut<3> &, std::size_t,
                                   const std::function<void(const abacus_part &)> &);

} // namespace abacus
