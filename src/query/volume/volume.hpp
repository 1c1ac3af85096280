// Areas and volumes of what a mesh represents.
//
// In the plane an attribute is a surface over the mesh. The volume is that between it and a base,
// or between the surfaces of two meshes. In space it is that of the part where the attribute is at
// least the base.
//
// Simplices are cut into pieces on which everything is linear (geometry/piece.hpp): at the border
// of a window, at the edges of the other mesh, and where the surface crosses the base. The
// contribution of a simplex is computed from its corners in a fixed order, relative to the first of
// them; and the sums are exact (geometry/exact_sum.hpp). So the result does not depend on the order
// of the simplices, on where pages end, or on the history of the mesh.
#pragma once

#include "geometry/exact_sum.hpp"
#include "geometry/piece.hpp"
#include "query/volume/overlay.hpp"

#include <abacus/volume.h>

namespace abacus {

/// The sums of pieces so far.
template <int D> class Volume {
public:
    /// In the plane a piece of the surface: its values are heights above the base. In space the
    /// base is where its values are 0.
    void add(const Piece<D> &piece);
    /// The same between two surfaces, the first of which is this many times as large as
    /// its projection.
    void add(const Portion<D> &portion, const ScaledNumber &steepness);

    abacus_volume sums() const {
        return {area_.value(), surface_.value(), cut_.value(), fill_.value()};
    }

private:
    void add_sides(const Piece<D> &piece);

    WideSum area_, surface_, cut_, fill_;
};

/// For a mesh over a base. Simplices with a corner that has no finite value are left out.
template <int D>
abacus_volume volume_above(const Host &host, const abacus_facts &facts,
                           const abacus_surface &surface, double base);

/// Between a mesh and another one, both of dimension 2.
abacus_volume volume_between(const Host &host, const abacus_facts &facts,
                             const abacus_surface &surface, const OtherMesh &other);

extern template class Volume<2>;
extern template class Volume<3>;

} // namespace abacus
