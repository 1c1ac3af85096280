/*
 * fn_edit.c: abacus_insert and abacus_delete, which insert and delete points without vertex pages
 * in between; and the forms that return the created and removed simplices as rows.
 *
 * All pages are written before the function returns, once each. A point costs the pages that its
 * cavity or star touches; many points in one call share them.
 */
#include "postgres.h"

#include "funcapi.h"
#include "utils/builtins.h"

#include "pg/base/sql_function.h"
#include "pg/host/guard.h"
#include "pg/mesh/change.h"
#include "pg/remote/shard_read.h"
#include "pg/shards/change/shard_change.h"
#include "pg/sql/rows/answers.h"
#include "pg/sql/rows/changed_row.h"
#include "pg/sql/rows/on_duplicate.h"
#include "pg/track/by_hand.h"

SQL_FUNCTION(abacus_sql_insert);
SQL_FUNCTION(abacus_sql_delete);
SQL_FUNCTION(abacus_sql_insert_returning);
SQL_FUNCTION(abacus_sql_delete_returning);

/* Adds the row of a simplex; called by the core. */
static abacus_host_status
put_simplex(void *context, int created, const abacus_simplex *simplex)
{
	Answers    *answers = context;
	Datum		values[CHANGED_COLUMNS];
	bool		isnull[CHANGED_COLUMNS] = {false};

	GUARD_BEGIN();
	changed_columns(simplex, answers->dimension, created != 0, values, isnull);
	answers_add(answers, values, isnull);
	pfree(DatumGetPointer(values[CHANGED_CORNERS]));
	GUARD_END(answers->host);
	return ABACUS_HOST_OK;
}

/* Opens a mesh for a change; `answers`, if not NULL, gets the created and removed simplices. */
static Change *
begin(Oid mesh, Answers *answers, const char *command)
{
	Change	   *change = change_begin(mesh, command);

	by_hand_refuse_points(change);
	change->returns = answers != NULL;
	return change;
}

static void
end(Change *change, Answers *answers)
{
	if (answers != NULL)
	{
		answers->host = change->writer.host;
		answers->dimension = change->writer.header->facts.form.dimension;
		change_report(change, put_simplex, answers);
	}
	change_end(change);
}

/* Inserts the points of a prepared query; returns how many there were. */
static uint64
insert_query(Oid mesh, Source *source, abacus_on_duplicate how, Answers *answers,
			 const char *command)
{
	Change	   *change = begin(mesh, answers, command);
	uint64		points;

	change->on_duplicate = how;
	change->may_replace = true;
	change_read(change, source);
	change_insert(change);
	points = change->points;
	end(change, answers);
	return points;
}

/* abacus_insert(mesh regclass, query text, on_duplicate text) -> bigint */
Datum
abacus_sql_insert(PG_FUNCTION_ARGS)
{
	abacus_on_duplicate how = on_duplicate_argument(PG_GETARG_TEXT_PP(2));
	Source		source;
	uint64		points;

	source_prepare(&source, text_to_cstring(PG_GETARG_TEXT_PP(1)));
	points = is_over_shards(fcinfo)
		? shard_insert(PG_GETARG_OID(0), &source, text_to_cstring(PG_GETARG_TEXT_PP(2)), NULL, "abacus_insert()")
		: insert_query(PG_GETARG_OID(0), &source, how, NULL, "abacus_insert()");
	source_finish(&source);
	PG_RETURN_INT64((int64) points);
}

/*
 * abacus_insert_returning(mesh regclass, query text, on_duplicate text)
 *     -> created, code, v0, v1, v2, v3, corners
 */
Datum
abacus_sql_insert_returning(PG_FUNCTION_ARGS)
{
	abacus_on_duplicate how = on_duplicate_argument(PG_GETARG_TEXT_PP(2));
	Answers		answers = {.set = (ReturnSetInfo *) fcinfo->resultinfo};
	Source		source;

	InitMaterializedSRF(fcinfo, 0);
	source_prepare(&source, text_to_cstring(PG_GETARG_TEXT_PP(1)));
	if (is_over_shards(fcinfo))
		(void) shard_insert(PG_GETARG_OID(0), &source, text_to_cstring(PG_GETARG_TEXT_PP(2)), answers.set,
							"abacus_insert_returning()");
	else
		insert_query(PG_GETARG_OID(0), &source, how, &answers, "abacus_insert_returning()");
	source_finish(&source);
	PG_RETURN_NULL();
}

/* Removes the points of a prepared query; returns how many there were. */
static uint64
delete_query(Oid mesh, Source *source, Answers *answers, const char *command)
{
	Change	   *change = begin(mesh, answers, command);
	abacus_names names = abacus_names_of(change->writer.header);
	abacus_facts shape = *names.facts;
	uint64		deleted;

	/* id and coordinates say which points; attributes may follow, as in abacus_insert() */
	if (source_columns(source) == source_first_attribute(source, shape.form.dimension))
		shape.columns.attributes = 0;
	change_read_gone(change, source, (abacus_names) {&shape, names.of});
	deleted = change_delete(change, false);
	end(change, answers);
	return deleted;
}

/* abacus_delete(mesh regclass, query text) -> bigint */
Datum
abacus_sql_delete(PG_FUNCTION_ARGS)
{
	Source		source;
	uint64		deleted;

	source_prepare(&source, text_to_cstring(PG_GETARG_TEXT_PP(1)));
	deleted = is_over_shards(fcinfo) ? shard_delete(PG_GETARG_OID(0), &source, NULL, "abacus_delete()")
		: delete_query(PG_GETARG_OID(0), &source, NULL, "abacus_delete()");
	source_finish(&source);
	PG_RETURN_INT64((int64) deleted);
}

/* abacus_delete_returning(mesh regclass, query text) -> as abacus_insert_returning() */
Datum
abacus_sql_delete_returning(PG_FUNCTION_ARGS)
{
	Answers		answers = {.set = (ReturnSetInfo *) fcinfo->resultinfo};
	Source		source;

	InitMaterializedSRF(fcinfo, 0);
	source_prepare(&source, text_to_cstring(PG_GETARG_TEXT_PP(1)));
	if (is_over_shards(fcinfo))
		(void) shard_delete(PG_GETARG_OID(0), &source, answers.set, "abacus_delete_returning()");
	else
		delete_query(PG_GETARG_OID(0), &source, &answers, "abacus_delete_returning()");
	source_finish(&source);
	PG_RETURN_NULL();
}
