// Edges fixed and freed, as a part of a change (build.hpp).
//
// With several threads, segments whose edges are to be fixed are gathered, and fixed together
// (gathering.hpp). Edges are freed by the session's thread, which alone may ask for lines.
#pragma once

#include "change/gathering.hpp"
#include "constrain/regions.hpp"
#include "constrain/segments.hpp"

#include <abacus/regions.h>

#include <functional>

namespace abacus {

template <int D> class Constraining final : private Gathering<D>::User {
public:
    Constraining(Workspace<D> &work, Gathering<D> &gathering)
        : work_(work), gathering_(gathering) {}
    Constraining(const Constraining &) = delete;
    Constraining &operator=(const Constraining &) = delete;

    /// Fixes the edges of all segments, of a mesh with simplices; returns how many segments there
    /// were.
    std::uint64_t fix(Segments &segments);
    /// Frees the edges of all segments over which the host has no line; false, and `fault` says
    /// why, if that is impossible.
    bool unfix(Segments &segments, abacus_region_fault &fault);
    /// Makes the mesh Delaunay again, but for its fixed edges, from edges that may fail the test.
    std::uint64_t restore(Segments &edges);
    /// Puts triangles into the regions that have these parts; false, and `fault` says why, if that
    /// is impossible.
    bool fill_regions(RegionParts &parts, const Regions::Report &report,
                      abacus_region_fault &fault);
    /// Takes all triangles out of these regions.
    void clear_regions(RegionParts &parts);
    /// Makes regions of seeds, with these parts, what they are with segments whose edges have been
    /// fixed; false, and `fault` says why, if that is impossible.
    bool cut_regions(Segments &segments, RegionParts &parts, abacus_region_fault &fault);
    /// Calls visit(region) for the regions on either side of segments, which are fixed.
    void regions_along(Segments &segments, const std::function<void(RegionNumber)> &visit);
    /// Whether the mesh has a vertex at p, and its record unless that is null.
    bool find_vertex(const Point<D> &p, std::uint64_t *record);

private:
    Deed deed() const override { return Deed::fix; }
    bool is_shared() const override { return true; }
    bool keeps_left() const override { return false; }
    void take(const std::uint64_t *records, const std::uint64_t *codes, std::size_t n) override;
    void finish_here() override {}
    void take_left(const std::uint64_t *) override {}
    const typename Gathering<D>::Removing *begin_sharing() override { return nullptr; }
    void end_sharing() override {}
    bool counts_crowded() const override { return false; }

    template <class Change> std::uint64_t each(Segments &segments, Change change);
    /// Finds a line over the edge of a fault.
    void name_line(abacus_region_fault &fault);
    /// Calls change(mesh) with a mesh in the plane, which may have regions.
    template <class Change> void with_regions(Change change);

    Workspace<D> &work_;
    Gathering<D> &gathering_;
};

extern template class Constraining<2>;
extern template class Constraining<3>;

} // namespace abacus
