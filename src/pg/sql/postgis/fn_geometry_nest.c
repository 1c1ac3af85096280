/*
 * fn_geometry_nest.c: makes polygons from rings, for outlines and bands of the extension
 * abacus_postgis.
 *
 * The rings are closed lines that do not cross, though they may touch in vertices. They run
 * counterclockwise around the inside, clockwise around holes. A sweep in the lexicographic order of
 * all vertices finds the outline of each hole. It keeps the edges that the sweep line meets, from
 * bottom to top, and compares them by exact predicates. The region beside a hole's least vertex,
 * below the lower one of its two edges there, is inside the hole's outline. So the next edge below
 * belongs to that outline, or to another hole in it whose least vertex came before.
 *
 * The edges are an array. Adding or removing an edge moves those above it, and a line meets few of
 * all edges. A vertical edge counts as going right, from its lower end, in line with the order.
 */
#include "postgres.h"

#include "miscadmin.h"

#include "pg/base/sql_function.h"
#include "pg/postgis/geometry_errors.h"
#include "pg/postgis/geometry_write.h"
#include "pg/sql/postgis/geometry_place.h"
#include "pg/sql/postgis/geometry_rings.h"

SQL_FUNCTION(abacus_sql_geometry_nest);

/* An edge; the lesser end comes first. */
typedef struct Edge
{
	const double *from;
	const double *to;
	size_t		ring;
} Edge;

typedef struct Nesting
{
	Rings		rings;
	Edge	   *edges;			/* the edges that the sweep line meets, from bottom to top */
	size_t		met;
	size_t		room;
} Nesting;

/* Which of two edges that a sweep line meets is the lower one. */
static int
compare_edges(const Edge *a, const Edge *b)
{
	int			sign;

	if (places_compare(a->from, b->from) <= 0)
	{
		sign = -places_side(a->from, a->to, b->from);
		if (sign == 0)
			sign = -places_side(a->from, a->to, b->to);
	}
	else
	{
		sign = places_side(b->from, b->to, a->from);
		if (sign == 0)
			sign = places_side(b->from, b->to, a->to);
	}
	return sign != 0 ? sign : (a->ring > b->ring) - (a->ring < b->ring);
}

/* Returns how many edges are below this one. */
static size_t
edges_below(const Nesting *nesting, const Edge *edge)
{
	size_t		least = 0;
	size_t		end = nesting->met;

	while (least < end)
	{
		size_t		middle = least + (end - least) / 2;

		if (compare_edges(&nesting->edges[middle], edge) < 0)
			least = middle + 1;
		else
			end = middle;
	}
	return least;
}

static void
add_edge(Nesting *nesting, const Edge *edge)
{
	size_t		at = edges_below(nesting, edge);

	if (nesting->met == nesting->room)
	{
		nesting->room *= 2;
		nesting->edges = repalloc_huge(nesting->edges, nesting->room * sizeof(Edge));
	}
	memmove(nesting->edges + at + 1, nesting->edges + at, (nesting->met - at) * sizeof(Edge));
	nesting->edges[at] = *edge;
	nesting->met++;
}

static bool
is_edge(const Nesting *nesting, size_t at, const Edge *edge)
{
	return at < nesting->met && nesting->edges[at].from == edge->from && nesting->edges[at].to == edge->to;
}

static void
remove_edge(Nesting *nesting, const Edge *edge)
{
	size_t		at = edges_below(nesting, edge);

	/* if rounded lines cross after all, the edge may be elsewhere */
	if (!is_edge(nesting, at, edge))
		for (at = 0; at < nesting->met && !is_edge(nesting, at, edge); at++)
			;
	if (at == nesting->met)
		return;
	nesting->met--;
	memmove(nesting->edges + at, nesting->edges + at + 1, (nesting->met - at) * sizeof(Edge));
}

/* The edge from a vertex to the next one of its ring, or the one to the vertex. */
static Edge
edge_at(const Nesting *nesting, size_t vertex, bool outgoing)
{
	size_t		ring = nesting->rings.ring_of[vertex];
	size_t		other = ring_along(&nesting->rings, vertex, outgoing ? 1 : nesting->rings.rings[ring].count - 1);
	const double *a = nesting->rings.places + 2 * vertex;
	const double *b = nesting->rings.places + 2 * other;

	return places_compare(a, b) < 0 ? (Edge) {a, b, ring} : (Edge) {b, a, ring};
}

/* Adds the edges that begin at a vertex, or removes those that end there. */
static void
pass_vertex(Nesting *nesting, size_t vertex, bool begins)
{
	const double *place = nesting->rings.places + 2 * vertex;

	for (int i = 0; i < 2; i++)
	{
		Edge		edge = edge_at(nesting, vertex, i == 0);

		if (begins && edge.from == place)
			add_edge(nesting, &edge);
		else if (!begins && edge.to == place)
			remove_edge(nesting, &edge);
	}
}

/* Finds the ring below a hole, at its least vertex, whose edges have been added. */
static void
look_below(Nesting *nesting, size_t vertex)
{
	Ring	   *ring = &nesting->rings.rings[nesting->rings.ring_of[vertex]];
	Edge		a = edge_at(nesting, vertex, true);
	Edge		b = edge_at(nesting, vertex, false);
	size_t		at = edges_below(nesting, compare_edges(&a, &b) < 0 ? &a : &b);

	ring->below = at == 0 ? NO_RING : nesting->edges[at - 1].ring;
}

/* Finds the ring below each hole. */
static void
sweep(Nesting *nesting)
{
	size_t	   *order = rings_order(&nesting->rings);
	size_t		end;

	for (size_t begin = 0; begin < nesting->rings.vertices; begin = end)
	{
		CHECK_FOR_INTERRUPTS();
		/* all vertices at one place */
		for (end = begin + 1; end < nesting->rings.vertices &&
			 places_compare(nesting->rings.places + 2 * order[begin], nesting->rings.places + 2 * order[end]) == 0; end++)
			;
		for (size_t i = begin; i < end; i++)
			pass_vertex(nesting, order[i], false);
		for (size_t i = begin; i < end; i++)
			pass_vertex(nesting, order[i], true);
		for (size_t i = begin; i < end; i++)
		{
			const Ring *ring = &nesting->rings.rings[nesting->rings.ring_of[order[i]]];

			if (ring->is_hole && ring->least == order[i])
				look_below(nesting, order[i]);
		}
	}
}

/* Reads the rings, without the repeated last place of each. */
static void
read_rings(Rings *rings, GeometryBytes *bytes)
{
	size_t		most = (size_t) (bytes->end - bytes->at) / (2 * sizeof(double));
	uint32		count = geometry_count(bytes);

	rings_begin(rings, count, most);
	for (uint32 i = 0; i < count; i++)
	{
		GeometryHead head = geometry_head(bytes);
		uint32		places;

		if (head.kind != GEOMETRY_LINE || head.has_z || head.has_m)
			geometry_refuse_kind("a ring", head.kind, "a LineString in the plane");
		places = geometry_count(bytes);
		rings_begin_one(rings);
		for (uint32 j = 0; j < places; j++)
		{
			double		place[2];

			place[0] = geometry_number(bytes);
			place[1] = geometry_number(bytes);
			if (j + 1 < places)
				rings_add_place(rings, place);
		}
		rings_end_one(rings);
	}
}

/* The outline that surrounds a hole. */
static size_t
outline_of(const Nesting *nesting, size_t hole)
{
	size_t		ring = hole;

	for (size_t steps = 0; nesting->rings.rings[ring].is_hole; steps++)
	{
		ring = nesting->rings.rings[ring].below;
		if (steps == nesting->rings.count || ring == NO_RING)
			ereport(ERROR,
					(errcode(ERRCODE_INVALID_PARAMETER_VALUE),
					 errmsg("a hole does not lie in an outline"),
					 errhint("Give rings that do not cross and that run counterclockwise around what is inside.")));
	}
	return ring;
}

/* Gives each hole to its outline, the last hole first; returns the number of outlines. */
static size_t
share_holes(Nesting *nesting)
{
	size_t		outlines = 0;

	for (size_t i = nesting->rings.count; i-- > 0;)
	{
		Ring	   *hole = &nesting->rings.rings[i];
		size_t		outline;

		outlines += !hole->is_hole;
		if (!hole->is_hole)
			continue;
		outline = outline_of(nesting, i);
		/* shortens the way for later holes */
		for (size_t at = i; nesting->rings.rings[at].is_hole;)
		{
			size_t		next = nesting->rings.rings[at].below;

			nesting->rings.rings[at].below = outline;
			at = next;
		}
		hole->next = nesting->rings.rings[outline].holes;
		nesting->rings.rings[outline].holes = i;
	}
	return outlines;
}

static void
put_ring(const Nesting *nesting, const Ring *ring, StringInfo bytes)
{
	geometry_put_count(bytes, ring->count + 1);
	geometry_put_numbers(bytes, nesting->rings.places + 2 * ring->first, 2 * ring->count);
	geometry_put_numbers(bytes, nesting->rings.places + 2 * ring->first, 2);
}

static void
put_polygon(const Nesting *nesting, const Ring *outline, int32 srid, StringInfo bytes)
{
	GeometryHead head = {GEOMETRY_POLYGON, srid};
	size_t		rings = 1;

	for (size_t i = outline->holes; i != NO_RING; i = nesting->rings.rings[i].next)
		rings++;
	geometry_put_head(bytes, &head);
	geometry_put_count(bytes, rings);
	put_ring(nesting, outline, bytes);
	for (size_t i = outline->holes; i != NO_RING; i = nesting->rings.rings[i].next)
		put_ring(nesting, &nesting->rings.rings[i], bytes);
}

/*
 * _abacus_nest(rings geometry) -> geometry: turns a MultiLineString into a Polygon, or, with
 * several outlines, a MultiPolygon
 */
Datum
abacus_sql_geometry_nest(PG_FUNCTION_ARGS)
{
	const GeometryType *type = geometry_argument_type(fcinfo, 0);
	GeometryBytes bytes = geometry_bytes(type, PG_GETARG_DATUM(0));
	GeometryHead head = geometry_head(&bytes);
	GeometryHead several = {GEOMETRY_MULTIPOLYGON, head.srid};
	Nesting		nesting = {.room = 64};
	Rings		given;
	StringInfoData made;
	size_t		outlines;

	if (head.kind != GEOMETRY_MULTILINE)
		geometry_refuse_kind("the geometry", head.kind, "a MultiLineString");
	read_rings(&given, &bytes);
	given = rings_touching(&given);
	nesting.rings = rings_traced(&given);
	nesting.edges = palloc(nesting.room * sizeof(Edge));
	sweep(&nesting);
	outlines = share_holes(&nesting);
	initStringInfo(&made);
	if (outlines != 1)
	{
		geometry_put_head(&made, &several);
		geometry_put_count(&made, outlines);
	}
	for (size_t i = 0; i < nesting.rings.count; i++)
		if (!nesting.rings.rings[i].is_hole)
			put_polygon(&nesting, &nesting.rings.rings[i], outlines == 1 ? head.srid : 0, &made);
	PG_RETURN_DATUM(geometry_made(type, &made));
}
