/*
 * surface.h: surfaces through a mesh of dimension 3: where an attribute has a given value, and
 * where a plane cuts the mesh.
 */
#ifndef ABACUS_ABACUS_SURFACE_H
#define ABACUS_ABACUS_SURFACE_H

#include "abacus/extent.h"
#include "abacus/windows.h"

#ifdef __cplusplus
extern "C" {
#endif

/* ---- Isosurfaces ------------------------------------------------------- */

typedef struct abacus_isosurface_query
{
	uint32_t attribute;     /* its number */
	double value;           /* finite */
	int32_t carried;        /* number of the attribute that the corners carry; -1: none */
	abacus_window window;   /* only tetrahedra that meet it */
	abacus_extent extent;   /* ... and are in it */
} abacus_isosurface_query;

/*
 * A triangle of a surface, its corners counterclockwise as seen from where the values are lower,
 * the one with the least number first. A corner lies on an edge of the mesh from a vertex below the
 * value to one at or above it. Corners on one edge have the same number, the rank of the edge, from
 * 0, among all edges with a corner, by the coordinates of its ends; and their coordinates are the
 * same to the bit.
 */
typedef struct abacus_surface_triangle
{
	int64_t corner[3];
	double point[3][3];
	double value[3];        /* carried; NaN where there is none */
} abacus_surface_triangle;

/* Gets a triangle, valid during the call. May fail as a host function may. */
typedef abacus_host_status (*abacus_surface_report)(void *context,
													const abacus_surface_triangle *triangle);

/*
 * Reports the triangles of the surface. Tetrahedra with a corner without a finite value have none.
 * Corners are numbered within `memory` bytes and spools.
 */
ABACUS_API abacus_status abacus_isosurface(const abacus_host *host, const abacus_facts *facts,
										   const abacus_isosurface_query *query, size_t memory,
										   abacus_surface_report report, void *context,
										   abacus_error *error);

/* ---- Sections ------------------------------------------------------------ */

typedef struct abacus_section_query
{
	double through[3];      /* a point of the plane, finite */
	double normal[3];       /* finite, not zero, of any length */
	int32_t attribute;      /* number of the attribute that the corners carry; -1: none */
	abacus_extent extent;   /* tetrahedra outside of it are left out */
} abacus_section_query;

/* The section of one tetrahedron: a triangle or a quadrilateral. */
typedef struct abacus_polygon
{
	uint64_t code;          /* locational code of the tetrahedron's key */
	int32_t corners;        /* 3 or 4 */
	double point[4][3];     /* counterclockwise as seen from where the normal points; the
							   lexicographically least one first */
	double value[4];        /* NaN where there is none */
} abacus_polygon;

/*
 * The section of a mesh by a plane, tetrahedron by tetrahedron, in the order in which pages are found.
 * The side of the plane on which a vertex lies is decided exactly; a vertex in the plane counts as
 * above it. Sections that are only an edge or a point are left out. A facet in the plane is the
 * section of the tetrahedron below it; at the bottom of the mesh, where there is none, it is that
 * of the ghost.
 */
typedef struct abacus_sections abacus_sections;
ABACUS_API abacus_status abacus_sections_open(const abacus_host *host, const abacus_facts *facts,
											  const abacus_section_query *query,
											  abacus_sections **sections, abacus_error *error);
ABACUS_API abacus_status abacus_sections_next(abacus_sections *sections, abacus_polygon *polygon,
											  abacus_error *error);
/*
 * The labels of the tetrahedron of the last polygon, for a ghost those of the one behind it: as
 * many as the header names, NaN where it has none; valid until the next call.
 */
ABACUS_API abacus_status abacus_sections_labels(abacus_sections *sections, const double **labels,
												abacus_error *error);
ABACUS_API void abacus_sections_close(abacus_sections *sections);

#ifdef __cplusplus
}
#endif

#endif
