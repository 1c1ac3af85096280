/*
 * fn_lines.c: abacus_lines, the lines of a mesh as they were given, and _abacus_fixed_edges, what a
 * view of abacus_publish() shows of the edges on them.
 */
#include "postgres.h"

#include "executor/spi.h"
#include "funcapi.h"

#include "pg/base/sql_function.h"
#include "pg/lines/named_rows.h"
#include "pg/mesh/lines_table.h"
#include "pg/mesh/mesh_pages.h"
#include "pg/mesh/reader.h"
#include "pg/port/port.h"
#include "pg/sql/constrain/fixed_edges.h"

SQL_FUNCTION(abacus_sql_lines);
SQL_FUNCTION(abacus_sql_fixed_edges);

/* The table of the lines of a mesh, as a name in SQL; NULL if it has no lines. */
static char *
table_of(Oid mesh)
{
	Reader	   *reader = reader_open(mesh, CurrentMemoryContext);
	char	   *name = NULL;

	if (reader->header.facts.census.lines > 0)
		name = lines_table_name(lines_table_require(mesh_pages(reader->host)->simplices.heap, MESH_READ));
	host_release(reader->host);
	host_destroy(reader->host);
	return name;
}

/* abacus_lines(mesh regclass) -> line, position, point, x, y, kind, part */
Datum
abacus_sql_lines(PG_FUNCTION_ARGS)
{
	ReturnSetInfo *set = (ReturnSetInfo *) fcinfo->resultinfo;
	char	   *table;
	int			level;

	InitMaterializedSRF(fcinfo, 0);
	table = table_of(PG_GETARG_OID(0));
	if (table == NULL)
		PG_RETURN_NULL();
	SPI_connect();
	level = plain_names_begin(false);
	query_into(set->setResult, psprintf("SELECT line, position, point, x, y, kind, part FROM %s "
										"ORDER BY line, position", table));
	plain_names_end(level);
	SPI_finish();
	PG_RETURN_NULL();
}

/* _abacus_fixed_edges(mesh regclass) -> v0, v1, length, lines, kind, path */
Datum
abacus_sql_fixed_edges(PG_FUNCTION_ARGS)
{
	abacus_window whole = {.kind = ABACUS_NO_WINDOW};
	abacus_extent all = {0};
	Reader	   *reader;

	InitMaterializedSRF(fcinfo, 0);
	reader = reader_open(PG_GETARG_OID(0), CurrentMemoryContext);
	fixed_edges_put(reader, &whole, &all, true, (ReturnSetInfo *) fcinfo->resultinfo);
	host_release(reader->host);
	host_destroy(reader->host);
	PG_RETURN_NULL();
}
