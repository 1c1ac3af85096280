/*
 * fn_outline.c: abacus_hull and abacus_alpha_shape, the border of a mesh or of
 * some of its simplices.
 */
#include "postgres.h"

#include <math.h>

#include "funcapi.h"
#include "utils/builtins.h"

#include "abacus/shapes.h"
#include "pg/base/settings.h"
#include "pg/base/sql_function.h"
#include "pg/host/guard.h"
#include "pg/mesh/reader.h"
#include "pg/sql/arguments/extent_arguments.h"
#include "pg/sql/arguments/window.h"
#include "pg/sql/rows/answers.h"
#include "pg/sql/shapes/clipped_outline.h"

SQL_FUNCTION(abacus_sql_hull);
SQL_FUNCTION(abacus_sql_alpha_shape);

/* Columns of both */
enum
{
	OUTLINE_RING,
	OUTLINE_POSITION,
	OUTLINE_VERTEX,
	OUTLINE_X,
	OUTLINE_COLUMNS = OUTLINE_X + ABACUS_MAX_DIMENSION
};

/* Arguments 1 and 2 of abacus_alpha_shape; a value that no circle exceeds sets no bound. */
static void
alpha_arguments(FunctionCallInfo fcinfo, const abacus_form *form, abacus_outline_kind *kind)
{
	if (PG_ARGISNULL(1))
		ereport(ERROR,
				(errcode(ERRCODE_NULL_VALUE_NOT_ALLOWED),
				 errmsg("alpha must not be NULL"),
				 errhint("Give 'Infinity' for the hull.")));
	kind->alpha = PG_GETARG_FLOAT8(1);
	if (!(kind->alpha > 0))
		ereport(ERROR,
				(errcode(ERRCODE_INVALID_PARAMETER_VALUE),
				 errmsg("alpha must be a number greater than 0"),
				 errhint("alpha is the square of a radius, as in ST_AlphaShape.")));
	kind->has_alpha = isfinite(kind->alpha) != 0;
	if (PG_ARGISNULL(2))
		kind->fills_holes = form->dimension == 2;
	else
		kind->fills_holes = !PG_GETARG_BOOL(2);
}

/* Adds a row. */
static void
add_row(const Answers *answers, const abacus_outline_row *row, bool is_vertex)
{
	Datum		values[OUTLINE_COLUMNS] = {0};
	bool		isnull[OUTLINE_COLUMNS] = {false};

	values[OUTLINE_RING] = Int64GetDatum((int64) row->ring);
	values[OUTLINE_POSITION] = Int64GetDatum((int64) row->position);
	values[OUTLINE_VERTEX] = Int64GetDatum(row->vertex);
	isnull[OUTLINE_VERTEX] = !is_vertex;
	for (uint32 i = 0; i < ABACUS_MAX_DIMENSION; i++)
	{
		isnull[OUTLINE_X + i] = i >= answers->dimension;
		if (i < answers->dimension)
			values[OUTLINE_X + i] = Float8GetDatum(row->point[i]);
	}
	answers_add(answers, values, isnull);
}

/* Called by the core. */
static abacus_host_status
put_row(void *context, const abacus_outline_row *row)
{
	Answers    *answers = context;

	GUARD_BEGIN();
	add_row(answers, row, true);
	GUARD_END(answers->host);
	return ABACUS_HOST_OK;
}

static Datum
outline(FunctionCallInfo fcinfo, bool is_alpha)
{
	Reader	   *reader;
	Host	   *host;
	abacus_outline_kind kind = {0};
	Answers		answers = {.set = (ReturnSetInfo *) fcinfo->resultinfo};

	InitMaterializedSRF(fcinfo, 0);
	if (PG_ARGISNULL(0))
		PG_RETURN_NULL();
	reader = reader_open(PG_GETARG_OID(0), CurrentMemoryContext);
	host = answers.host = reader->host;
	answers.dimension = reader->header.facts.form.dimension;
	if (is_alpha)
		alpha_arguments(fcinfo, &reader->header.facts.form, &kind);
	else
		extent_arguments(fcinfo, 1, 2, PG_GETARG_OID(0), &reader->header, host, &kind.extent);
	progress_begin(&host->progress, PG_GETARG_OID(0));
	if (kind.extent.area != NULL)
		clipped_outline(reader, &kind, text_to_cstring(PG_GETARG_TEXT_PP(2)), add_row, &answers);
	else
		host_run(host, abacus_outline, &host->table, &reader->header.facts, &kind, setting_query_sort_bytes(),
				 setting_cache_bytes(), put_row, &answers);
	progress_end(&host->progress);
	host_release(host);
	host_destroy(host);
	PG_RETURN_NULL();
}

/* abacus_hull(mesh regclass, max_edge float8, within text) -> ring, position, vertex, x, y, z */
Datum
abacus_sql_hull(PG_FUNCTION_ARGS)
{
	return outline(fcinfo, false);
}

/*
 * abacus_alpha_shape(mesh regclass, alpha float8, allow_holes boolean)
 *     -> the same
 */
Datum
abacus_sql_alpha_shape(PG_FUNCTION_ARGS)
{
	return outline(fcinfo, true);
}
