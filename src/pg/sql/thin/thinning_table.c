/*
 * thinning_table.c: the table beside a thinned mesh, which says how it was thinned.
 *
 * It has one row. Until the mesh is done, the row has no greatest error; so it shows with which
 * arguments an interrupted thinning goes on, and whether the mesh is still as the last step left it.
 */
#include "postgres.h"

#include "access/relation.h"
#include "access/tableam.h"
#include "catalog/pg_type.h"
#include "executor/spi.h"
#include "utils/builtins.h"
#include "utils/rel.h"
#include "utils/snapmgr.h"

#include "pg/mesh/lines_table.h"
#include "pg/mesh/new_table.h"
#include "pg/port/port.h"
#include "pg/sql/thin/thinning_table.h"

/* Columns of the row, from 1 as SPI counts. */
enum
{
	THINNING_MESH = 1,
	THINNING_STAMP,
	THINNING_ATTRIBUTE,
	THINNING_MAX_ERROR,
	THINNING_KEEP,
	THINNING_TARGET,
	THINNING_GREATEST,
	THINNING_REACHED
};

static void
require(int status, int expected)
{
	if (status != expected || SPI_processed != 1)
		elog(ERROR, "could not write how the mesh is thinned: %s", SPI_result_code_string(status));
}

/* Makes the table of a new mesh. */
void
thinning_table_make(Relation mesh, const ThinningRow *row)
{
	static const NewSideTable thinning = {
		.suffix = THINNING_TABLE_SUFFIX,.type = THINNING_TYPE,.columns = THINNING_COLUMNS,
		.options = "PRIMARY KEY (mesh)",.contents = "its thinning",.maker = "abacus_thin()",
		.reader = "abacus_thin()"
	};
	Oid			table = side_table_make(mesh, &thinning);
	Oid			types[] = {TEXTOID, INT8OID, TEXTOID, FLOAT8OID, TEXTOID, INT8OID};
	Datum		values[] = {
		CStringGetTextDatum(row->mesh), Int64GetDatum(row->stamp), CStringGetTextDatum(row->attribute),
		Float8GetDatum(row->max_error), row->keep == NULL ? (Datum) 0 : CStringGetTextDatum(row->keep),
		Int64GetDatum(row->target)
	};
	const char	nulls[] = {' ', ' ', ' ', ' ', row->keep == NULL ? 'n' : ' ', row->target == 0 ? 'n' : ' '};

	SPI_connect();
	require(SPI_execute_with_args(psprintf("INSERT INTO %s VALUES ($1, $2, $3, $4, $5, $6)",
										   lines_table_name(table)),
								  lengthof(types), types, values, nulls, false, 0), SPI_OK_INSERT);
	SPI_finish();
}

static char *
text_at(int column)
{
	return SPI_getvalue(SPI_tuptable->vals[0], SPI_tuptable->tupdesc, column);
}

static Datum
value_at(int column, bool *isnull)
{
	return SPI_getbinval(SPI_tuptable->vals[0], SPI_tuptable->tupdesc, column, isnull);
}

/* Reads the row into the caller's memory; false if the mesh has no such table, or an empty one. */
bool
thinning_table_read(Relation mesh, ThinningRow *row)
{
	Oid			table = mesh_rows_table(mesh, MESH_THINNING, MESH_WRITE);
	MemoryContext caller = CurrentMemoryContext;
	bool		is_there;
	bool		isnull;

	if (!OidIsValid(table))
		return false;
	SPI_connect();
	if (SPI_execute(psprintf("SELECT * FROM %s", lines_table_name(table)), false, 1) != SPI_OK_SELECT)
		elog(ERROR, "could not read how the mesh is thinned: %s", SPI_result_code_string(SPI_result));
	is_there = SPI_processed == 1;
	if (is_there)
	{
		MemoryContext spi = MemoryContextSwitchTo(caller);
		Datum		target = value_at(THINNING_TARGET, &isnull);

		row->target = isnull ? 0 : DatumGetInt64(target);
		row->mesh = text_at(THINNING_MESH);
		row->stamp = DatumGetInt64(value_at(THINNING_STAMP, &isnull));
		row->attribute = text_at(THINNING_ATTRIBUTE);
		row->max_error = DatumGetFloat8(value_at(THINNING_MAX_ERROR, &isnull));
		row->keep = text_at(THINNING_KEEP);
		row->greatest = DatumGetFloat8(value_at(THINNING_GREATEST, &isnull));
		row->is_done = !isnull;
		row->reached = DatumGetInt64(value_at(THINNING_REACHED, &isnull));
		MemoryContextSwitchTo(spi);
	}
	SPI_finish();
	return is_there;
}

/*
 * Whether abacus_thin_build() has not finished a mesh. Whoever may read the mesh may know that, so it takes
 * no privilege on the table.
 */
bool
thinning_is_unfinished(Oid mesh)
{
	Oid			table = mesh_find_rows_table(mesh, MESH_THINNING);
	Relation	rel = OidIsValid(table) ? try_relation_open(table, AccessShareLock) : NULL;
	bool		is_unfinished = false;
	TableScanDesc scan;
	TupleTableSlot *slot;

	if (rel == NULL)
		return false;
	slot = table_slot_create(rel, NULL);
	scan = port_table_beginscan(rel, GetActiveSnapshot());
	while (table_scan_getnextslot(scan, ForwardScanDirection, slot))
		is_unfinished = slot_attisnull(slot, THINNING_GREATEST);
	table_endscan(scan);
	ExecDropSingleTupleTableSlot(slot);
	relation_close(rel, NoLock);
	return is_unfinished;
}

static void
set(Relation mesh, const char *columns, Oid type, Datum value)
{
	Oid			table = mesh_rows_table(mesh, MESH_THINNING, MESH_WRITE);

	SPI_connect();
	require(SPI_execute_with_args(psprintf("UPDATE %s SET %s", lines_table_name(table), columns),
								  1, &type, &value, NULL, false, 0), SPI_OK_UPDATE);
	SPI_finish();
}

/* A step is done, which left the mesh with this stamp. */
void
thinning_table_reach(Relation mesh, int64 stamp)
{
	set(mesh, "reached = $1", INT8OID, Int64GetDatum(stamp));
}

/* The mesh is done. */
void
thinning_table_finish(Relation mesh, double greatest)
{
	set(mesh, "greatest = $1, reached = NULL", FLOAT8OID, Float8GetDatum(greatest));
}
