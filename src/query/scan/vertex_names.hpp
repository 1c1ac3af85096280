// Words that distinguish a vertex from others, and give their order along the curve.
#pragma once

#include "blocks/bit_column.hpp"
#include "keys/domain_of.hpp"
#include "mesh/page_format.hpp"

#include <abacus/facts.h>

namespace abacus {

/// Flips the sign of an id, so that ids as unsigned words are in their order.
inline constexpr std::uint64_t id_sign = std::uint64_t{1} << 63;

/// A vertex's code, its coordinates; if vertices share their places, also its id.
template <int D> class VertexNames {
public:
    explicit VertexNames(const abacus_facts &facts)
        : domain_(domain_of<D>(facts.form)), are_split_(facts.census.split > 0) {}

    std::size_t words() const { return 1 + D + (are_split_ ? 1 : 0); }
    void write(const PageView<D> &page, int vertex, std::uint64_t *name) const {
        const Point<D> &p = page.point(vertex);
        *name++ = domain_.code(p);
        for (const double x : p) *name++ = ordered(x);
        if (are_split_) *name = static_cast<std::uint64_t>(page.id(vertex)) ^ id_sign;
    }

private:
    const Domain<D> domain_;
    const bool are_split_;
};

} // namespace abacus
