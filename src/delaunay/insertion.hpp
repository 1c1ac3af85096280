// Incremental insertion: the search for a point's cavity starts at a simplex in conflict with the
// point; then the cavity is filled (cavity.hpp). Every decision is an exact predicate under
// symbolic perturbation, so the mesh after each insertion is the unique perturbed Delaunay
// triangulation of the points so far, whatever their order.
#pragma once

#include "delaunay/cavity.hpp"

namespace abacus {

/// What has become of a point.
enum class Inserted { as_vertex, is_vertex, put_off };

template <int D> class Insertion {
public:
    explicit Insertion(Delaunay<D> &mesh);

    /// The first simplex of an empty mesh, on affinely independent points, with its
    /// ghosts.
    void start(const std::array<VertexIndex, D + 1> &vertices);

    /// Inserts p. Returns false if the mesh has a vertex there already.
    bool insert(const Point<D> &p, std::int64_t id, const double *attributes) {
        return insert(p, cache_.domain().code(p), id, attributes);
    }
    /// With p's code, if it is known already.
    bool insert(const Point<D> &p, std::uint64_t code, std::int64_t id, const double *attributes);

    /// The same in a cache that keeps within an interval: p is put off, and nothing has changed, if
    /// a page of another interval would be needed.
    Inserted insert_within(const Point<D> &p, std::uint64_t code, std::int64_t id,
                           const double *attributes);

private:
    /// A simplex of p's cavity, or no_handle if p is a vertex.
    Handle find_conflict(const Point<D> &p, std::uint64_t code);
    /// ... the one that contains p, or a ghost beyond whose facet p lies.
    Handle find_containing(const Point<D> &p, std::uint64_t code);
    /// Finds p's cavity; false if p is a vertex.
    bool find_cavity(const Point<D> &p, std::uint64_t code);
    void fill_cavity(const Point<D> &p, std::uint64_t code, std::int64_t id,
                     const double *attributes);

    Delaunay<D> &mesh_;
    Cache<D> &cache_;
    Cavity<D> cavity_;
};

} // namespace abacus
