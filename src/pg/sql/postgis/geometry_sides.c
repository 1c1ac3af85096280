/*
 * geometry_sides.c: closed lines in the plane get a vertex wherever another one touches them at a side of
 * the box around all.
 *
 * A window cuts lines at its sides. Where one reaches a side, and only by rounding no further, another one may
 * lead along the side without a vertex there. With one, they touch in vertices only.
 */
#include "postgres.h"

#include "pg/sql/postgis/geometry_rings.h"

/* A side of the box: one coordinate of its places, and the other ones of all vertices there, in order. */
typedef struct Side
{
	int			axis;
	double		bound;
	double	   *along;
	size_t		count;
} Side;

static int
compare_doubles(const void *a, const void *b)
{
	double		x = *(const double *) a;
	double		y = *(const double *) b;

	return (x > y) - (x < y);
}

static void
find_side(Side *side, const Rings *rings, int axis, bool is_lower)
{
	const double *place = rings->places;

	side->axis = axis;
	side->bound = rings->vertices > 0 ? place[axis] : 0;
	for (size_t i = 0; i < rings->vertices; i++)
		side->bound = is_lower ? Min(side->bound, place[2 * i + axis]) : Max(side->bound, place[2 * i + axis]);
	side->along = MemoryContextAllocHuge(CurrentMemoryContext, (rings->vertices + 1) * sizeof(double));
	side->count = 0;
	for (size_t i = 0; i < rings->vertices; i++)
		if (place[2 * i + axis] == side->bound)
			side->along[side->count++] = place[2 * i + 1 - axis];
	qsort(side->along, side->count, sizeof(double), compare_doubles);
}

/* The number of the first of them that is greater. */
static size_t
behind(const Side *side, double value)
{
	size_t		low = 0;
	size_t		high = side->count;

	while (low < high)
	{
		size_t		middle = low + (high - low) / 2;

		if (side->along[middle] > value)
			high = middle;
		else
			low = middle + 1;
	}
	return low;
}

/*
 * Adds to `made` what lies between two places of a ring along a side, unless `made` is NULL; returns how
 * many there are, at most.
 */
static size_t
put_between(const Side *side, const double *from, const double *to, Rings *made)
{
	double		a = from[1 - side->axis];
	double		b = to[1 - side->axis];
	size_t		first;
	size_t		last;

	if (from[side->axis] != side->bound || to[side->axis] != side->bound)
		return 0;
	first = behind(side, Min(a, b));
	last = behind(side, Max(a, b));
	for (size_t i = first; i < last && made != NULL; i++)
	{
		double		place[2];

		place[side->axis] = side->bound;
		place[1 - side->axis] = side->along[a < b ? i : first + last - 1 - i];
		rings_add_place(made, place);
	}
	return last - first;
}

/* Goes through all edges; returns how many vertices come to them along the sides. */
static size_t
put_edges(const Side *sides, const Rings *given, Rings *made)
{
	size_t		more = 0;

	for (size_t i = 0; i < given->count; i++)
	{
		const Ring *ring = &given->rings[i];

		if (made != NULL)
			rings_begin_one(made);
		for (size_t k = 0; k < ring->count; k++)
		{
			const double *from = given->places + 2 * (ring->first + k);
			const double *to = given->places + 2 * (ring->first + (k + 1) % ring->count);

			if (made != NULL)
				rings_add_place(made, from);
			for (int side = 0; side < 4; side++)
				more += put_between(&sides[side], from, to, made);
		}
		if (made != NULL)
			rings_end_one(made);
	}
	return more;
}

/* The rings with these vertices. */
Rings
rings_touching(const Rings *given)
{
	Side		sides[4];
	Rings		made;

	for (int side = 0; side < 4; side++)
		find_side(&sides[side], given, side / 2, side % 2 == 0);
	rings_begin(&made, given->count, given->vertices + put_edges(sides, given, NULL));
	put_edges(sides, given, &made);
	for (int side = 0; side < 4; side++)
		pfree(sides[side].along);
	return made;
}
