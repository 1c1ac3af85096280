// Makes a mesh in the plane Delaunay again, but for its fixed edges, from edges that may fail: one
// that fails the in-circle test is flipped, and those around it are tested, until none fails
// (Lawson 1977). Under the symbolic perturbation each flip makes the lifted surface lower, so this
// ends, and there is only one result.
#pragma once

#include "delaunay/delaunay.hpp"
#include "traverse/straight.hpp"

namespace abacus {

class Restoring {
public:
    explicit Restoring(Delaunay<2> &mesh)
        : mesh_(mesh), cache_(mesh.cache()), to_test_(cache_.host()) {}

    /// An edge that may fail, by one of its sides.
    void add(Link side);
    /// Tests these edges, and those that come of it.
    void run();
    /// Tests the edge between two vertices, if the mesh still has it, and those that come of it.
    void restore(const Point<2> &a, const Point<2> &b);

private:
    /// Its simplex may have gone since, and its slot may be used again.
    struct Edge {
        Link side;
        VertexIndex a, b;
    };

    bool must_flip(const Edge &edge);
    void flip(Link side);

    Delaunay<2> &mesh_;
    Cache<2> &cache_;
    Arena<Edge> to_test_;
};

} // namespace abacus
