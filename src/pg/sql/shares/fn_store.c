/*
 * fn_store.c: abacus_store, which takes the solution of one part of a mesh back, at one step.
 *
 * The ids must be those of the part's own vertices, each once. A last row, without id, says that the part is
 * there: its values are the number of parts, how many vertices the part has, the stamp of the mesh, in two
 * halves that a double can hold, and how many values each vertex has. A step is whole when the rows of all its parts say the same.
 */
#include "postgres.h"

#include "access/table.h"
#include "access/xact.h"
#include "catalog/pg_type.h"
#include "storage/lock.h"
#include "utils/builtins.h"
#include "utils/lsyscache.h"
#include "utils/snapmgr.h"

#include "pg/base/settings.h"
#include "pg/base/sql_function.h"
#include "pg/host/guard.h"
#include "pg/input/source.h"
#include "pg/lines/named_rows.h"
#include "pg/mesh/mesh_cache.h"
#include "pg/mesh/reader.h"
#include "pg/steps/steps_table.h"
#include "pg/sql/rows/result.h"
#include "pg/sql/shares/share_arguments.h"

SQL_FUNCTION(abacus_sql_store);

/* Arguments */
enum
{
	STORE_MESH,
	STORE_STEP,
	STORE_PARTS,
	STORE_PART,
	STORE_QUERY,
	STORE_WEIGHT
};

static const NamedColumn given_columns[] = {{"id", INT8OID}, {"values", FLOAT8ARRAYOID}};

/* The rows of the query. */
static NamedRows *
read_rows(Source *source)
{
	NamedRows  *given = named_rows_create("given", given_columns, 2);
	MemoryContext row = AllocSetContextCreate(CurrentMemoryContext, "Abacus row", ALLOCSET_DEFAULT_SIZES);
	int			values = source_columns(source) - 1;
	const uint64 *records;
	size_t		count;

	source_open_values(source);
	while ((count = source_fetch(source, &records)) > 0)
	{
		MemoryContext old = MemoryContextSwitchTo(row);

		for (; count > 0; count--, records += 1 + values)
		{
			Datum		columns[] = {
				Int64GetDatum((int64) records[0]),
				attribute_array((const double *) (records + 1), values)
			};

			named_rows_put(given, columns, (bool[2]) {false, false});
		}
		MemoryContextSwitchTo(old);
		MemoryContextReset(row);
	}
	source_close(source);
	return given;
}

/* The ids of the part's own vertices. */
typedef struct OwnIds
{
	Host	   *host;
	NamedRows  *rows;
	uint32		part;
} OwnIds;

/* Called by the core. */
static abacus_host_status
put_own(void *context, const abacus_share_vertex *vertex)
{
	OwnIds	   *own = context;
	Datum		id = Int64GetDatum(vertex->id);

	if (vertex->owner != own->part)
		return ABACUS_HOST_OK;
	GUARD_BEGIN();
	named_rows_put(own->rows, &id, (bool[1]) {false});
	GUARD_END(own->host);
	return ABACUS_HOST_OK;
}

/* How the mesh was cut, and when, and how many values came: of the row that says that a part is there. */
typedef struct PartMark
{
	uint32		parts;
	uint64		stamp;
	uint32		values;
} PartMark;

static NamedRows *
find_own(FunctionCallInfo fcinfo, PartMark *mark)
{
	CachedMesh *cached = mesh_cache_get(PG_GETARG_OID(STORE_MESH));
	abacus_share share = {0};
	OwnIds		own = {cached->host, named_rows_create("own", given_columns, 1)};

	cut_arguments(fcinfo, STORE_PARTS, STORE_WEIGHT, abacus_names_of(&cached->header), &share.cut);
	share.part = own.part = part_argument(fcinfo, STORE_PART, &share.cut);
	mark->parts = share.cut.parts;
	mark->stamp = cached->header.stamp;
	host_run(cached->host, abacus_mesh_share_vertices, cached->mesh, &share, setting_query_sort_bytes(),
			 put_own, &own);
	host_release(cached->host);
	return own.rows;
}

/*
 * The mesh must still be as the active snapshot shows it: what this command has changed since, that snapshot
 * does not see, but the solution would belong to it.
 */
static void
refuse_own_changes(Oid mesh, uint64 stamp)
{
	Reader	   *reader;
	bool		is_same;

	CommandCounterIncrement();
	PushCopiedSnapshot(GetActiveSnapshot());
	UpdateActiveSnapshotCommandId();
	reader = reader_open(mesh, CurrentMemoryContext);
	is_same = reader->header.stamp == stamp;
	host_release(reader->host);
	host_destroy(reader->host);
	PopActiveSnapshot();
	if (!is_same)
		ereport(ERROR,
				(errcode(ERRCODE_OBJECT_IN_USE),
				 errmsg("the statement that stores values also changes mesh \"%s\"", get_rel_name(mesh)),
				 errhint("Change the mesh first, in a statement of its own, and read the shares again.")));
}

/* An error if an id is there twice. */
static void
refuse_repeated(const char *rows, const char *message, const char *hint)
{
	Datum		id;
	bool		isnull;

	if (query_first(psprintf("SELECT id FROM %s GROUP BY id HAVING count(*) > 1 ORDER BY id LIMIT 1", rows),
					&id, &isnull, 1))
		ereport(ERROR,
				(errcode(ERRCODE_UNIQUE_VIOLATION),
				 errmsg_internal(message, DatumGetInt64(id)),
				 errhint("%s", hint)));
}

/* Whether each id given is that of one own vertex, and the other way round: as many pairs as there are of both. */
static bool
are_own(const NamedRows *given, const NamedRows *own)
{
	Datum		counts[3];
	bool		isnull[3];

	(void) query_first("SELECT count(*), count(g.id), count(o.id) FROM given AS g FULL JOIN own AS o ON g.id = o.id",
					   counts, isnull, 3);
	for (int i = 0; i < 3; i++)
		if (DatumGetInt64(counts[i]) != (int64) given->count || DatumGetInt64(counts[i]) != (int64) own->count)
			return false;
	return true;
}

/* An error unless the ids are those of the part's own vertices. */
static void
check_ids(const NamedRows *given, const NamedRows *own, uint32 part)
{
	Datum		ids[2];
	bool		isnull[2];

	if (are_own(given, own))
		return;
	refuse_repeated("given", "the source query has the id " INT64_FORMAT " twice",
					"Return one row for each vertex of the part.");
	refuse_repeated("own", "two vertices of the part have the id " INT64_FORMAT,
					"Values are stored by id: give the points of the mesh ids of their own.");
	if (!query_first("SELECT g.id, o.id FROM given AS g FULL JOIN own AS o ON g.id = o.id "
					 "WHERE g.id IS NULL OR o.id IS NULL ORDER BY g.id, o.id LIMIT 1", ids, isnull, 2))
		return;
	if (isnull[1])
		ereport(ERROR,
				(errcode(ERRCODE_INVALID_PARAMETER_VALUE),
				 errmsg("id " INT64_FORMAT " is not that of a vertex of part %u", DatumGetInt64(ids[0]), part),
				 errhint("Store the vertices of abacus_share_vertices() whose owner is the part; the mesh may "
						 "have changed since they were read.")));
	ereport(ERROR,
			(errcode(ERRCODE_INVALID_PARAMETER_VALUE),
			 errmsg("the source query has no row for vertex " INT64_FORMAT " of part %u", DatumGetInt64(ids[1]), part),
			 errhint("Return a row for each vertex of abacus_share_vertices() whose owner is the part; values "
					 "may be NULL.")));
}

/* Sessions that store the same part of the same step take turns, until their transactions end. */
static void
lock_part(Oid mesh, int64 step, uint32 part)
{
	LOCKTAG		tag;

	/* no advisory lock of a user has 3 at the end */
	SET_LOCKTAG_ADVISORY(tag, MyDatabaseId, mesh, (uint32) (step ^ (step >> 32)) * 0x9e3779b9 + part, 3);
	(void) LockAcquire(&tag, ExclusiveLock, false, false);
}

/* Runs the INSERT. An id of another part, stored when the mesh was cut otherwise, is in the way. */
static void
insert_rows(const char *table, const char *statement, uint64 rows)
{
	MemoryContext memory = CurrentMemoryContext;

	PG_TRY();
	{
		query_change(table, "steps", statement, rows);
	}
	PG_CATCH();
	{
		ErrorData  *error;

		MemoryContextSwitchTo(memory);
		error = CopyErrorData();
		if (error->sqlerrcode != ERRCODE_UNIQUE_VIOLATION)
			PG_RE_THROW();
		FlushErrorState();
		ereport(ERROR,
				(errcode(ERRCODE_UNIQUE_VIOLATION),
				 errmsg("another part has stored a vertex of this part at this step"),
				 error->detail != NULL ? errdetail_internal("%s", error->detail) : 0,
				 errhint("All parts of a step must be cut in the same way: delete the rows of the step, or "
						 "choose another number. Vertices must have ids of their own.")));
	}
	PG_END_TRY();
}

/* Puts the rows in place of those that the part has at the step. */
static void
replace_rows(const char *table, int64 step, uint32 part, const PartMark *mark, uint64 rows)
{
	(void) query_run(psprintf("DELETE FROM %s WHERE step = '" INT64_FORMAT "' AND part = %u", table, step, part));
	insert_rows(table,
				psprintf("INSERT INTO %s (step, part, id, \"values\") SELECT '" INT64_FORMAT "'::int8, %u, id, \"values\" "
						 "FROM given UNION ALL SELECT '" INT64_FORMAT "', %u, NULL, ARRAY[%u, " UINT64_FORMAT
						 ", %u, %u, %u]::float8[]", table, step, part, step, part, mark->parts, rows,
						 (uint32) (mark->stamp >> 32), (uint32) mark->stamp, mark->values),
				rows + 1);
}

/*
 * abacus_store(mesh regclass, step bigint, parts int, part int, query text, weight text) -> bigint
 */
Datum
abacus_sql_store(PG_FUNCTION_ARGS)
{
	Oid			mesh_id;
	int64		step;
	uint32		part;
	Source		source;
	NamedRows  *given,
			   *own;
	Relation	mesh;
	PartMark	mark;
	char	   *table;
	uint64		rows;
	int			level;

	for (int i = STORE_MESH; i <= STORE_QUERY; i++)
		if (PG_ARGISNULL(i))
			ereport(ERROR,
					(errcode(ERRCODE_NULL_VALUE_NOT_ALLOWED),
					 errmsg("mesh, step, parts, part and query must not be NULL"),
					 errhint("Only weight may be NULL.")));
	mesh_id = PG_GETARG_OID(STORE_MESH);
	step = PG_GETARG_INT64(STORE_STEP);
	part = (uint32) PG_GETARG_INT32(STORE_PART);
	source_prepare(&source, text_to_cstring(PG_GETARG_TEXT_PP(STORE_QUERY)));
	given = read_rows(&source);
	rows = given->count;
	mark.values = (uint32) source_columns(&source) - 1;
	mesh = mesh_table_open(mesh_id, MESH_READ);
	own = find_own(fcinfo, &mark);
	refuse_own_changes(mesh_id, mark.stamp);
	named_rows_register(given);
	named_rows_register(own);
	level = plain_names_begin(false);
	check_ids(given, own, part);
	plain_names_end(level);
	table = steps_table_for(mesh, step);
	lock_part(mesh_id, step, part);
	level = plain_names_begin(false);
	replace_rows(table, step, part, &mark, rows);
	plain_names_end(level);
	named_rows_free(own);
	named_rows_free(given);
	table_close(mesh, NoLock);
	source_finish(&source);
	PG_RETURN_INT64((int64) rows);
}
