/*
 * geometry_rings.c: retraces closed lines in the plane so that polygons can be made from them.
 *
 * The lines go around regions, which are on their left. They may touch in vertices. If a band ends
 * at an edge whose ends are both exactly at a level, they run along this edge in both directions
 * with nothing in between. Such pairs of edges are removed. The other edges are followed again, at
 * each vertex to the next edge clockwise from where the line came from, so that it stays with one
 * region. A line that comes through a vertex again is cut there. So each region gets one outline,
 * and holes that touch it or one another only in vertices, which PostGIS accepts as valid.
 */
#include "postgres.h"

#include "miscadmin.h"

#include "abacus/shapes.h"
#include "pg/sql/postgis/geometry_rings.h"

int
places_compare(const double *a, const double *b)
{
	if (a[0] != b[0])
		return a[0] < b[0] ? -1 : 1;
	return (a[1] > b[1]) - (a[1] < b[1]);
}

/* The side of the line from a to b on which c lies: 1 left, -1 right. */
int
places_side(const double *a, const double *b, const double *c)
{
	abacus_error error;
	int			sign = 0;

	if (abacus_orientation(a, b, c, &sign, &error) != ABACUS_OK)
		ereport(ERROR,
				(errcode(ERRCODE_INTERNAL_ERROR), errmsg_internal("%s", error.message)));
	return sign;
}

static void *
huge(size_t count, size_t size)
{
	return MemoryContextAllocHuge(CurrentMemoryContext, (count + 1) * size);
}

static int
compare_vertices(const void *a, const void *b, void *places)
{
	return places_compare((double *) places + 2 * *(const size_t *) a,
						  (double *) places + 2 * *(const size_t *) b);
}

/* All vertices in lexicographic order. */
size_t *
rings_order(const Rings *rings)
{
	size_t	   *order = huge(rings->vertices, sizeof(size_t));

	for (size_t i = 0; i < rings->vertices; i++)
		order[i] = i;
	qsort_arg(order, rings->vertices, sizeof(size_t), compare_vertices, rings->places);
	return order;
}

/* The vertex this many steps further along its ring. */
size_t
ring_along(const Rings *rings, size_t vertex, size_t steps)
{
	const Ring *ring = &rings->rings[rings->ring_of[vertex]];

	return ring->first + (vertex - ring->first + steps) % ring->count;
}

/* ---- Making ---------------------------------------------------------------- */

void
rings_begin(Rings *rings, size_t most_rings, size_t most_vertices)
{
	rings->rings = huge(most_rings, sizeof(Ring));
	rings->places = huge(most_vertices, 2 * sizeof(double));
	rings->ring_of = huge(most_vertices, sizeof(size_t));
	rings->count = rings->vertices = 0;
}

void
rings_begin_one(Rings *rings)
{
	rings->rings[rings->count] = (Ring) {.first = rings->vertices, .least = rings->vertices,
										 .below = NO_RING, .next = NO_RING, .holes = NO_RING};
}

/* Adds a place to the ring, unless it is equal to the one before. */
void
rings_add_place(Rings *rings, const double *place)
{
	Ring	   *ring = &rings->rings[rings->count];
	double	   *to = rings->places + 2 * rings->vertices;

	if (ring->count > 0 && places_compare(to - 2, place) == 0)
		return;
	memcpy(to, place, 2 * sizeof(double));
	if (places_compare(place, rings->places + 2 * ring->least) < 0)
		ring->least = rings->vertices;
	rings->ring_of[rings->vertices++] = rings->count;
	ring->count++;
}

/* Keeps the ring if it may have an area. */
void
rings_end_one(Rings *rings)
{
	Ring	   *ring = &rings->rings[rings->count];

	while (ring->count > 1 && places_compare(rings->places + 2 * ring->first,
											 rings->places + 2 * (rings->vertices - 1)) == 0)
	{
		rings->vertices--;
		ring->count--;
	}
	if (ring->count < 3)
	{
		rings->vertices = ring->first;
		return;
	}
	ring->is_hole = places_side(rings->places + 2 * ring_along(rings, ring->least, ring->count - 1),
								rings->places + 2 * ring->least,
								rings->places + 2 * ring_along(rings, ring->least, 1)) < 0;
	rings->count++;
}

/* ---- Tracing --------------------------------------------------------------- */

/* An edge has the number of its first vertex: it leads to the next one of the ring. */
typedef struct Trace
{
	const Rings *given;
	size_t	   *from;			/* for each edge: numbers of places */
	size_t	   *to;
	const double **place;		/* by their numbers */
	size_t		places;
	bool	   *gone;			/* for each edge: it was followed or removed */
	size_t	   *first;			/* for each place: where its edges begin in the list */
	size_t	   *list;			/* edges by the place where they begin */
} Trace;

/* Numbers the places; equal places get one number. */
static void
number_places(Trace *trace)
{
	const Rings *given = trace->given;
	size_t	   *order = rings_order(given);

	trace->from = huge(given->vertices, sizeof(size_t));
	trace->to = huge(given->vertices, sizeof(size_t));
	trace->place = huge(given->vertices, sizeof(double *));
	for (size_t i = 0; i < given->vertices; i++)
	{
		const double *place = given->places + 2 * order[i];

		if (i == 0 || places_compare(trace->place[trace->places - 1], place) != 0)
			trace->place[trace->places++] = place;
		trace->from[order[i]] = trace->places - 1;
	}
	for (size_t i = 0; i < given->vertices; i++)
		trace->to[i] = trace->from[ring_along(given, i, 1)];
	pfree(order);
}

static int
compare_edges(const void *a, const void *b, void *context)
{
	const Trace *trace = context;
	size_t		x = *(const size_t *) a;
	size_t		y = *(const size_t *) b;
	size_t		x_least = Min(trace->from[x], trace->to[x]);
	size_t		y_least = Min(trace->from[y], trace->to[y]);
	size_t		x_greatest = Max(trace->from[x], trace->to[x]);
	size_t		y_greatest = Max(trace->from[y], trace->to[y]);

	if (x_least != y_least)
		return x_least < y_least ? -1 : 1;
	return (x_greatest > y_greatest) - (x_greatest < y_greatest);
}

/* Removes pairs of edges that run back and forth. */
static void
cancel_pairs(Trace *trace)
{
	size_t		edges = trace->given->vertices;
	size_t	   *order = huge(edges, sizeof(size_t));
	size_t		end;

	trace->gone = huge(edges, sizeof(bool));
	memset(trace->gone, 0, edges);
	for (size_t i = 0; i < edges; i++)
		order[i] = i;
	qsort_arg(order, edges, sizeof(size_t), compare_edges, trace);
	for (size_t begin = 0; begin < edges; begin = end)
	{
		for (end = begin + 1; end < edges && compare_edges(&order[begin], &order[end], trace) == 0; end++)
			;
		for (size_t i = begin; i < end; i++)
			for (size_t j = i + 1; j < end && !trace->gone[order[i]]; j++)
				if (!trace->gone[order[j]] && trace->from[order[i]] == trace->to[order[j]])
					trace->gone[order[i]] = trace->gone[order[j]] = true;
	}
	pfree(order);
}

static void
list_edges(Trace *trace)
{
	size_t		edges = trace->given->vertices;

	trace->first = huge(trace->places + 1, sizeof(size_t));
	trace->list = huge(edges, sizeof(size_t));
	memset(trace->first, 0, (trace->places + 2) * sizeof(size_t));
	for (size_t i = 0; i < edges; i++)
		if (!trace->gone[i])
			trace->first[trace->from[i] + 1]++;
	for (size_t i = 0; i < trace->places; i++)
		trace->first[i + 1] += trace->first[i];
	for (size_t i = edges; i-- > 0;)
		if (!trace->gone[i])
			trace->list[--trace->first[trace->from[i] + 1]] = i;
	/* each list begins where that of the place before ends */
	memmove(trace->first, trace->first + 1, trace->places * sizeof(size_t));
	trace->first[trace->places] = edges;
	for (size_t i = 0; i < edges; i++)
		trace->first[trace->places] -= trace->gone[i];
}

/* The quarter, counterclockwise from the way back, in which a way from a place lies. */
static int
turn_of(const double *place, const double *back, const double *way)
{
	int			side = places_side(place, back, way);

	if (side != 0)
		return side > 0 ? 1 : 3;
	/* on the line: forwards or back */
	return (places_compare(back, place) < 0) == (places_compare(way, place) < 0) ? 0 : 2;
}

/* The next edge clockwise from where this one came; NO_RING if there is none. */
static size_t
next_edge(const Trace *trace, size_t edge)
{
	size_t		at = trace->to[edge];
	const double *place = trace->place[at];
	const double *back = trace->place[trace->from[edge]];
	size_t		best = NO_RING;
	int			best_turn = 0;

	for (size_t i = trace->first[at]; i < trace->first[at + 1]; i++)
	{
		size_t		candidate = trace->list[i];
		const double *way = trace->place[trace->to[candidate]];
		int			turn;

		if (trace->gone[candidate])
			continue;
		if (trace->first[at + 1] - trace->first[at] == 1)
			return candidate;
		turn = turn_of(place, back, way);
		if (best == NO_RING || turn > best_turn ||
			(turn == best_turn && places_side(place, trace->place[trace->to[best]], way) > 0))
		{
			best = candidate;
			best_turn = turn;
		}
	}
	return best;
}

/* Adds a part of a line as a ring. */
static void
add_ring(Rings *made, const Trace *trace, const size_t *places, size_t count)
{
	rings_begin_one(made);
	for (size_t i = 0; i < count; i++)
		rings_add_place(made, trace->place[places[i]]);
	rings_end_one(made);
}

/* Follows a line to its beginning, and cuts it where it comes through a place again. */
static void
follow(Trace *trace, size_t begin, Rings *made, size_t *open, size_t *place_in_open)
{
	size_t		count = 0;
	size_t		edge = begin;

	while (edge != NO_RING)
	{
		size_t		at = trace->from[edge];

		if (place_in_open[at] != NO_RING)
		{
			size_t		cut = place_in_open[at];

			add_ring(made, trace, open + cut, count - cut);
			for (; count > cut; count--)
				place_in_open[open[count - 1]] = NO_RING;
		}
		place_in_open[at] = count;
		open[count++] = at;
		if (edge != begin)
			trace->gone[edge] = true;
		edge = next_edge(trace, edge);
		if (edge == begin)
			break;
	}
	trace->gone[begin] = true;
	add_ring(made, trace, open, count);
	for (; count > 0; count--)
		place_in_open[open[count - 1]] = NO_RING;
}

/* The retraced rings. */
Rings
rings_traced(const Rings *given)
{
	Trace		trace = {.given = given};
	Rings		made;
	size_t	   *open;
	size_t	   *place_in_open;

	number_places(&trace);
	cancel_pairs(&trace);
	list_edges(&trace);
	rings_begin(&made, given->vertices / 3, given->vertices);
	open = huge(given->vertices, sizeof(size_t));
	place_in_open = huge(trace.places, sizeof(size_t));
	memset(place_in_open, 0xff, trace.places * sizeof(size_t));
	for (size_t i = 0; i < given->vertices; i++)
	{
		CHECK_FOR_INTERRUPTS();
		if (!trace.gone[i])
			follow(&trace, i, &made, open, place_in_open);
	}
	return made;
}
