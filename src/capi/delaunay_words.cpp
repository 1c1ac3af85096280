// How a mesh is related to the Delaunay triangulation of its vertices, in words.
#include <abacus/facts.h>

const char *abacus_delaunay_clause(abacus_delaunay delaunay) {
    switch (delaunay) {
    case ABACUS_WEAKLY_DELAUNAY:
        return "the mesh is a Delaunay triangulation, but not the one that Abacus makes";
    case ABACUS_NOT_CONVEX:
        return "the mesh does not fill the convex hull of its vertices";
    case ABACUS_CONSTRAINED:
        return "the mesh is a constrained Delaunay triangulation";
    default:
        return "the mesh is not a Delaunay triangulation";
    }
}

const char *abacus_delaunay_reason(abacus_delaunay delaunay) {
    switch (delaunay) {
    case ABACUS_WEAKLY_DELAUNAY:
        return "All circumspheres are empty, but vertices on one sphere are joined in another way.";
    case ABACUS_NOT_CONVEX:
        return "It has holes, notches or several pieces.";
    case ABACUS_CONSTRAINED:
        return "It has lines, whose edges are fixed.";
    default:
        return "A vertex lies inside the circumsphere of a simplex.";
    }
}
