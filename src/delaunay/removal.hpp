// Removal takes a vertex out of the mesh. What is left is the Delaunay triangulation of
// the other points, as if this one had never been inserted. (The dissertation adds
// points only.)
//
// The vertex's star is removed and the hole is filled again: star.hpp, hole.hpp; in a constrained
// mesh, refill.hpp.
#pragma once

#include "attributes/attribute_pages.hpp"
#include "delaunay/hole.hpp"
#include "delaunay/refill.hpp"
#include "points/leaving.hpp"

#include <optional>
#include <span>
#include <type_traits>
#include <utility>

namespace abacus {

enum class Removed {
    no_such_vertex,
    removed,
    collapses, // the points left would span no simplex: nothing has been changed
};

template <int D> class Removal {
public:
    /// `attributes`: where those of vertices are, unless the cache has them.
    explicit Removal(Delaunay<D> &mesh, AttributePages<D> *attributes = nullptr)
        : mesh_(mesh), cache_(mesh.cache()), attributes_(attributes), star_(mesh), hole_(mesh),
          refill_(mesh) {}

    /// The lines of a constrained mesh, which decide what can be removed.
    void set_lines(LineSource *lines) { lines_ = lines; }

    /// Removes the vertex with exactly these coordinates (-0.0 equals 0.0); if a want is given,
    /// only a vertex that it accepts.
    Removed remove(const Point<D> &p, Leaving *want = nullptr);
    /// The same in a cache that keeps within an interval (interval.hpp). Returns whether there was
    /// such a vertex; returns nothing, and has changed nothing, if it is put off. This happens if a
    /// page of another interval would be needed, or a new simplex might belong to another interval,
    /// or the points left would span no simplex.
    std::optional<bool> remove_within(const Point<D> &p, Leaving &want);
    /// Whether there is a vertex that it would remove.
    bool finds(const Point<D> &p, Leaving *want = nullptr);
    /// The cost of removals since the last call, in simplices made and destroyed (outlay.hpp).
    std::uint64_t take_effort() { return std::exchange(effort_, 0); }
    /// Offers the vertex there as the first point that may leave. Returns whether the
    /// others make a difference; nothing if there is no vertex.
    std::optional<bool> offer(const Point<D> &p, Leaving &leaving);
    /// Gives the vertex there another id and, unless they are apart, other attributes (null if
    /// there are none). Returns false if there is no vertex.
    bool rename(const Point<D> &p, std::int64_t id, const double *attributes);
    /// The id of the vertex there; nothing if there is none. `attributes` become its own: there is
    /// room for all, or for none.
    std::optional<std::int64_t> id_at(const Point<D> &p, std::span<double> attributes = {});
    /// Gives the vertex there, whose attributes are not apart, other values of the attributes
    /// `which`. Returns false if there is no vertex.
    bool set_attributes(const Point<D> &p, std::span<const std::uint32_t> which,
                        const double *values);

    /// Calls visit(vertex index) for each neighbour of the vertex that remove() has found,
    /// until the next operation. After `collapses` these are all vertices but that one.
    template <class Visit> void each_neighbour(Visit visit) const {
        for (const VertexIndex v : star_.link())
            if (v != infinite_vertex) visit(v);
    }

private:
    /// A simplex with a vertex at p and the number of that corner, as a link; `nowhere` if there is
    /// none.
    Link find(const Point<D> &p);
    /// The same; if a want is given, only for a vertex that it accepts.
    Link find(const Point<D> &p, Leaving *want);
    VertexIndex vertex_of(Link corner) const {
        return cache_.simplex(link_simplex(corner)).vertex[link_facet(corner)];
    }
    /// Collects the star of the vertex that find() finds; false if there is none.
    bool find_star(const Point<D> &p, Leaving *want);
    bool collapses() const;
    /// In a constrained mesh: how many edges of the star's vertex are fixed.
    std::size_t fixed_edges();
    /// Throws an Error (state) if lines keep the star's vertex.
    void require_removable();
    /// Whether all simplices in the hole will belong to the cache's interval.
    bool stays_within() const;
    /// Writes id and attributes of the vertex wherever it is stored.
    void rewrite(Link corner, std::int64_t id, const double *attributes);
    /// Removes the vertex of the star.
    void take_out();
    std::uint64_t fill_hole();
    /// The attributes of a vertex, valid until the next call; null if they are apart, unless they
    /// are compared.
    const double *attributes_of(VertexIndex v, bool are_compared);

    Delaunay<D> &mesh_;
    Cache<D> &cache_;
    AttributePages<D> *const attributes_;
    std::array<double, ABACUS_MAX_ATTRIBUTES> values_; // of a vertex
    Star<D> star_;
    Hole<D> hole_;
    struct NoRefill {
        explicit NoRefill(Delaunay<D> &) {}
    };
    std::conditional_t<D == 2, Refill, NoRefill> refill_; // of holes of a constrained mesh
    LineSource *lines_ = nullptr;
    std::uint64_t effort_ = 0;
};

} // namespace abacus
