// Changes of a mesh as a whole (dissertation §4.12.5). Each is made of parts that share one
// workspace (workspace.hpp):
//
//   inserting     points that wait, or that a stage passes on (inserting.hpp)
//   deleting      points, one by one or by triangulating the rest (deleting.hpp)
//   updating      attributes of points (revision.hpp), or which attributes there are
//                 (attribute_change.hpp)
//   rekeying      another domain for a mesh that has outgrown its own (rekeying.hpp)
//   gathering     points for several threads (gathering.hpp)
//   constraining  edges fixed and freed along lines (constraining.hpp)
//   label upkeep  labels and markers that follow the simplices (label_upkeep.hpp)
//
// Each change ends with all pages written and the header brought up to date.
#pragma once

#include "change/constraining.hpp"
#include "change/deleting.hpp"
#include "change/inserting.hpp"
#include "change/label_upkeep.hpp"
#include "change/rekeying.hpp"
#include "change/workspace.hpp"
#include "mesh/stored_pages.hpp"
#include "staging/stage.hpp"

#include <abacus/build.h>
#include <abacus/mesh_header.h>

#include <span>

namespace abacus {

template <int D> class Build {
public:
    /// `stored` learns from the host which pages are stored; null if simplices have no labels and
    /// facets no markers.
    Build(const Host &host, const abacus_facts &facts, std::size_t cache_bytes,
          StoredPages *stored = nullptr)
        : work_(host, facts, cache_bytes), labels_(work_, stored), gathering_(work_),
          inserting_(work_, gathering_), deleting_(work_, gathering_, inserting_),
          rekeying_(work_, inserting_, labels_), constraining_(work_, gathering_) {}

    /// From now on logs the simplices that are created and removed.
    void log_to(SimplexChanges<D> &changes) { work_.log_to(changes); }
    /// The lines of a constrained mesh, for changes that delete points or free edges.
    void set_lines(LineSource *lines) { work_.set_lines(lines); }
    /// Until settle() labels and markers stay with the simplices of now: all changes until then
    /// count as one.
    void hold() { labels_.hold(); }
    void settle(abacus_header &header);
    std::uint64_t lost_labels() const { return labels_.lost(); }
    /// Inserts at most `limit` of the points that wait (0 = all).
    void run(std::uint64_t limit, abacus_header &header);
    /// Inserts what waits, then the points of a stage.
    void insert(Stage<D> &stage, abacus_on_duplicate on_duplicate, abacus_header &header);
    /// Inserts what waits, then removes a point for each point of a stage; with `exactly`, only one
    /// that has its id and attributes. Returns how many there were.
    std::uint64_t remove(Stage<D> &stage, bool exactly, abacus_header &header);
    /// Inserts what waits, then gives the points of the mesh the new values in a stage, which has
    /// only the attributes `which`. With `exactly` the old values of all attributes follow the new
    /// ones, and a point must have them. Returns how many records had a point in the mesh;
    /// `missing` becomes the first that had none.
    std::uint64_t update(Stage<D> &stage, std::span<const std::uint32_t> which, bool exactly,
                         abacus_header &header, abacus_named_place &missing);
    /// Removes all points, waiting ones included; returns how many there were.
    std::uint64_t clear(abacus_header &header);
    /// Gives all points other attributes: the i-th is their former attribute source[i], or has no
    /// value (no_attribute). `memory` is for sorting. No other change may follow.
    void change_attributes(std::span<const std::uint32_t> source, std::size_t memory,
                           abacus_header &header);
    /// Inserts what waits, then fixes the edges of segments. From then on the mesh is constrained.
    void fix(Segments &segments, abacus_header &header);
    /// Inserts what waits, then frees the edges of segments over which the host has no line, or
    /// says why that is impossible.
    bool unfix(Segments &segments, abacus_region_fault &fault, abacus_header &header);
    /// Makes a mesh Delaunay, but for its fixed edges, of which only these edges may fail the test.
    void restore(Segments &edges, abacus_header &header);
    /// Puts triangles into the regions that have these parts, or says why that is impossible.
    bool fill_regions(RegionParts &parts, const Regions::Report &report, abacus_region_fault &fault,
                      abacus_header &header);
    /// Takes all triangles out of these regions.
    void clear_regions(RegionParts &parts, abacus_header &header);
    /// Makes regions of seeds what they are with new fixed edges, or says why that is impossible.
    bool cut_regions(Segments &segments, RegionParts &parts, abacus_region_fault &fault,
                     abacus_header &header);
    /// Calls visit(region) for the regions on either side of segments, which are fixed.
    void regions_along(Segments &segments, const std::function<void(RegionNumber)> &visit) {
        constraining_.regions_along(segments, visit);
    }
    /// Whether there is a vertex at p, and its record unless that is null; without one, also after
    /// fix() has met a crossing.
    bool find_vertex(const Point<D> &p, std::uint64_t *record) {
        return constraining_.find_vertex(p, record);
    }
    /// Gives a mesh whose domain does not fit its points another one, with `memory` bytes for
    /// sorting; false if there is no better one.
    bool rekey(std::size_t memory, abacus_header &header);

private:
    void check_attributes(const Stage<D> &stage, std::size_t attributes) const;
    /// Runs a change, which returns how many points it has processed, and ends it.
    template <class Change> void change(abacus_header &header, Change change);
    /// The same for a change that returns whether it could be made.
    template <class Change> bool sound_change(abacus_header &header, Change change_it);

    Workspace<D> work_;
    LabelUpkeep<D> labels_;
    Gathering<D> gathering_;
    Inserting<D> inserting_;
    Deleting<D> deleting_;
    Rekeying<D> rekeying_;
    Constraining<D> constraining_;
};

} // namespace abacus
