/*
 * fn_shard_change.c: what the coordinator of a mesh over several servers calls on a server when the mesh is
 * changed: abacus_shard_change inserts or deletes points, abacus_shard_exports_around says which vertices
 * other shards then need.
 */
#include "postgres.h"

#include "funcapi.h"
#include "utils/array.h"
#include "utils/builtins.h"

#include "abacus/shards.h"
#include "pg/base/sql_function.h"
#include "pg/host/guard.h"
#include "pg/mesh/change.h"
#include "pg/mesh/reader.h"
#include "pg/mesh/shape.h"
#include "pg/sql/rows/answers.h"
#include "pg/sql/rows/changed_row.h"
#include "pg/sql/rows/on_duplicate.h"
#include "pg/sql/rows/result.h"
#include "pg/sql/shards/exports_row.h"

SQL_FUNCTION(abacus_sql_shard_change);
SQL_FUNCTION(abacus_sql_shard_exports_around);

/* ---- abacus_shard_change -------------------------------------------------------------------- */

/* Columns: those of a changed simplex, and of the first row, which counts */
enum
{
	COUNT_POINTS = CHANGED_COLUMNS,
	COUNT_MORE,
	COUNT_DUPLICATES,
	COUNT_GAINED,
	COUNT_IS_ALL_NEW,
	COUNT_COLUMNS
};

typedef struct ShardChange
{
	Answers		answers;
	int64		first;			/* codes that the shard owns */
	int64		last;
	bool		returns;
	int64		gained;			/* simplices of its own */
} ShardChange;

/* Counts a simplex that has come or gone, and adds its row; called by the core. */
static abacus_host_status
take_simplex(void *context, int created, const abacus_simplex *simplex)
{
	ShardChange *shard = context;
	Datum		values[COUNT_COLUMNS];
	bool		isnull[COUNT_COLUMNS] = {
		[COUNT_POINTS] = true,[COUNT_MORE] = true,[COUNT_DUPLICATES] = true,[COUNT_GAINED] = true,[COUNT_IS_ALL_NEW] = true
	};

	if (shard->first <= (int64) simplex->code && (int64) simplex->code <= shard->last)
		shard->gained += created ? 1 : -1;
	if (!shard->returns)
		return ABACUS_HOST_OK;
	GUARD_BEGIN();
	changed_columns(simplex, shard->answers.dimension, created != 0, values, isnull);
	answers_add(&shard->answers, values, isnull);
	pfree(DatumGetPointer(values[CHANGED_CORNERS]));
	GUARD_END(shard->answers.host);
	return ABACUS_HOST_OK;
}

/* All points, those that wait included. */
static int64
points_of(const abacus_census *census)
{
	return (int64) (census->vertices + census->duplicates + census->staged - census->inserted);
}

/*
 * abacus_shard_change(mesh regclass, query text, how text, first bigint, last bigint,
 *                     with_simplices boolean)
 *     -> created, code, v0, v1, v2, v3, corners, points, more, duplicates, gained, is_all_new
 */
Datum
abacus_sql_shard_change(PG_FUNCTION_ARGS)
{
	ShardChange shard = {
		.answers = {.set = (ReturnSetInfo *) fcinfo->resultinfo},
		.first = PG_GETARG_INT64(3),.last = PG_GETARG_INT64(4),.returns = PG_GETARG_BOOL(5)
	};
	bool		deletes = strcmp(text_to_cstring(PG_GETARG_TEXT_PP(2)), "delete") == 0;
	Source		source;
	Change	   *change;
	abacus_census *census;
	Datum		values[COUNT_COLUMNS] = {0};
	bool		isnull[COUNT_COLUMNS];
	bool		had_simplices;
	int64		points_before;

	InitMaterializedSRF(fcinfo, 0);
	source_prepare(&source, text_to_cstring(PG_GETARG_TEXT_PP(1)));
	change = change_begin(PG_GETARG_OID(0), "abacus_shard_change()");
	census = &change->writer.header->facts.census;
	had_simplices = census->simplices > 0;
	points_before = points_of(census);
	change->returns = true;
	change->keeps_domain = true;
	if (deletes)
	{
		abacus_names names = abacus_names_of(change->writer.header);
		abacus_facts shape = *names.facts;

		shape.columns.attributes = 0;
		change_read_gone(change, &source, (abacus_names) {&shape, names.of});
		values[COUNT_POINTS] = Int64GetDatum((int64) change_delete(change, false));
	}
	else
	{
		change->on_duplicate = on_duplicate_argument(PG_GETARG_TEXT_PP(2));
		change->may_replace = true;
		change_read(change, &source);
		change_insert(change);
		values[COUNT_POINTS] = Int64GetDatum((int64) change->points);
	}
	shard.answers.host = change->writer.host;
	shard.answers.dimension = change->writer.header->facts.form.dimension;
	change_report(change, take_simplex, &shard);
	memset(isnull, true, sizeof(isnull));
	isnull[COUNT_POINTS] = isnull[COUNT_MORE] = isnull[COUNT_DUPLICATES] = isnull[COUNT_GAINED] = isnull[COUNT_IS_ALL_NEW] = false;
	values[COUNT_MORE] = Int64GetDatum(points_of(census) - points_before);
	values[COUNT_DUPLICATES] = Int64GetDatum((int64) (census->duplicates - change->duplicates));
	values[COUNT_GAINED] = Int64GetDatum(shard.gained);
	values[COUNT_IS_ALL_NEW] = BoolGetDatum(!had_simplices || census->simplices == 0);
	answers_add(&shard.answers, values, isnull);
	change_end(change);
	source_finish(&source);
	PG_RETURN_NULL();
}

/* ---- abacus_shard_exports_around ------------------------------------------------------------ */

/* Adds the row of a vertex; called by the core. */
static abacus_host_status
put_export(void *context, uint32 shard, const abacus_vertex *vertex)
{
	Answers    *answers = context;
	Datum		values[EXPORT_COLUMNS];
	bool		isnull[EXPORT_COLUMNS] = {false};

	GUARD_BEGIN();
	export_columns(shard, vertex, answers->facts, values, isnull);
	answers_add(answers, values, isnull);
	pfree(DatumGetPointer(values[EXPORT_ATTRIBUTES]));
	GUARD_END(answers->host);
	return ABACUS_HOST_OK;
}

/*
 * abacus_shard_exports_around(mesh regclass, borders bigint[], own int, least float8[], greatest float8[],
 *                             query text)
 *     -> shard, id, x, y, z, attributes
 */
Datum
abacus_sql_shard_exports_around(PG_FUNCTION_ARGS)
{
	Reader	   *reader = reader_open(PG_GETARG_OID(0), CurrentMemoryContext);
	Host	   *host = reader->host;
	Answers		answers = {.host = host,.set = (ReturnSetInfo *) fcinfo->resultinfo,.facts = &reader->header.facts};
	abacus_exports *exports = exports_open(fcinfo, reader);
	int			dimension = (int) reader->header.facts.form.dimension;
	abacus_facts shape = {.form = reader->header.facts.form};
	Source		source;
	const uint64 *records;
	size_t		count;

	InitMaterializedSRF(fcinfo, 0);
	host_release(host);
	source_prepare(&source, text_to_cstring(PG_GETARG_TEXT_PP(5)));
	source_open_places(&source, (abacus_names) {&shape, NULL});
	while ((count = source_fetch(&source, &records)) > 0)
		for (size_t i = 0; i < count; i++)
			host_run(host, abacus_exports_around, exports, (const double *) (records + i * (1 + dimension) + 1),
					 put_export, &answers);
	source_close(&source);
	source_finish(&source);
	host_release(host);
	host_destroy(host);
	PG_RETURN_NULL();
}
