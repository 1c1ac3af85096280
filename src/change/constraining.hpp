// Edges fixed and freed, as a part of a change (build.hpp).
#pragma once

#include "change/workspace.hpp"
#include "constrain/segments.hpp"

namespace abacus {

template <int D> class Constraining {
public:
    explicit Constraining(Workspace<D> &work) : work_(work) {}

    /// Fixes the edges of all segments, of a mesh with simplices; returns how many segments there
    /// were.
    std::uint64_t fix(Segments &segments);
    /// Frees the edges of all segments over which the host has no line.
    std::uint64_t unfix(Segments &segments);
    /// Whether the mesh has a vertex at p, and its record unless that is null.
    bool find_vertex(const Point<D> &p, std::uint64_t *record);

private:
    template <class Change> std::uint64_t each(Segments &segments, Change change);

    Workspace<D> &work_;
};

extern template class Constraining<2>;
extern template class Constraining<3>;

} // namespace abacus
