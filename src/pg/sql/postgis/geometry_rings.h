/*
 * geometry_rings.h: closed lines in the plane, from which polygons are made.
 */
#ifndef ABACUS_GEOMETRY_RINGS_H
#define ABACUS_GEOMETRY_RINGS_H

#define NO_RING ((size_t) -1)

typedef struct Ring
{
	size_t		first;			/* its vertices; the first is not repeated */
	size_t		count;
	size_t		least;			/* the least vertex */
	bool		is_hole;
	size_t		below;			/* the ring of the edge just below a hole's least vertex */
	size_t		next;			/* the next hole of the same outline */
	size_t		holes;			/* the first hole of an outline */
} Ring;

typedef struct Rings
{
	double	   *places;			/* x, y of all vertices */
	size_t		vertices;
	size_t	   *ring_of;		/* for each vertex */
	Ring	   *rings;
	size_t		count;
} Rings;

extern int	places_compare(const double *a, const double *b);
extern int	places_side(const double *a, const double *b, const double *c);
extern size_t *rings_order(const Rings *rings);
extern size_t ring_along(const Rings *rings, size_t vertex, size_t steps);
extern void rings_begin(Rings *rings, size_t most_rings, size_t most_vertices);
extern void rings_begin_one(Rings *rings);
extern void rings_add_place(Rings *rings, const double *place);
extern void rings_end_one(Rings *rings);
extern Rings rings_traced(const Rings *given);
extern Rings rings_touching(const Rings *given);

#endif
