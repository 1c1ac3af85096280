// The regions of shards: which shard owns a point, and which regions a box or a half-space meets.
//
// The curve over one domain is cut at codes, its borders. Shard i owns the codes from border i - 1
// on, up to border i, and the region where points have these codes. An interval of the curve is a
// union of cells, squares or cubes of different sizes. So a tree of cells, halved on each axis, has
// leaves that belong to one shard each. On each level only the cells that contain a border are
// divided further: the tree is small.
//
// Invariants:
//   1. The box of a node contains all points of the mesh in its cell. The quantization of
//      coordinates is monotonous, also with its rounding, so the ends of a box are found with the
//      quantization itself, never by an inverse that is only nearly right. Points outside the
//      domain belong to the cells at its border: there the box ends where the points do.
//   2. So every answer is rounded outwards: a region that is met is reported, and perhaps one that
//      is only touched or nearly met.
#pragma once

#include "geometry/box.hpp"
#include "geometry/predicates.hpp"
#include "geometry/quick_sphere_box.hpp"
#include "geometry/sphere_box.hpp"
#include "host/arena.hpp"
#include "keys/locational_code.hpp"

#include <span>

namespace abacus {

/// A box whose sides may be infinite or NaN where there is no bound: then it meets whatever is
/// there.
template <int D> bool may_meet(const Box<D> &unsure, const Box<D> &box) {
    bool misses = false;
    for (int i = 0; i < D; ++i)
        misses |= unsure.lower[i] > box.upper[i] || unsure.upper[i] < box.lower[i];
    return !misses;
}

template <int D> class ShardRegions {
public:
    /// Borders ascend; some may be equal, with shards between them that own nothing. `extent`
    /// contains all points of all shards.
    ShardRegions(const Memory &memory, const Domain<D> &domain,
                 std::span<const std::uint64_t> borders, const Box<D> &extent);

    std::uint32_t shards() const { return static_cast<std::uint32_t>(borders_.size()) + 1; }
    /// The shard that owns a code.
    std::uint32_t owner(std::uint64_t code) const {
        return static_cast<std::uint32_t>(std::upper_bound(borders_.begin(), borders_.end(), code) -
                                          borders_.begin());
    }
    std::uint32_t owner(const Point<D> &p) const { return owner(domain_.code(p)); }

    /// Calls visit(shard) for each shard whose region may meet the circumsphere of a simplex, of a
    /// ghost (whose last corner is not read) its half-space with what belongs to it on its border;
    /// often several times for one shard.
    template <class Visit>
    void each_met(const Corners<D> &corners, bool is_ghost, Visit visit) const {
        if (is_ghost) {
            const Box<D> touched = facet_ball_box<D>(corners);
            const auto meets = [&](const Box<D> &box) {
                return meets_half_space(corners, box, touched);
            };
            descend(0, meets, visit);
        } else {
            Box<D> sphere;
            if (!quick_sphere_box<D>(corners, sphere)) sphere = sphere_box<D>(corners);
            descend(
                0, [&](const Box<D> &box) { return may_meet<D>(sphere, box); }, visit);
        }
    }

    /// Calls visit(box, shard) for boxes that together contain all points of a shard's region, for
    /// all shards; a box without any may have its upper end below the lower one.
    template <class Visit> void each_box(Visit visit) const {
        for (const Node &node : nodes_)
            if (node.owner != mixed) visit(node.box, node.owner);
    }

private:
    static constexpr int children = 1 << D;
    static constexpr std::uint32_t mixed = ~0u;

    struct Node {
        Box<D> box;
        std::uint32_t owner; // or mixed
        std::uint32_t first; // of its children, if it is mixed
    };

    void divide(std::uint32_t node, const Cell<D> &cell, int bits);
    Node node_of(const Cell<D> &cell, int bits) const;
    Box<D> box_of(const Cell<D> &cell, int bits) const;
    double begin_of(int axis, std::uint32_t cell) const;
    double end_of(int axis, std::uint32_t cell) const;

    /// Whether a box has points that may be in conflict with a ghost; `touched` contains those of
    /// them that lie on the plane of its facet.
    static bool meets_half_space(const Corners<D> &corners, const Box<D> &box,
                                 const Box<D> &touched);
    /// Descends where meets(box) holds.
    template <class Meets, class Visit>
    void descend(std::uint32_t node, const Meets &meets, const Visit &visit) const {
        const Node &here = nodes_[node];
        if (!meets(here.box)) return;
        if (here.owner != mixed) return visit(here.owner);
        for (std::uint32_t child = 0; child < children; ++child)
            descend(here.first + child, meets, visit);
    }

    Domain<D> domain_;
    Arena<std::uint64_t> borders_;
    Box<D> extent_;
    Arena<Node> nodes_;
};

extern template class ShardRegions<2>;
extern template class ShardRegions<3>;

} // namespace abacus
