/*
 * named_rows.c: rows in a tuplestore, which queries of the same SPI connection can name like a
 * table.
 *
 * So the checks of lines are SQL, which the executor sorts and joins within work_mem, and beyond it
 * in temporary files. While such queries run, names without a schema are PostgreSQL's own
 * (plain_names_begin), whatever the search path of the caller is.
 */
#include "postgres.h"

#include "executor/spi.h"
#include "executor/tstoreReceiver.h"
#include "miscadmin.h"
#include "tcop/dest.h"
#include "utils/datum.h"
#include "utils/guc.h"
#include "utils/queryenvironment.h"

#include "pg/lines/named_rows.h"
#include "pg/port/port.h"

/* An empty set of rows, in the current memory context. */
NamedRows *
named_rows_create(const char *name, const NamedColumn *columns, int count)
{
	NamedRows  *rows = palloc0(sizeof(NamedRows));

	rows->name = name;
	rows->desc = CreateTemplateTupleDesc(count);
	for (int i = 0; i < count; i++)
		TupleDescInitEntry(rows->desc, (AttrNumber) (i + 1), columns[i].name, columns[i].type, -1, 0);
	TupleDescFinalize(rows->desc);
	/* there are several, beside what sorts them */
	rows->store = tuplestore_begin_heap(true, false, Max(64, work_mem / 4));
	return rows;
}

void
named_rows_put(NamedRows *rows, const Datum *values, const bool *isnull)
{
	tuplestore_putvalues(rows->store, rows->desc, unconstify(Datum *, values),
						 unconstify(bool *, isnull));
	rows->count++;
}

/* From here on, queries of this SPI connection know the rows by their name. */
void
named_rows_register(NamedRows *rows)
{
	EphemeralNamedRelation relation = palloc0(sizeof(EphemeralNamedRelationData));

	relation->md.name = pstrdup(rows->name);
	relation->md.reliddesc = InvalidOid;
	relation->md.tupdesc = rows->desc;
	relation->md.enrtype = ENR_NAMED_TUPLESTORE;
	relation->md.enrtuples = (double) rows->count;
	relation->reldata = rows->store;
	if (SPI_register_relation(relation) != SPI_OK_REL_REGISTER)
		elog(ERROR, "could not register the rows \"%s\"", rows->name);
}

/* The result of a query with these columns, registered. */
NamedRows *
named_rows_of_query(const char *name, const NamedColumn *columns, int count, const char *query)
{
	NamedRows  *rows = named_rows_create(name, columns, count);

	rows->count = query_into(rows->store, query);
	named_rows_register(rows);
	return rows;
}

/* Ends the rows, and their temporary file. Queries do not know them any more. */
void
named_rows_free(NamedRows *rows)
{
	(void) SPI_unregister_relation(rows->name); /* it may not be registered */
	tuplestore_end(rows->store);
	pfree(rows);
}

static void
set(const char *setting, const char *value)
{
	(void) set_config_option(setting, value, PGC_USERSET, PGC_S_SESSION, GUC_ACTION_SAVE, true, 0,
							 false);
}

/*
 * Until plain_names_end(), names in queries are those of PostgreSQL, unless they have a schema. If
 * the mesh is written, queries may use the memory of maintenance, as all its sorts do; hash tables, too,
 * and no multiple of it.
 */
int
plain_names_begin(bool writes)
{
	int			level = NewGUCNestLevel();

	set("search_path", "pg_catalog, pg_temp");
	if (writes)
	{
		set("jit", "off");
		set("work_mem", psprintf("%d", Max(work_mem, maintenance_work_mem)));
		set("hash_mem_multiplier", "1");
	}
	return level;
}

void
plain_names_end(int level)
{
	AtEOXact_GUC(true, level);
}

/* Puts the rows of a query into a tuplestore; returns how many there were. */
uint64
query_into(Tuplestorestate *store, const char *query)
{
	DestReceiver *receiver = CreateDestReceiver(DestTuplestore);
	SPIExecuteOptions options = {.read_only = true, .dest = receiver};

	SetTuplestoreDestReceiverParams(receiver, store, CurrentMemoryContext, false, NULL, NULL);
	if (SPI_execute_extended(query, &options) != SPI_OK_SELECT)
		elog(ERROR, "could not run the query: %s", SPI_result_code_string(SPI_result));
	receiver->rDestroy(receiver);
	return SPI_processed;
}

/* Runs a statement that changes the lines; returns how many rows it changed. */
uint64
query_run(const char *query)
{
	int			status = SPI_execute(query, false, 0);

	if (status < 0)
		elog(ERROR, "could not change the lines: %s", SPI_result_code_string(status));
	return SPI_processed;
}

/*
 * Runs a statement that must change so many rows of a mesh's table: a rule or a trigger may keep it from
 * that. `contents`: what the table has, for the message.
 */
void
query_change(const char *table, const char *contents, const char *statement, uint64 rows)
{
	if (query_run(statement) != rows)
		ereport(ERROR,
				(errcode(ERRCODE_OBJECT_NOT_IN_PREREQUISITE_STATE),
				 errmsg("a rule or a trigger interferes with the table of %s", contents),
				 errdetail("The table is %s.", table),
				 errhint("Drop it. The table belongs to the mesh.")));
}

/* Gets the first row of a query; false if it has none. */
bool
query_first(const char *query, Datum *values, bool *isnull, int count)
{
	bool		found;

	if (SPI_execute(query, true, 1) != SPI_OK_SELECT)
		elog(ERROR, "could not run the query: %s", SPI_result_code_string(SPI_result));
	found = SPI_processed > 0;
	for (int i = 0; found && i < count; i++)
	{
		Form_pg_attribute column = TupleDescAttr(SPI_tuptable->tupdesc, i);

		values[i] = SPI_getbinval(SPI_tuptable->vals[0], SPI_tuptable->tupdesc, i + 1, &isnull[i]);
		if (!isnull[i])
			values[i] = datumCopy(values[i], column->attbyval, column->attlen);
	}
	SPI_freetuptable(SPI_tuptable);
	return found;
}
