// How two meshes differ where both have a value: over the pieces of their overlay.
//
// The difference is linear in each piece. So its integrals follow from its values at the corners;
// sums of them are exact. The greatest difference is found in rational numbers
// (greatest_difference.hpp). Neither depends on the order of the pieces.
#pragma once

#include "geometry/exact_sum.hpp"
#include "geometry/greatest_difference.hpp"
#include "query/volume/overlay.hpp"

namespace abacus {

template <int D> class Comparison {
public:
    explicit Comparison(bool is_exact) : portions_(is_exact) {}
    /// Simplices that overlap, as far as they are in a window.
    void add(const ValuedSimplex<D> &first, const ValuedSimplex<D> &second, const Box<D> &window,
             const abacus_extent &extent);
    bool is_sure() const { return portions_.is_sure(); }
    abacus_comparison result() const;

private:
    void add(const Portion<D> &portion);

    GreatestDifference<D> greatest_;
    CommonPortions<D> portions_;
    WideSum size_, sum_, absolute_, squares_;
};

template <int D>
abacus_comparison compare(const Host &host, const abacus_facts &facts,
                          const abacus_surface &surface, const OtherMesh &other);

extern template class Comparison<2>;
extern template class Comparison<3>;

} // namespace abacus
