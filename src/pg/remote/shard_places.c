/*
 * shard_places.c: questions to a mesh over several servers about places: the same functions, called on the
 * servers.
 *
 * A shard can answer for a place if each simplex around it there has a corner that the shard
 * owns: then these are all simplices of the whole mesh around that place, and the answer is that of one
 * server. First each place is sent to the shard that owns its code. What that one cannot answer goes to
 * all others: the owner of a corner of the simplex around the place can. If none can, the place is
 * outside. Places are dealt with some thousand at a time, which bounds the memory.
 */
#include "postgres.h"

#include "executor/spi.h"
#include "funcapi.h"
#include "utils/builtins.h"
#include "utils/tuplestore.h"

#include "pg/input/source.h"
#include "pg/remote/shard_call.h"
#include "pg/remote/shard_read.h"
#include "pg/shards/generation_links.h"
#include "pg/shards/shard_sql.h"

/* ---- Places --------------------------------------------------------------------------------- */

#define PLACES_AT_ONCE 8192
#define NOT_SETTLED (-1)

/* Some places, and what becomes of them. */
typedef struct PlacesAsked
{
	FunctionCallInfo fcinfo;
	Generation	generation;
	TupleDesc	columns;		/* of the rows that servers return */
	int			count;
	int64	   *ids;
	double	   *points;
	int		   *owners;
	int		   *settled;		/* which shard has answered */
	StringInfoData *asked;		/* for each shard: numbers, */
	StringInfoData *asked_points;	/* and coordinates of the places that it is asked for */
	void		(*put_outside) (struct PlacesAsked *asked, int place);
	ReturnSetInfo *set;
} PlacesAsked;

static void
begin_places(PlacesAsked *asked)
{
	int			shards = asked->generation.shards;

	asked->asked = palloc(shards * sizeof(StringInfoData));
	asked->asked_points = palloc(shards * sizeof(StringInfoData));
	for (int i = 0; i < shards; i++)
	{
		initStringInfo(&asked->asked[i]);
		initStringInfo(&asked->asked_points[i]);
	}
	asked->ids = palloc(PLACES_AT_ONCE * sizeof(int64));
	asked->points = palloc(PLACES_AT_ONCE * ABACUS_MAX_DIMENSION * sizeof(double));
	asked->owners = palloc(PLACES_AT_ONCE * sizeof(int));
	asked->settled = palloc(PLACES_AT_ONCE * sizeof(int));
	asked->count = 0;
}

static void
ask_for(PlacesAsked *asked, int shard, int place)
{
	int			dimension = (int) asked->generation.form.dimension;
	StringInfo	numbers = &asked->asked[shard];
	StringInfo	points = &asked->asked_points[shard];

	appendStringInfo(numbers, "%c%d", numbers->len == 0 ? '{' : ',', place);
	for (int i = 0; i < dimension; i++)
	{
		char	   *text = exact_text(asked->points[place * dimension + i]);

		appendStringInfo(points, "%c%s", points->len == 0 ? '{' : ',', text);
		pfree(text);
	}
}

/* The query for the places that a shard is asked for. */
static char *
places_query(PlacesAsked *asked, int shard)
{
	const Generation *generation = &asked->generation;
	int			dimension = (int) generation->form.dimension;
	char	   *mesh = generation_mesh(generation, shard);
	char	   *settled = psprintf("abacus_shard_settled('%s', %s, '%s}'::bigint[], '%s}'::double precision[])", mesh,
								   shard_sql_stretch(generation, shard), asked->asked[shard].data, asked->asked_points[shard].data);
	const char *inner = quote_literal_cstr(psprintf("SELECT id, x, y%s FROM %s", dimension == 2 ? "" : ", z", settled));

	return psprintf("SELECT r.* FROM %s AS r", shard_call(asked->fcinfo, mesh, 1, &inner));
}

/* Adds a row to the result, for which a server has the number of the place. */
static void
put_row(PlacesAsked *asked, int place, HeapTuple row, TupleDesc desc)
{
	int			count = asked->set->setDesc->natts;
	Datum	   *values = palloc(count * sizeof(Datum));
	bool	   *nulls = palloc(count * sizeof(bool));

	for (int i = 0; i < count; i++)
		values[i] = heap_getattr(row, 1 + i, desc, &nulls[i]);
	values[0] = Int64GetDatum(asked->ids[place]);
	tuplestore_putvalues(asked->set->setResult, asked->set->setDesc, values, nulls);
	pfree(values);
	pfree(nulls);
}

static void
take_answers(PlacesAsked *asked, int shard, const LinkRows *rows)
{
	for (uint64 i = 0; i < rows->count; i++)
	{
		int64		place = DatumGetInt64(link_value(rows, i, 1));

		if (place < 0 || place >= asked->count)
			elog(ERROR, "a server returned a place that it was not asked for");
		if (asked->settled[place] != NOT_SETTLED && asked->settled[place] != shard)
			continue;			/* another one has given the same answer */
		asked->settled[place] = shard;
		put_row(asked, (int) place, rows->rows[i], rows->desc);
	}
}

/* Asks all shards for which there are places. */
static void
ask_shards(PlacesAsked *asked, ShardLinks *links)
{
	MemoryContext scratch = AllocSetContextCreate(CurrentMemoryContext, "Abacus places", ALLOCSET_DEFAULT_SIZES);
	MemoryContext old = MemoryContextSwitchTo(scratch);

	for (int i = 0; i < links->count; i++)
		if (asked->asked[i].len > 0)
			link_send(links, i, places_query(asked, i));
	for (int i = 0; i < links->count; i++)
	{
		LinkRows   *rows;

		if (asked->asked[i].len == 0)
			continue;
		rows = link_rows(links, i, asked->columns);
		take_answers(asked, i, rows);
		link_rows_free(rows);
		resetStringInfo(&asked->asked[i]);
		resetStringInfo(&asked->asked_points[i]);
	}
	MemoryContextSwitchTo(old);
	MemoryContextDelete(scratch);
}

/* Whether a place may be in the mesh, which is within the box of its points. */
static bool
may_be_inside(const PlacesAsked *asked, int place)
{
	const abacus_box *extent = &asked->generation.extent;
	int			dimension = (int) asked->generation.form.dimension;
	bool		inside = asked->generation.points > 0;

	for (int i = 0; i < dimension; i++)
		inside &= extent->lower[i] <= asked->points[place * dimension + i] &&
			asked->points[place * dimension + i] <= extent->upper[i];
	return inside;
}

/* Answers the places that are there. */
static void
answer_places(PlacesAsked *asked, ShardLinks *links)
{
	const Generation *generation = &asked->generation;
	int			dimension = (int) generation->form.dimension;

	for (int i = 0; i < asked->count; i++)
	{
		abacus_error error;
		uint64		code;

		asked->settled[i] = NOT_SETTLED;
		if (!may_be_inside(asked, i))
			continue;
		if (abacus_codes(&generation->form, asked->points + i * dimension, 1, &code, &error) != ABACUS_OK)
			elog(ERROR, "could not compute a code: %s", error.message);
		asked->owners[i] = (int) generation_owner(generation, code);
		ask_for(asked, asked->owners[i], i);
	}
	ask_shards(asked, links);
	for (int i = 0; i < asked->count; i++)
		for (int shard = 0; shard < links->count; shard++)
			if (asked->settled[i] == NOT_SETTLED && may_be_inside(asked, i) && shard != asked->owners[i])
				ask_for(asked, shard, i);
	ask_shards(asked, links);
	for (int i = 0; i < asked->count; i++)
		if (asked->settled[i] == NOT_SETTLED)
			asked->put_outside(asked, i);
	asked->count = 0;
}

static void
put_nothing(PlacesAsked *asked, int place)
{
}

/*
 * Whether servers can answer: they know the simplices around a place, from which linear values inside the
 * mesh follow. For others the coordinator reads their pages.
 */
bool
shard_can_answer(FunctionCallInfo fcinfo)
{
	return is_over_shards(fcinfo) && shard_call_has_text(fcinfo, "method", "linear") &&
		shard_call_has_text(fcinfo, "outside", "null") && shard_call_has_null(fcinfo, "step");
}

static void
open_places(PlacesAsked *asked, FunctionCallInfo fcinfo, ShardLinks *links)
{
	asked->fcinfo = fcinfo;
	generation_read_links(PG_GETARG_OID(0), &asked->generation, links);
	begin_places(asked);
}

/* ---- The places of a query ------------------------------------------------------------------ */

/* A row with the id and nothing else. */
static void
put_bare_id(PlacesAsked *asked, int place)
{
	int			count = asked->set->setDesc->natts;
	Datum	   *values = palloc0(count * sizeof(Datum));
	bool	   *nulls = palloc(count * sizeof(bool));

	memset(nulls, true, count * sizeof(bool));
	values[0] = Int64GetDatum(asked->ids[place]);
	nulls[0] = false;
	tuplestore_putvalues(asked->set->setResult, asked->set->setDesc, values, nulls);
	pfree(values);
	pfree(nulls);
}

typedef struct QueryRead
{
	PlacesAsked *asked;
	Source		source;
	abacus_facts facts;
} QueryRead;

static void
answer_query(QueryRead *read, ShardLinks *links)
{
	PlacesAsked *asked = read->asked;
	int			words = 1 + (int) asked->generation.form.dimension;
	const uint64 *records;
	size_t		count;

	source_open_places(&read->source, (abacus_names) {&read->facts, NULL});
	while ((count = source_fetch(&read->source, &records)) > 0)
	{
		if (asked->count + (int) count > PLACES_AT_ONCE)
			answer_places(asked, links);
		for (size_t i = 0; i < count; i++)
		{
			const uint64 *record = records + i * words;

			asked->ids[asked->count] = (int64) record[0];
			memcpy(asked->points + asked->count * (words - 1), record + 1, (words - 1) * sizeof(double));
			asked->count++;
		}
	}
	source_close(&read->source);
	answer_places(asked, links);
}

/* The rows of a function of a query's places; with `has_row_outside` also of those outside. */
Datum
shard_read_places(FunctionCallInfo fcinfo, bool has_row_outside)
{
	PlacesAsked asked = {
		.put_outside = has_row_outside ? put_bare_id : put_nothing,
		.set = (ReturnSetInfo *) fcinfo->resultinfo
	};
	QueryRead	read = {&asked};
	ShardLinks	links;

	InitMaterializedSRF(fcinfo, 0);
	if (PG_ARGISNULL(1))
		PG_RETURN_NULL();
	source_prepare(&read.source, text_to_cstring(PG_GETARG_TEXT_PP(1)));
	open_places(&asked, fcinfo, &links);
	read.facts.form = asked.generation.form;
	asked.columns = link_columns(0, NULL, asked.set->setDesc);
	answer_query(&read, &links);
	source_finish(&read.source);
	PG_RETURN_NULL();
}
