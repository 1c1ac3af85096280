// New fixed edges within the regions of seeds: what they cut off from all seeds leaves its region.
//
// For each face beside the new edges (traverse/faces.hpp) it is found out whether a seed lies in
// it. Faces without one are flooded. So the cost is that of the borders walked along and of the
// triangles that change. Where there are so many edges or seeds, or such long borders, that finding
// the regions anew may cost less, that is done.
#pragma once

#include "constrain/regions.hpp"
#include "traverse/faces.hpp"

namespace abacus {

class RegionCuts {
public:
    RegionCuts(Delaunay<2> &mesh, std::size_t memory);

    /// Adds a segment whose edges have been fixed.
    void add(const Point<2> &a, const Point<2> &b);
    /// Makes the regions of seeds with these parts what they are with the new edges; false, and
    /// `fault` says why, if that is impossible. No other region may lie on both sides of such an
    /// edge, but those of outlines, which no line cuts.
    bool finish(RegionParts &parts, abacus_region_fault &fault);

private:
    static constexpr std::size_t most_edges = 8192, most_seeds = 64;
    static constexpr std::uint64_t most_steps = std::uint64_t{1} << 22;
    struct Seeded {
        RegionNumber region;
        Faces::Edge face;
        bool operator==(const Seeded &) const = default;
    };
    enum class Found { sound, fault, too_much };

    Found find_seeds(RegionParts &parts, abacus_region_fault &fault);
    /// Calls visit(edge, face on its left) for those with a region of seeds there, until it returns
    /// false.
    template <class Visit> void each_seeded(Visit visit);
    Found clear_cut_off();
    bool renew(RegionParts &parts, abacus_region_fault &fault);
    Faces::Edge face(const std::optional<Faces::Edge> &name) {
        if (!name) throw_corrupted("A region reaches the hull.");
        return *name;
    }

    Delaunay<2> &mesh_;
    Cache<2> &cache_;
    Regions regions_;
    RegionFlood flood_;
    Faces faces_;
    bool are_many_ = false;
    Arena<RegionNumber> of_edges_;
    Arena<Seeded> seeded_;
};

} // namespace abacus
