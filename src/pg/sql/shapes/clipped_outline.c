/*
 * clipped_outline.c: the border of what a mesh has in a polygon.
 *
 * The border of the mesh is read whole and cut by the polygon. What a corner of the result is, a
 * vertex of the mesh or not, its place tells.
 */
#include "postgres.h"

#include "utils/memutils.h"

#include "pg/base/settings.h"
#include "pg/host/guard.h"
#include "pg/geos/clipped_rings.h"
#include "pg/sql/shapes/clipped_outline.h"

typedef struct Vertex
{
	double		place[2];
	int64		id;
} Vertex;

/* The border of the mesh, as the core reports it. */
typedef struct Border
{
	Host	   *host;
	RingSet		rings;
	Vertex	   *vertices;
	size_t		count,
				room;
	size_t		first;			/* of the ring */
	uint64		ring;
} Border;

/* Ends a ring with its first point. */
static void
end_ring(Border *border)
{
	size_t		points = border->count - border->first;
	double	   *places;

	if (points == 0)
		return;
	places = ring_set_add(&border->rings, points + 1);
	for (size_t i = 0; i <= points; i++)
		memcpy(places + 2 * i, border->vertices[border->first + i % points].place, 2 * sizeof(double));
	border->first = border->count;
}

/* Called by the core. */
static abacus_host_status
keep_row(void *context, const abacus_outline_row *row)
{
	Border	   *border = context;
	Vertex	   *vertex;

	GUARD_BEGIN();
	if (row->ring != border->ring)
		end_ring(border);
	border->ring = row->ring;
	if (border->count == border->room)
	{
		border->room += border->room / 2 + 64;
		border->vertices = border->vertices == NULL
			? MemoryContextAllocHuge(border->rings.memory, border->room * sizeof(Vertex))
			: repalloc_huge(border->vertices, border->room * sizeof(Vertex));
	}
	vertex = &border->vertices[border->count++];
	memcpy(vertex->place, row->point, sizeof(vertex->place));
	vertex->id = row->vertex;
	GUARD_END(border->host);
	return ABACUS_HOST_OK;
}

static int
compare_places(const void *a, const void *b)
{
	const double *p = a,
			   *q = b;

	if (p[0] != q[0])
		return p[0] < q[0] ? -1 : 1;
	return (p[1] > q[1]) - (p[1] < q[1]);
}

static int
compare_firsts(const void *a, const void *b)
{
	return compare_places(*(const double *const *) a, *(const double *const *) b);
}

/* Puts the rings in the order of their first points. */
static void
put_rings(const RingSet *rings, const Border *border, PutOutlineRow put, const Answers *answers)
{
	const double **firsts = palloc((rings->rings + 1) * sizeof(double *));
	abacus_outline_row row = {0};
	const double *at = rings->places;

	for (size_t i = 0; i < rings->rings; at += 2 * rings->sizes[i++])
		firsts[i] = at;
	qsort(firsts, rings->rings, sizeof(double *), compare_firsts);
	for (size_t i = 0; i < rings->rings; i++)
	{
		size_t		points = 1;

		/* its first point ends a ring */
		while (compare_places(firsts[i], firsts[i] + 2 * points) != 0)
			points++;
		row.ring = i + 1;
		for (size_t k = 0; k < points; k++)
		{
			const Vertex *vertex = bsearch(firsts[i] + 2 * k, border->vertices, border->count, sizeof(Vertex),
										   compare_places);

			row.position = k + 1;
			row.vertex = vertex == NULL ? 0 : vertex->id;
			memcpy(row.point, firsts[i] + 2 * k, 2 * sizeof(double));
			put(answers, &row, vertex != NULL);
		}
	}
	pfree(firsts);
}

/* Puts the rows of what `kind` wants of the mesh, cut at the border of its polygon. */
void
clipped_outline(Reader *reader, const abacus_outline_kind *kind, const char *polygon, PutOutlineRow put,
				const Answers *answers)
{
	Host	   *host = reader->host;
	Border		border = {.host = host};
	RingSet		clipped;
	abacus_outline_kind whole = *kind;

	ring_set_begin(&border.rings);
	ring_set_begin(&clipped);
	whole.extent.area = NULL;
	host_run(host, abacus_outline, &host->table, &reader->header.facts, &whole, setting_query_sort_bytes(),
			 setting_cache_bytes(), keep_row, &border);
	end_ring(&border);
	clip_rings(&border.rings, polygon, &clipped);
	if (border.count > 0)
		qsort(border.vertices, border.count, sizeof(Vertex), compare_places);
	put_rings(&clipped, &border, put, answers);
	ring_set_end(&border.rings);
	ring_set_end(&clipped);
}
