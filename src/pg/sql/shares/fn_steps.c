/*
 * fn_steps.c: abacus_steps, which steps of a solution are stored, and which are whole.
 */
#include "postgres.h"

#include "access/table.h"
#include "executor/spi.h"
#include "funcapi.h"

#include "pg/base/sql_function.h"
#include "pg/lines/named_rows.h"
#include "pg/mesh/lines_table.h"
#include "pg/mesh/notices.h"
#include "pg/steps/step.h"

SQL_FUNCTION(abacus_sql_steps);

/* abacus_steps(mesh regclass) -> step, parts, stored, vertices, whole */
Datum
abacus_sql_steps(PG_FUNCTION_ARGS)
{
	static const char *const query = "SELECT step, parts, stored, vertices, whole FROM (" STEPS_QUERY ") AS steps";
	ReturnSetInfo *set = (ReturnSetInfo *) fcinfo->resultinfo;
	Relation	mesh;
	Oid			table;
	int			level;

	InitMaterializedSRF(fcinfo, 0);
	mesh = mesh_table_open(PG_GETARG_OID(0), MESH_READ);
	table = mesh_rows_table(mesh, MESH_STEPS, MESH_READ);
	table_close(mesh, NoLock);
	if (!OidIsValid(table))
	{
		(void) notice_namesake(PG_GETARG_OID(0), MESH_STEPS);
		PG_RETURN_NULL();
	}
	SPI_connect();
	level = plain_names_begin(false);
	query_into(set->setResult, psprintf(query, lines_table_name(table), ""));
	plain_names_end(level);
	SPI_finish();
	PG_RETURN_NULL();
}
