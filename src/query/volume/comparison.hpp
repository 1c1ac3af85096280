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
    /// Simplices that overlap, as far as they are in a window.
    void add(const ValuedSimplex<D> &first, const ValuedSimplex<D> &second, const Box<D> &window,
             const abacus_extent &extent);
    abacus_comparison result() const;

private:
    /// A piece, whose values are differences, seen in a frame.
    void add(const Piece<D> &piece, const NearFrame<D> &frame);

    GreatestDifference<D> greatest_;
    WideSum size_, sum_, absolute_, squares_;
};

template <int D>
abacus_comparison compare(const Host &host, const abacus_facts &facts,
                          const abacus_surface &surface, const OtherMesh &other);

extern template class Comparison<2>;
extern template class Comparison<3>;

} // namespace abacus
