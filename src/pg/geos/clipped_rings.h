/*
 * clipped_rings.h: rings of areas, cut at the border of a polygon.
 */
#ifndef ABACUS_CLIPPED_RINGS_H
#define ABACUS_CLIPPED_RINGS_H

/* Closed rings, one after the other; the last point of a ring is its first. */
typedef struct RingSet
{
	MemoryContext memory;
	size_t		rings,
				points;
	size_t		ring_room,
				point_room;
	size_t	   *sizes;			/* points of each ring */
	double	   *places;			/* x, y */
} RingSet;

extern void ring_set_begin(RingSet *set);
extern double *ring_set_add(RingSet *set, size_t points);
extern void ring_set_clear(RingSet *set);
extern void ring_set_swap(RingSet *a, RingSet *b);
extern void ring_set_end(RingSet *set);
extern void clip_rings(const RingSet *given, const char *polygon, RingSet *clipped);

#endif
