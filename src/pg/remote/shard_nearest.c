/*
 * shard_nearest.c: the vertices of a mesh over several servers that are nearest to places.
 *
 * Each of the nearest vertices is among the nearest ones of the shard that owns it. So all servers are
 * asked for as many as are wanted. Guests come several times; they are the same vertices. Distances are
 * compared exactly, as on one server.
 */
#include "postgres.h"

#include "catalog/pg_type.h"
#include "executor/spi.h"
#include "funcapi.h"
#include "utils/array.h"
#include "utils/builtins.h"
#include "utils/tuplestore.h"

#include "abacus/locate.h"
#include "pg/input/place.h"
#include "pg/input/source.h"
#include "pg/mesh/mesh.h"
#include "pg/remote/shard_read.h"
#include "pg/shards/generation_links.h"
#include "pg/shards/shard_sql.h"

#define MOST_PLACES 8192
/* Vertices of a server that are in memory at once. */
#define MOST_VERTICES 65536

/* Columns that servers return */
static const Oid near_columns[] = {
	INT8OID, INT8OID, FLOAT8OID, FLOAT8OID, FLOAT8OID, FLOAT8ARRAYOID, FLOAT8OID
};

enum
{
	NEAR_PLACE = 1,
	NEAR_VERTEX,
	NEAR_X,
	NEAR_ATTRIBUTES = NEAR_X + ABACUS_MAX_DIMENSION,
	NEAR_DISTANCE
};

typedef struct NearVertex
{
	int			place;
	double		point[ABACUS_MAX_DIMENSION];
	int64		vertex;
	Datum		attributes;
	double		distance;
} NearVertex;

typedef struct NearestRead
{
	Generation	generation;
	ReturnSetInfo *set;
	int32		k;
	bool		is_query;		/* the places are those of a query */
	Source		source;
	int			count;
	int			most;
	int64	   *ids;
	double	   *points;
	NearVertex *found;
	int			found_count;
	int			found_room;
} NearestRead;

/* ---- One lot of places ---------------------------------------------------------------------- */

static char *
nearest_query(const NearestRead *read, int shard)
{
	int			dimension = (int) read->generation.form.dimension;
	StringInfoData columns[1 + ABACUS_MAX_DIMENSION];

	for (int column = 0; column <= dimension; column++)
	{
		initStringInfo(&columns[column]);
		for (int i = 0; i < read->count; i++)
			appendStringInfo(&columns[column], "%c%s", i == 0 ? '{' : ',',
							 column == 0 ? psprintf("%d", i) : exact_text(read->points[i * dimension + column - 1]));
	}
	return psprintf("SELECT p.id, r.vertex, r.x, r.y, r.z, r.attributes, r.distance FROM unnest('%s}'::bigint[], "
					"'%s}'::double precision[], '%s}'::double precision[]%s) AS p (id, x, y%s) "
					"CROSS JOIN LATERAL abacus_nearest('%s'::regclass, p.x, p.y%s, %d) AS r",
					columns[0].data, columns[1].data, columns[2].data,
					dimension == 2 ? "" : psprintf(", '%s}'::double precision[]", columns[3].data),
					dimension == 2 ? "" : ", z", generation_mesh(&read->generation, shard),
					dimension == 2 ? "" : ", p.z", read->k);
}

static void
take_vertex(NearestRead *read, HeapTuple row, TupleDesc desc)
{
	NearVertex *near;

	if (read->found_count == read->found_room)
	{
		read->found_room *= 2;
		read->found = repalloc_huge(read->found, read->found_room * sizeof(NearVertex));
	}
	near = &read->found[read->found_count++];
	memset(near, 0, sizeof(*near));
	near->place = (int) DatumGetInt64(link_row_value(row, desc, NEAR_PLACE));
	if (near->place < 0 || near->place >= read->count)
		elog(ERROR, "a server returned a place that it was not asked for");
	near->vertex = DatumGetInt64(link_row_value(row, desc, NEAR_VERTEX));
	for (int i = 0; i < (int) read->generation.form.dimension; i++)
		near->point[i] = DatumGetFloat8(link_row_value(row, desc, NEAR_X + i));
	near->attributes = link_row_value(row, desc, NEAR_ATTRIBUTES);
	near->distance = DatumGetFloat8(link_row_value(row, desc, NEAR_DISTANCE));
}

/* By place, then by distance. */
static int
compare_near(const void *a, const void *b, void *context)
{
	const NearestRead *read = context;
	const NearVertex *one = a;
	const NearVertex *other = b;
	uint32		dimension = read->generation.form.dimension;
	abacus_error error;
	int			order;

	if (one->place != other->place)
		return one->place < other->place ? -1 : 1;
	if (abacus_compare_nearness(dimension, read->points + one->place * dimension, one->point, other->point, &order,
								&error) != ABACUS_OK)
		elog(ERROR, "could not compare distances: %s", error.message);
	return order;
}

static void
put_near(const NearestRead *read, const NearVertex *near, int rank)
{
	int			dimension = (int) read->generation.form.dimension;

	if (read->is_query)
	{
		Datum		values[] = {
			Int64GetDatum(read->ids[near->place]), Int64GetDatum(rank), Int64GetDatum(near->vertex),
			Float8GetDatum(near->distance)
		};
		bool		isnull[lengthof(values)] = {false};

		tuplestore_putvalues(read->set->setResult, read->set->setDesc, values, isnull);
	}
	else
	{
		Datum		values[] = {
			Int64GetDatum(near->vertex), Float8GetDatum(near->point[0]), Float8GetDatum(near->point[1]),
			Float8GetDatum(near->point[2]), near->attributes, Float8GetDatum(near->distance)
		};
		bool		isnull[lengthof(values)] = {[3] = dimension == 2};

		tuplestore_putvalues(read->set->setResult, read->set->setDesc, values, isnull);
	}
}

/* The nearest vertices of each place, each once. */
static void
put_nearest(NearestRead *read)
{
	int			rank = 0;

	qsort_arg(read->found, read->found_count, sizeof(NearVertex), compare_near, read);
	for (int i = 0; i < read->found_count; i++)
	{
		const NearVertex *near = &read->found[i];

		if (i == 0 || near[-1].place != near->place)
			rank = 0;
		else if (memcmp(near[-1].point, near->point, sizeof(near->point)) == 0)
			continue;
		if (rank++ < read->k)
			put_near(read, near, rank);
	}
}

static void
answer_places(NearestRead *read, ShardLinks *links)
{
	MemoryContext scratch = AllocSetContextCreate(CurrentMemoryContext, "Abacus places", ALLOCSET_DEFAULT_SIZES);
	MemoryContext old = MemoryContextSwitchTo(scratch);
	TupleDesc	columns = link_columns(lengthof(near_columns), near_columns, NULL);

	read->found_count = 0;
	read->found_room = 256;
	read->found = palloc(read->found_room * sizeof(NearVertex));
	for (int i = 0; i < links->count && read->count > 0; i++)
		link_send(links, i, nearest_query(read, i));
	for (int i = 0; i < links->count && read->count > 0; i++)
	{
		LinkRows   *rows = link_rows(links, i, columns);

		for (uint64 row = 0; row < rows->count; row++)
			take_vertex(read, rows->rows[row], columns);
	}
	put_nearest(read);
	MemoryContextSwitchTo(old);
	MemoryContextDelete(scratch);
	read->count = 0;
}

/* ---- abacus_nearest ------------------------------------------------------------------------- */

static void
begin_read(NearestRead *read, FunctionCallInfo fcinfo, int k, ShardLinks *links)
{
	read->set = (ReturnSetInfo *) fcinfo->resultinfo;
	read->k = (int32) place_count_argument(fcinfo, k, "vertices");
	generation_read_links(PG_GETARG_OID(0), &read->generation, links);
	read->most = Max(1, Min(MOST_PLACES, MOST_VERTICES / read->k));
	read->ids = palloc(MOST_PLACES * sizeof(int64));
	read->points = palloc(MOST_PLACES * ABACUS_MAX_DIMENSION * sizeof(double));
}

/* abacus_nearest of one place, with this many coordinates. */
Datum
shard_read_nearest(FunctionCallInfo fcinfo, int coordinates)
{
	NearestRead read = {.is_query = false};
	ShardLinks	links;

	InitMaterializedSRF(fcinfo, 0);
	SPI_connect();
	begin_read(&read, fcinfo, 1 + coordinates, &links);
	place_require_z(coordinates, &read.generation.form);
	place_arguments_finite(fcinfo, coordinates, &read.generation.form, read.points);
	read.count = 1;
	answer_places(&read, &links);
	SPI_finish();
	PG_RETURN_NULL();
}

static void
answer_query(NearestRead *read, ShardLinks *links)
{
	abacus_facts facts = {.form = read->generation.form};
	int			dimension = (int) facts.form.dimension;
	const uint64 *records;
	size_t		count;

	source_open_places(&read->source, (abacus_names) {&facts, NULL});
	while ((count = source_fetch(&read->source, &records)) > 0)
		for (size_t i = 0; i < count; i++)
		{
			const uint64 *record = records + i * (1 + dimension);

			if (read->count == read->most)
				answer_places(read, links);
			read->ids[read->count] = (int64) record[0];
			memcpy(read->points + read->count * dimension, record + 1, dimension * sizeof(double));
			read->count++;
		}
	source_close(&read->source);
	answer_places(read, links);
}

/* abacus_nearest of the places of a query. */
Datum
shard_read_nearest_places(FunctionCallInfo fcinfo)
{
	NearestRead read = {.is_query = true};
	ShardLinks	links;

	InitMaterializedSRF(fcinfo, 0);
	source_prepare(&read.source, text_to_cstring(PG_GETARG_TEXT_PP(1)));
	begin_read(&read, fcinfo, 2, &links);
	answer_query(&read, &links);
	source_finish(&read.source);
	PG_RETURN_NULL();
}
