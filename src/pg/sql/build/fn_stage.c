/*
 * fn_stage.c: abacus_stage, which writes points from a query into vertex pages, where they wait to
 * be inserted.
 */
#include "postgres.h"

#include "utils/builtins.h"

#include "pg/base/sql_function.h"
#include "pg/mesh/change.h"
#include "pg/track/by_hand.h"

SQL_FUNCTION(abacus_sql_stage);

/* abacus_stage(mesh regclass, query text) -> bigint */
Datum
abacus_sql_stage(PG_FUNCTION_ARGS)
{
	Source		source;
	Change	   *change;
	uint64		points;

	source_prepare(&source, text_to_cstring(PG_GETARG_TEXT_PP(1)));
	change = change_begin(PG_GETARG_OID(0), "abacus_stage()");
	by_hand_refuse_points(change);
	change_read(change, &source);
	change_stage(change);
	points = change->points;
	change_end(change);
	source_finish(&source);
	PG_RETURN_INT64((int64) points);
}
