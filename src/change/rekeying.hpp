// Another domain for a mesh that has outgrown its own.
//
// The domain is that of the first points, or a given one. Points outside have the codes of its
// border. The mesh is right all the same, but neighbours in space are far apart on the curve,
// and pages are found slowly. A few such points do no harm, and a domain around one far point
// would harm all others. But a mesh may begin in one corner and grow, tile by tile or row by
// row. Or it begins with one point far away. Then all others have the same code, and only parts
// tell their simplices apart, no longer in the order of the curve.
//
// So the header counts the points that came from outside, and those that came where so many
// simplices have one code that they fill pages. When they are many, the points of the mesh are
// copied to a stage, which knows where they are (spread.hpp). If another domain serves them far
// better, the mesh is built again along its curve, as if all points had come at once. That domain
// leaves room for more points. So a growing mesh is built again only when it is a few times as
// wide, and all rebuilds together cost no more than a second build. If no domain is better, as
// where points crowd at places too far apart for any scale, the count begins anew. So the cost of
// each look is spread over as many points as led to it.
//
// Deleted points and meshes built in batches are not counted. For these a look into a few pages
// answers when somebody asks (crowding.hpp).
#pragma once

#include "change/inserting.hpp"
#include "change/label_upkeep.hpp"
#include "points/spread.hpp"

#include <array>

namespace abacus {

template <int D> class Rekeying {
public:
    Rekeying(Workspace<D> &work, Inserting<D> &inserting, LabelUpkeep<D> &labels)
        : work_(work), inserting_(inserting), labels_(labels) {}

    /// With this many points to come.
    bool has_outgrown_domain(std::uint64_t coming) const;
    /// Chooses another domain, for all points and those to come, and rebuilds the triangulation
    /// over it. False if no domain serves them far better. `memory` is for sorting.
    bool change_domain(const Spread<D> &coming, std::size_t memory);

private:
    using Corners = std::array<AnyRecord<D>, D + 1>; ///< of a simplex

    /// Where all points are, those to come and those taken apart included.
    Box<D> best_box(const Spread<D> &coming, const Stage<D> &points, const Corners *corners,
                    bool &is_better) const;
    void take_apart(Stage<D> &points, Corners &corners);
    void take_corners(Corners &corners);
    void take_repeated(Stage<D> &points);
    /// Over the new domain, without simplices.
    void start_over(const Box<D> &box, std::size_t memory);

    Workspace<D> &work_;
    Inserting<D> &inserting_;
    LabelUpkeep<D> &labels_;
};

extern template class Rekeying<2>;
extern template class Rekeying<3>;

} // namespace abacus
