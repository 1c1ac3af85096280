/*
 * fn_levels.c: levels of detail: coarser meshes beside a mesh, made by abacus_thin, made anew when the mesh
 * has changed, and dropped.
 *
 * All levels are thinned by one statement, so from one state of the mesh. A refresh replaces the rows of
 * their tables, as DELETE and INSERT do: until its commit others read the former ones, privileges and
 * published tables stay, and replicas follow. What is new is first made in temporary tables, which do
 * not reach replicas.
 */
#include "postgres.h"

#include <math.h>

#include "access/table.h"
#include "access/xact.h"
#include "catalog/namespace.h"
#include "catalog/pg_class.h"
#include "catalog/pg_type.h"
#include "executor/spi.h"
#include "funcapi.h"
#include "lib/stringinfo.h"
#include "miscadmin.h"
#include "utils/acl.h"
#include "utils/array.h"
#include "utils/builtins.h"
#include "utils/lsyscache.h"
#include "utils/snapmgr.h"

#include "pg/base/sql_function.h"
#include "pg/levels/levels_lock.h"
#include "pg/levels/levels_table.h"
#include "pg/lines/named_rows.h"
#include "pg/mesh/lines_table.h"
#include "pg/mesh/new_table.h"
#include "pg/mesh/reader.h"
#include "pg/mesh/shape.h"
#include "pg/port/port.h"
#include "pg/sql/arguments/attribute.h"

SQL_FUNCTION(abacus_sql_levels);
SQL_FUNCTION(abacus_sql_levels_refresh);
SQL_FUNCTION(abacus_sql_levels_drop);
SQL_FUNCTION(abacus_sql_level);

/* Arguments */
enum
{
	OF_MESH,
	OF_ERRORS,
	OF_ATTRIBUTE
};

/* Columns of the result */
enum
{
	MADE_LEVEL,
	MADE_MESH,
	MADE_ERROR,
	MADE_VERTICES,
	MADE_COLUMNS
};

/* A call, which runs as the owner of the mesh. */
typedef struct Levels
{
	Oid			mesh;
	char	   *extension;		/* schema */
	char	   *fresh;			/* begins the names of temporary meshes */
	Oid			user;
	int			security;
	int			settings;
} Levels;

/* ---- Running as the owner ----------------------------------------------------------------- */

/* The mesh and all beside it have one owner, also if a superuser calls. `command` names the function for messages. */
static void
begin_as_owner(Levels *levels, FunctionCallInfo fcinfo, Oid mesh, const char *command)
{
	Relation	rel;

	PreventCommandIfReadOnly(command);
	PreventCommandIfParallelMode(command);
	rel = mesh_table_open(mesh, MESH_READ);
	if (!object_ownercheck(RelationRelationId, mesh, GetUserId()))
		ereport(ERROR,
				(errcode(ERRCODE_INSUFFICIENT_PRIVILEGE),
				 errmsg("must be owner of mesh \"%s\" to make or change its levels", get_rel_name(mesh)),
				 errhint("Its owner can call abacus_levels(), and grant SELECT on the levels and on their table.")));
	levels->mesh = mesh;
	levels->extension = pstrdup(quote_identifier(get_namespace_name(get_func_namespace(fcinfo->flinfo->fn_oid))));
	GetUserIdAndSecContext(&levels->user, &levels->security);
	SetUserIdAndSecContext(rel->rd_rel->relowner, levels->security | SECURITY_LOCAL_USERID_CHANGE);
	table_close(rel, NoLock);
	SPI_connect();
	levels->settings = plain_names_begin(false);
}

static void
end_as_owner(const Levels *levels)
{
	plain_names_end(levels->settings);
	SPI_finish();
	SetUserIdAndSecContext(levels->user, levels->security);
}

static void
run(const char *command, int expected)
{
	int			status = SPI_execute(command, false, 0);

	if (status != expected)
		elog(ERROR, "could not run \"%s\": %s", command, SPI_result_code_string(status));
}

/* ---- The rows of the result --------------------------------------------------------------- */

static uint64
vertices_of(Oid mesh)
{
	Reader	   *reader = reader_open(mesh, CurrentMemoryContext);
	uint64		vertices = reader->header.facts.census.vertices;

	host_release(reader->host);
	host_destroy(reader->host);
	return vertices;
}

/* Returns the levels as they are now. */
static void
put_levels(FunctionCallInfo fcinfo, const Levels *called)
{
	ReturnSetInfo *set = (ReturnSetInfo *) fcinfo->resultinfo;
	Level	   *levels;
	int			count;

	CommandCounterIncrement();
	PushActiveSnapshot(GetLatestSnapshot());
	count = levels_read(mesh_find_rows_table(called->mesh, MESH_LEVELS), MESH_WRITE, &levels);
	for (int i = 0; i < count; i++)
	{
		bool		isnull[MADE_COLUMNS] = {false};
		Datum		values[MADE_COLUMNS] = {
			[MADE_LEVEL] = Int32GetDatum(levels[i].number),[MADE_MESH] = ObjectIdGetDatum(levels[i].mesh),
			[MADE_ERROR] = Float8GetDatum(levels[i].greatest),
			[MADE_VERTICES] = Int64GetDatum((int64) vertices_of(levels[i].mesh))
		};

		tuplestore_putvalues(set->setResult, set->setDesc, values, isnull);
	}
	PopActiveSnapshot();
}

/* ---- abacus_levels ------------------------------------------------------------------------ */

static Datum *
errors_argument(ArrayType *array, int *count)
{
	Datum	   *errors;

	if (ARR_NDIM(array) > 1 || array_contains_nulls(array))
		ereport(ERROR,
				(errcode(ERRCODE_NULL_VALUE_NOT_ALLOWED),
				 errmsg("errors must be a one-dimensional array without NULLs"),
				 errhint("Give the greatest error of each level, the finest level first.")));
	errors = shape_numbers(array, "errors", count);
	if (*count == 0)
		ereport(ERROR,
				(errcode(ERRCODE_INVALID_PARAMETER_VALUE),
				 errmsg("errors must not be empty"),
				 errhint("Give the greatest error of each level, the finest level first.")));
	for (int i = 0; i < *count; i++)
	{
		double		value = DatumGetFloat8(errors[i]);

		if (!(value >= 0) || isinf(value))
			ereport(ERROR,
					(errcode(ERRCODE_INVALID_PARAMETER_VALUE),
					 errmsg("errors must be finite and not negative"),
					 errhint("Give the greatest error of each level, in units of the attribute.")));
		if (i > 0 && !(value > DatumGetFloat8(errors[i - 1])))
			ereport(ERROR,
					(errcode(ERRCODE_INVALID_PARAMETER_VALUE),
					 errmsg("errors must increase"),
					 errhint("Give the finest level first, and each error once.")));
	}
	return errors;
}

/* The name of the attribute whose errors are meant. */
static char *
attribute_name(FunctionCallInfo fcinfo, Oid mesh)
{
	Reader	   *reader = reader_open(mesh, CurrentMemoryContext);
	char	   *name = reader->header.names[attribute_argument(fcinfo, OF_ATTRIBUTE, abacus_names_of(&reader->header))];

	host_release(reader->host);
	host_destroy(reader->host);
	return name;
}

static char *
level_name(const char *mesh, int number)
{
	return psprintf("%s_level_%d", mesh, number);
}

/* Thins the mesh to all levels, by one statement. */
static void
thin_to_levels(const Levels *called, const char *schema, const char *name, Datum *errors, int count,
			   const char *attribute)
{
	Datum	   *names = palloc(count * sizeof(Datum));
	Oid			types[] = {REGCLASSOID, TEXTARRAYOID, FLOAT8ARRAYOID, TEXTOID};
	Datum		values[4];

	for (int i = 0; i < count; i++)
		names[i] = CStringGetTextDatum(quote_qualified_identifier(schema, level_name(name, i + 1)));
	values[0] = ObjectIdGetDatum(called->mesh);
	values[1] = PointerGetDatum(construct_array(names, count, TEXTOID, -1, false, TYPALIGN_INT));
	values[2] = PointerGetDatum(construct_array(errors, count, FLOAT8OID, sizeof(float8), FLOAT8PASSBYVAL,
												TYPALIGN_DOUBLE));
	values[3] = CStringGetTextDatum(attribute);
	if (SPI_execute_with_args(psprintf("SELECT %s.abacus_thin($1, l.name, l.error, $4) FROM unnest($2, $3) AS l (name, error)",
									   called->extension), lengthof(types), types, values, NULL, false, 0) != SPI_OK_SELECT)
		elog(ERROR, "could not make levels: %s", SPI_result_code_string(SPI_result));
}

/* The table that says how a mesh was thinned just now, as a name in SQL. */
static char *
thinning_name(Relation mesh)
{
	return lines_table_name(mesh_rows_table(mesh, MESH_THINNING, MESH_READ));
}

/* Enters what has been made into the table of levels. */
static void
enter_levels(const Levels *called, Oid table, const char *schema, const char *name, int count)
{
	Oid			namespace = get_namespace_oid(schema, false);

	for (int i = 1; i <= count; i++)
	{
		Relation	level = mesh_table_open(new_table_id(namespace, level_name(name, i)), MESH_READ);

		run(psprintf("INSERT INTO %s SELECT %d, '%u'::regclass, attribute, max_error, greatest, stamp FROM %s",
					 lines_table_name(table), i, RelationGetRelid(level), thinning_name(level)), SPI_OK_INSERT);
		mesh_bind_table(called->mesh, RelationGetRelid(level));
		table_close(level, NoLock);
	}
}

/* abacus_levels(mesh regclass, errors float8[], attribute text) -> level, mesh, error, vertices */
Datum
abacus_sql_levels(PG_FUNCTION_ARGS)
{
	Levels		called;
	Relation	mesh;
	Datum	   *errors;
	char	   *schema;
	char	   *name;
	char	   *attribute;
	int			count;
	Oid			table;

	InitMaterializedSRF(fcinfo, 0);
	if (PG_ARGISNULL(OF_MESH) || PG_ARGISNULL(OF_ERRORS))
		ereport(ERROR,
				(errcode(ERRCODE_NULL_VALUE_NOT_ALLOWED),
				 errmsg("mesh and errors must not be NULL"),
				 errhint("errors are the greatest errors of the levels, the finest level first.")));
	errors = errors_argument(PG_GETARG_ARRAYTYPE_P(OF_ERRORS), &count);
	attribute = attribute_name(fcinfo, PG_GETARG_OID(OF_MESH));
	begin_as_owner(&called, fcinfo, PG_GETARG_OID(OF_MESH), "abacus_levels()");
	mesh = mesh_table_open(called.mesh, MESH_READ);
	name = pstrdup(RelationGetRelationName(mesh));
	schema = get_namespace_name(RelationGetNamespace(mesh));
	if (OidIsValid(mesh_rows_table(mesh, MESH_LEVELS, MESH_READ)) || levels_bound(called.mesh, MESH_READ, &(Oid *) {NULL}) > 0)
		ereport(ERROR,
				(errcode(ERRCODE_DUPLICATE_TABLE),
				 errmsg("mesh \"%s\" already has levels", name),
				 errhint("Make the same ones anew with abacus_levels_refresh(), or drop them first with "
						 "abacus_levels_drop().")));
	table = levels_table_make(mesh);
	table_close(mesh, NoLock);
	thin_to_levels(&called, schema, name, errors, count, attribute);
	enter_levels(&called, table, schema, name, count);
	put_levels(fcinfo, &called);
	end_as_owner(&called);
	PG_RETURN_NULL();
}

/* ---- abacus_levels_refresh ---------------------------------------------------------------- */

/* How names of temporary meshes begin that no relation or type of the session has. */
static char *
free_name(void)
{
	for (int n = 0;; n++)
	{
		char	   *prefix = psprintf("abacus_fresh_%d_level_", n);

		if (SPI_execute(psprintf("SELECT FROM pg_catalog.pg_type WHERE typnamespace = pg_catalog.pg_my_temp_schema() "
								 "AND pg_catalog.strpos(typname::text, '%s') > 0", prefix), false, 1) != SPI_OK_SELECT)
			elog(ERROR, "could not look for temporary tables");
		if (SPI_processed == 0)
			return prefix;
	}
}

static void
replace_rows(const char *of, const char *by)
{
	run(psprintf("DELETE FROM %s", of), SPI_OK_DELETE);
	run(psprintf("INSERT INTO %s SELECT * FROM %s", of, by), SPI_OK_INSERT);
}

/* The lines of the level become those of the fresh one; they may be its first, or none. */
static void
replace_lines(Relation level, Relation fresh)
{
	Oid			by = mesh_rows_table(fresh, MESH_LINES, MESH_READ);
	Oid			of = mesh_rows_table(level, MESH_LINES, MESH_WRITE);
	bool		is_new = false;

	if (!OidIsValid(by) && !OidIsValid(of))
		return;
	if (!OidIsValid(of))
		of = lines_table_make(level, &is_new);
	if (OidIsValid(by))
		replace_rows(lines_table_name(of), lines_table_name(by));
	else
		run(psprintf("DELETE FROM %s", lines_table_name(of)), SPI_OK_DELETE);
	if (is_new)
		lines_table_index(level);
}

/* Replaces all rows of a level, and its row in the table of levels; drops the fresh mesh. */
static void
replace_level(const Levels *called, Oid table, const Level *level)
{
	Oid			fresh = new_table_id(LookupNamespaceNoError("pg_temp"), psprintf("%s%d", called->fresh, level->number));
	Relation	by = mesh_table_open(fresh, MESH_READ);
	Relation	of = mesh_table_open(level->mesh, MESH_WRITE);
	Oid			thinning = mesh_rows_table(of, MESH_THINNING, MESH_WRITE);

	replace_rows(lines_table_name(level->mesh), lines_table_name(fresh));
	replace_rows(lines_table_name(mesh_vertex_table(of, MESH_WRITE)), lines_table_name(mesh_vertex_table(by, MESH_READ)));
	replace_lines(of, by);
	if (OidIsValid(thinning))	/* the table of levels says the same */
		replace_rows(lines_table_name(thinning), thinning_name(by));
	run(psprintf("UPDATE %s AS l SET greatest = t.greatest, stamp = t.stamp FROM %s AS t WHERE l.level = %d",
				 lines_table_name(table), thinning_name(by), level->number), SPI_OK_UPDATE);
	table_close(of, NoLock);
	table_close(by, NoLock);
	run(psprintf("DROP TABLE %s", lines_table_name(fresh)), SPI_OK_UTILITY);
}

/* abacus_levels_refresh(mesh regclass) -> level, mesh, error, vertices */
Datum
abacus_sql_levels_refresh(PG_FUNCTION_ARGS)
{
	Levels		called;
	Level	   *levels = NULL;
	Oid		   *bound;
	int			bound_count;
	int			count = 0;
	Oid			table;

	InitMaterializedSRF(fcinfo, 0);
	begin_as_owner(&called, fcinfo, PG_GETARG_OID(OF_MESH), "abacus_levels_refresh()");
	table = levels_lock(called.mesh, &bound, &bound_count);
	if (OidIsValid(table))
		count = levels_read(table, MESH_WRITE, &levels);
	levels_lock_each(called.mesh, levels, count, bound, bound_count);
	called.fresh = free_name();
	run(psprintf("SELECT %s.abacus_thin('%u', 'pg_temp.%s' || level, max_error, attribute) FROM %s",
				 called.extension, called.mesh, called.fresh, lines_table_name(table)), SPI_OK_SELECT);
	for (int i = 0; i < count; i++)
		replace_level(&called, table, &levels[i]);
	put_levels(fcinfo, &called);
	end_as_owner(&called);
	PG_RETURN_NULL();
}

/* ---- abacus_levels_drop, abacus_level ------------------------------------------------------- */

/*
 * abacus_levels_drop(mesh regclass) -> integer: levels that were dropped. These are the meshes that are bound
 * to the mesh, whatever their table says of them.
 */
Datum
abacus_sql_levels_drop(PG_FUNCTION_ARGS)
{
	Levels		called;
	Oid		   *bound;
	int			count;
	Oid			table;
	StringInfoData command;

	begin_as_owner(&called, fcinfo, PG_GETARG_OID(OF_MESH), "abacus_levels_drop()");
	table = levels_lock(called.mesh, &bound, &count);
	initStringInfo(&command);
	for (int i = 0; i < count; i++)
		appendStringInfo(&command, "%s%s", i > 0 ? ", " : "", lines_table_name(bound[i]));
	if (OidIsValid(table))
		appendStringInfo(&command, "%s%s", count > 0 ? ", " : "", lines_table_name(table));
	run(psprintf("DROP TABLE %s", command.data), SPI_OK_UTILITY);
	end_as_owner(&called);
	PG_RETURN_INT32(count);
}

/* abacus_level(mesh regclass, max_error float8) -> regclass */
Datum
abacus_sql_level(PG_FUNCTION_ARGS)
{
	PG_RETURN_OID(levels_choose(PG_GETARG_OID(0), PG_GETARG_FLOAT8(1), NULL));
}
