// Points on their way out of the mesh: out of the triangulation, with the repeated points there, or
// out of those that wait. If so many points go that triangulating the others costs less, the mesh
// is built again without them (outlay.hpp, rest.hpp).
#pragma once

#include "change/inserting.hpp"
#include "change/rest.hpp"
#include "points/leaving.hpp"
#include "points/vertex_page.hpp"

namespace abacus {

template <int D> class Deleting {
public:
    Deleting(Workspace<D> &work, Gathering<D> &gathering, Inserting<D> &inserting)
        : work_(work), gathering_(gathering), inserting_(inserting) {}

    /// Removes a point for each point of a stage, of a mesh without waiting points unless it has no
    /// simplices; with `exactly`, only one that has its id and attributes. Returns how many there
    /// were.
    std::uint64_t remove(Stage<D> &stage, bool exactly);
    /// Removes all points, waiting ones included; returns how many there were.
    std::uint64_t clear();

private:
    class Outlet;

    /// Removes points that are all at one place of the triangulation. Returns how many there were.
    std::uint64_t erase(const Point<D> &p, Leaving &leaving);
    /// Removes the first point: the next one gives the vertex its id and attributes; if there is
    /// none, the vertex is removed. Returns 1.
    std::uint64_t pass_on(const Point<D> &p);
    /// Removes the vertex; if a want is given, only a vertex that it accepts. Returns whether there
    /// was one.
    std::uint64_t erase_vertex(const Point<D> &p, Leaving *want = nullptr);
    /// The other points, the neighbours of the vertex last found, span no simplex: they become
    /// waiting points.
    void collapse();
    /// Moves the repeated points to vertex pages.
    void make_repeated_wait(VertexPageWriter &pages);
    /// From now on vertices that are to be removed stay where they are, until the rest is
    /// triangulated; not in a constrained mesh, where edges would have to be fixed again.
    void put_off_removals(std::size_t memory) {
        if (work_.facts->standing != ABACUS_CONSTRAINED)
            rest_.emplace(work_.host, *work_.facts, memory);
    }
    void triangulate_rest();

    Workspace<D> &work_;
    Gathering<D> &gathering_;
    Inserting<D> &inserting_;
    std::optional<Rest<D>> rest_; ///< while removals are put off
};

extern template class Deleting<2>;
extern template class Deleting<3>;

} // namespace abacus
