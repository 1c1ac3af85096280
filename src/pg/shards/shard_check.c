/*
 * shard_check.c: the verification of a mesh over several servers, and its figures.
 *
 * Each server verifies its own mesh. Then four things are left (docs/design/servers.md):
 *
 *   1. Each shard has the version that the coordinator's row names.
 *   2. A shard has its own points, and guests that others own.
 *   3. Guests are what their owners have: place, id and attributes.
 *   4. The exchange has ended: no shard has a vertex to send that its receiver lacks.
 *
 * With that, the simplices of all shards are the triangulation of all points, each once, and both sides
 * of each facet on a border are there. Vertices travel as in the exchange, into temporary tables.
 */
#include "postgres.h"

#include "access/htup_details.h"
#include "catalog/pg_type.h"
#include "executor/spi.h"
#include "funcapi.h"
#include "utils/builtins.h"
#include "utils/tuplestore.h"

#include "pg/mesh/mesh.h"
#include "pg/shards/generation_links.h"
#include "pg/shards/relay.h"
#include "pg/shards/shard_check.h"
#include "pg/shards/shard_sql.h"
#include "pg/shards/shard_state.h"
#include "pg/shards/shard_transaction.h"

/* Columns of abacus_check and of abacus_stats */
enum
{
	FAULT_KIND,
	FAULT_CODE,
	FAULT_PART,
	FAULT_MESSAGE,
	FAULT_COLUMNS
};

enum
{
	FIGURE_NAME,
	FIGURE_VALUE,
	FIGURE_DESCRIPTION,
	FIGURE_COLUMNS
};

typedef struct Examination
{
	Generation	generation;
	ReturnSetInfo *set;
	int64		left;			/* faults that may still be reported */
} Examination;

static void
open_examination(Examination *examination, FunctionCallInfo fcinfo, ShardLinks *links)
{
	memset(examination, 0, sizeof(*examination));
	examination->set = (ReturnSetInfo *) fcinfo->resultinfo;
	InitMaterializedSRF(fcinfo, 0);
	SPI_connect();
	generation_require_published(PG_GETARG_OID(0), &examination->generation);
	links_prepare(links, examination->generation.servers, examination->generation.shards);
}

/* ---- abacus_check --------------------------------------------------------------------------- */

static void
put_fault(Examination *examination, Datum *values, bool *isnull)
{
	if (examination->left-- > 0)
		tuplestore_putvalues(examination->set->setResult, examination->set->setDesc, values, isnull);
}

/* What servers find in their meshes. */
static void
check_meshes(Examination *examination, ShardLinks *links)
{
	for (int i = 0; i < links->count; i++)
		link_send(links, i, psprintf("SELECT fault, code, part, message FROM abacus_check('%s'::regclass, %d)",
									 generation_mesh(&examination->generation, i),
									 (int) Min(examination->left, PG_INT32_MAX)));
	for (int i = 0; i < links->count; i++)
	{
		LinkRows   *rows = link_rows(links, i, link_columns(0, NULL, examination->set->setDesc));

		for (uint64 row = 0; row < rows->count; row++)
		{
			Datum		values[FAULT_COLUMNS];
			bool		isnull[FAULT_COLUMNS];

			heap_deform_tuple(rows->rows[row], rows->desc, values, isnull);
			if (!isnull[FAULT_MESSAGE])
				values[FAULT_MESSAGE] =
					CStringGetTextDatum(psprintf("shard %d: %s", i + 1, TextDatumGetCString(values[FAULT_MESSAGE])));
			put_fault(examination, values, isnull);
		}
		link_rows_free(rows);
	}
}

/* Servers count what is wrong; a fault for each where there is any. `message` has a format for the number. */
static void
collect_counts(Examination *examination, ShardLinks *links, const char *message)
{
	for (int i = 0; i < links->count; i++)
	{
		bool		isnull[FAULT_COLUMNS] = {[FAULT_CODE] = true,[FAULT_PART] = true};
		Datum		values[FAULT_COLUMNS] = {[FAULT_KIND] = CStringGetTextDatum("shards")};
		int64		count = link_int64(links, i);

		if (count == 0)
			continue;
		values[FAULT_MESSAGE] = CStringGetTextDatum(psprintf("shard %d: " INT64_FORMAT " %s", i + 1, count, message));
		put_fault(examination, values, isnull);
	}
}

/* Vertices travel to the shards that compare them. */
static void
send_vertices(Examination *examination, ShardLinks *links, char *(*found) (const Generation *, int))
{
	Generation *generation = &examination->generation;

	for (int i = 0; i < links->count; i++)
		link_send(links, i, psprintf("DELETE FROM pg_temp.abacus_export; DELETE FROM pg_temp.abacus_arrival; %s",
									 found(generation, i)));
	for (int i = 0; i < links->count; i++)
		link_finish(links, i);
	for (int i = 0; i < links->count; i++)
		(void) relay_exported(generation, links, i, shard_sql_list_arrived);
	for (int i = 0; i < links->count; i++)
		link_finish(links, i);
}

static void
begin_check(Examination *examination, ShardLinks *links)
{
	int			other = generation_begin_together(&examination->generation, links);

	if (other >= 0)
	{
		bool		isnull[FAULT_COLUMNS] = {[FAULT_CODE] = true,[FAULT_PART] = true};
		Datum		values[FAULT_COLUMNS] = {[FAULT_KIND] = CStringGetTextDatum("shards")};

		values[FAULT_MESSAGE] = CStringGetTextDatum(psprintf("shard %d: it is not as the mesh was last changed", other + 1));
		put_fault(examination, values, isnull);
	}
}

static void
check_shards(ShardLinks *links, void *context)
{
	Examination *examination = context;
	Generation *generation = &examination->generation;

	begin_check(examination, links);
	check_meshes(examination, links);
	for (int i = 0; i < links->count; i++)
		link_do(links, i, shard_sql_make_room());
	for (int i = 0; i < links->count; i++)
		link_send(links, i, shard_sql_strangers(generation, i));
	collect_counts(examination, links, "points that another shard owns are not listed as guests, or listed and not there");
	send_vertices(examination, links, shard_sql_list_guests);
	for (int i = 0; i < links->count; i++)
		link_send(links, i, shard_sql_count_unknown(generation, i));
	collect_counts(examination, links, "of its points are guests of other shards, with another id or other attributes");
	send_vertices(examination, links, shard_sql_list_exports);
	for (int i = 0; i < links->count; i++)
		link_send(links, i, shard_sql_count_missing(generation, i));
	collect_counts(examination, links, "vertices of other shards are missing");
	for (int i = 0; i < links->count; i++)
		link_do(links, i, "ROLLBACK");
}

/* abacus_check(mesh regclass, max_faults int) -> fault, code, part, message */
Datum
shard_check(FunctionCallInfo fcinfo)
{
	Examination examination;
	ShardLinks	links;

	if (PG_ARGISNULL(1))
		ereport(ERROR,
				(errcode(ERRCODE_NULL_VALUE_NOT_ALLOWED),
				 errmsg("max_faults must not be NULL")));
	open_examination(&examination, fcinfo, &links);
	shard_transaction_refuse_changed(examination.generation.relid, "check");
	examination.left = PG_GETARG_INT32(1);
	if (examination.left > 0 && examination.generation.points > 0)
		links_run(&links, check_shards, &examination);
	SPI_finish();
	PG_RETURN_NULL();
}

/* ---- abacus_stats --------------------------------------------------------------------------- */

static void
put_figure(const Examination *examination, const char *name, double value, const char *description)
{
	Datum		values[FIGURE_COLUMNS] = {
		[FIGURE_NAME] = CStringGetTextDatum(name),[FIGURE_VALUE] = Float8GetDatum(value),
		[FIGURE_DESCRIPTION] = CStringGetTextDatum(description)
	};
	bool		isnull[FIGURE_COLUMNS] = {false};

	tuplestore_putvalues(examination->set->setResult, examination->set->setDesc, values, isnull);
}

static void
put_figures(ShardLinks *links, void *context)
{
	const Examination *examination = context;
	const Generation *generation = &examination->generation;
	ShardState *states = shard_states(generation, links);
	ShardState	sum = {0};

	for (int i = 0; i < links->count; i++)
	{
		sum.points += states[i].points;
		sum.vertices += states[i].vertices;
		sum.duplicates += states[i].duplicates;
		sum.guests += states[i].guests;
		sum.bytes += states[i].bytes;
	}
	put_figure(examination, "dimension", generation->form.dimension, "2 for triangles, 3 for tetrahedra");
	put_figure(examination, "attributes", generation->attribute_count, "attributes of a vertex");
	put_figure(examination, "points", (double) sum.points, "all points");
	put_figure(examination, "vertices", (double) sum.vertices,
			   "distinct points in the triangulation; 0 while they span no simplex");
	put_figure(examination, "duplicates", (double) sum.duplicates,
			   "points in the triangulation that equal an earlier one");
	put_figure(examination, "simplices", (double) generation->simplices, "simplices of the mesh");
	put_figure(examination, "shards", generation->shards, "servers, or parts on them");
	put_figure(examination, "guests", (double) sum.guests, "vertices that shards have of each other");
	put_figure(examination, "rounds", generation->rounds, "rounds of the exchange of vertices, the last without any");
	put_figure(examination, "sent", (double) generation->sent, "vertices that were sent in it");
	put_figure(examination, "bytes", (double) sum.bytes, "size of all tables on the servers");
}

/* abacus_stats(mesh regclass) -> name, value, description */
Datum
shard_stats(FunctionCallInfo fcinfo)
{
	Examination examination;
	ShardLinks	links;

	open_examination(&examination, fcinfo, &links);
	links_run(&links, put_figures, &examination);
	SPI_finish();
	PG_RETURN_NULL();
}
