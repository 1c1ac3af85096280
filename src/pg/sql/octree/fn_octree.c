/*
 * fn_octree.c: makes and changes octrees.
 *
 * Each change happens inside one call, with the header locked, like a change of a mesh. Growth
 * finds the octants to split, and rewrites the pages if there are any; its sorts take
 * maintenance_work_mem, beyond that temporary files.
 */
#include "postgres.h"

#include <math.h>

#include "utils/builtins.h"
#include "utils/lsyscache.h"

#include "abacus/octree.h"
#include "pg/base/settings.h"
#include "pg/base/sql_function.h"
#include "pg/input/source.h"
#include "pg/mesh/new_mesh.h"
#include "pg/mesh/shape.h"
#include "pg/mesh/writer.h"
#include "pg/sql/octree/octree_growth.h"

SQL_FUNCTION(abacus_sql_octree_create);
SQL_FUNCTION(abacus_sql_octree_from_points);
SQL_FUNCTION(abacus_sql_octree_from_rows);
SQL_FUNCTION(abacus_sql_octree_refine);
SQL_FUNCTION(abacus_sql_octree_coarsen);
SQL_FUNCTION(abacus_sql_octree_update);
SQL_FUNCTION(abacus_sql_octree_balance);

/* ---- Creating ------------------------------------------------------------ */

/* The finest level allowed for leaves. */
static void
set_levels(abacus_form *form, int32 levels)
{
	int32		most = (int32) abacus_octree_levels(form->dimension);

	if (levels < 0 || levels > most)
		ereport(ERROR,
				(errcode(ERRCODE_INVALID_PARAMETER_VALUE),
				 errmsg("levels must be from 0 to %d, not %d", most, levels)));
	form->levels = (uint32) levels;
}

/* A span that a double cannot hold is not a valid domain. */
static void
check_span(const abacus_form *form)
{
	for (uint32 i = 0; i < form->dimension; i++)
		if (!isfinite(form->upper[i] - form->lower[i]))
			ereport(ERROR,
					(errcode(ERRCODE_INVALID_PARAMETER_VALUE),
					 errmsg("the domain is too long on axis %c", "xyz"[i])));
}

/*
 * abacus_octree_create(octree text, dimension int, lower float8[], upper float8[],
 * attributes text[], levels int) -> regclass
 */
Datum
abacus_sql_octree_create(PG_FUNCTION_ARGS)
{
	abacus_header *header = palloc0(sizeof(abacus_header));

	for (int i = 0; i < 4; i++)
		if (PG_ARGISNULL(i))
			ereport(ERROR,
					(errcode(ERRCODE_NULL_VALUE_NOT_ALLOWED),
					 errmsg("octree, dimension, lower and upper must not be NULL")));
	header->facts.form.type = ABACUS_OCTREE;
	shape_dimension(&header->facts.form, PG_GETARG_INT32(1));
	shape_domain(&header->facts.form, PG_GETARG_ARRAYTYPE_P(2), PG_GETARG_ARRAYTYPE_P(3));
	check_span(&header->facts.form);
	if (!PG_ARGISNULL(4))
		shape_attributes(header, PG_GETARG_ARRAYTYPE_P(4));
	set_levels(&header->facts.form,
			   PG_ARGISNULL(5) ? (int32) abacus_octree_levels(header->facts.form.dimension)
			   : PG_GETARG_INT32(5));
	PG_RETURN_OID(new_mesh(PG_GETARG_TEXT_PP(0), get_func_namespace(fcinfo->flinfo->fn_oid),
						   header, "abacus_octree_create()"));
}

/* ---- Changes by the rows of a query ---------------------------------------- */

typedef abacus_status (*AddRows) (void *handle, const uint64 *rows, size_t count,
								  abacus_error *error);

/* An open octree, and the prepared query whose rows change it. */
typedef struct OctreeChange
{
	Writer		writer;
	Source		source;
} OctreeChange;

static void
begin(OctreeChange *change, FunctionCallInfo fcinfo, const char *command)
{
	source_prepare(&change->source, text_to_cstring(PG_GETARG_TEXT_PP(1)));
	writer_begin_of(&change->writer, PG_GETARG_OID(0), ABACUS_OCTREE, command);
}

/*
 * Passes the rows of the query to the core's handle. An octree without SRID takes that of
 * geometries.
 */
static void
read_rows(OctreeChange *change, OctantRows kind, AddRows add)
{
	Host	   *host = change->writer.host;
	abacus_header *header = change->writer.header;
	abacus_progress progress = {.phase = ABACUS_PHASE_READING};
	const uint64 *rows;
	size_t		count;

	source_open_octants(&change->source, abacus_names_of(header), kind, true);
	while ((count = source_fetch(&change->source, &rows)) > 0)
	{
		host_run(host, add, host->handle, rows, count);
		progress.done += count;
		progress_report(&host->progress, &progress);
	}
	if (change->source.packer->srid > 0)
		header->facts.form.srid = (uint32) change->source.packer->srid;
	source_close(&change->source);
}

/* Writes the header and closes the octree; returns the number of its leaves. */
static int64
end(OctreeChange *change)
{
	int64		leaves = (int64) change->writer.header->facts.census.leaves;

	writer_end(&change->writer);
	source_finish(&change->source);
	return leaves;
}

/* Opens the growth of an octree as the handle of its host. */
void
octree_growth_open(Writer *writer)
{
	abacus_octree_growth *growth = NULL;
	Host	   *host = writer->host;

	host_run(host, abacus_octree_growth_open, &host->table, &writer->header->facts, setting_sort_bytes(),
			 &growth);
	host_own(host, growth, (void (*) (void *)) abacus_octree_growth_close);
}

static void
open_edit(Writer *writer)
{
	abacus_octree_edit *edit = NULL;
	Host	   *host = writer->host;

	host_run(host, abacus_octree_edit_open, &host->table, &writer->header->facts, setting_sort_bytes(),
			 setting_cache_bytes(), &edit);
	host_own(host, edit, (void (*) (void *)) abacus_octree_edit_close);
}

static abacus_status
add_points(void *growth, const uint64 *rows, size_t count, abacus_error *error)
{
	return abacus_octree_growth_add(growth, rows, count, 0, error);
}

static abacus_status
add_places(void *growth, const uint64 *rows, size_t count, abacus_error *error)
{
	return abacus_octree_growth_add(growth, rows, count, 1, error);
}

static abacus_status
add_leaves(void *load, const uint64 *rows, size_t count, abacus_error *error)
{
	return abacus_octree_load_add(load, rows, count, error);
}

static abacus_status
add_merges(void *edit, const uint64 *rows, size_t count, abacus_error *error)
{
	return abacus_octree_edit_add_merges(edit, rows, count, error);
}

static abacus_status
add_values(void *edit, const uint64 *rows, size_t count, abacus_error *error)
{
	return abacus_octree_edit_add_values(edit, rows, count, error);
}

/* abacus_octree_from_points(octree regclass, query text, most_in_leaf int) -> bigint */
Datum
abacus_sql_octree_from_points(PG_FUNCTION_ARGS)
{
	int32		most = PG_GETARG_INT32(2);
	OctreeChange change;
	Host	   *host;

	if (most < 1)
		ereport(ERROR,
				(errcode(ERRCODE_INVALID_PARAMETER_VALUE),
				 errmsg("most_in_leaf must be at least 1, not %d", most)));
	begin(&change, fcinfo, "abacus_octree_from_points()");
	host = change.writer.host;
	octree_growth_open(&change.writer);
	read_rows(&change, OCTANT_POINTS, add_points);
	host_run(host, abacus_octree_growth_points, host->handle, (uint64) most, change.writer.header);
	PG_RETURN_INT64(end(&change));
}

/* abacus_octree_refine(octree regclass, query text) -> bigint */
Datum
abacus_sql_octree_refine(PG_FUNCTION_ARGS)
{
	OctreeChange change;
	Host	   *host;

	begin(&change, fcinfo, "abacus_octree_refine()");
	host = change.writer.host;
	octree_growth_open(&change.writer);
	read_rows(&change, OCTANT_PLACES, add_places);
	host_run(host, abacus_octree_growth_levels, host->handle, change.writer.header);
	PG_RETURN_INT64(end(&change));
}

/* abacus_octree_coarsen(octree regclass, query text) -> bigint */
Datum
abacus_sql_octree_coarsen(PG_FUNCTION_ARGS)
{
	OctreeChange change;
	Host	   *host;

	begin(&change, fcinfo, "abacus_octree_coarsen()");
	host = change.writer.host;
	open_edit(&change.writer);
	read_rows(&change, OCTANT_PLACES, add_merges);
	host_run(host, abacus_octree_edit_merge, host->handle, change.writer.header);
	PG_RETURN_INT64(end(&change));
}

/* abacus_octree_update(octree regclass, query text) -> bigint */
Datum
abacus_sql_octree_update(PG_FUNCTION_ARGS)
{
	OctreeChange change;
	Host	   *host;
	uint64		set;

	begin(&change, fcinfo, "abacus_octree_update()");
	host = change.writer.host;
	header_require_attributes(&change.writer.header->facts);
	open_edit(&change.writer);
	read_rows(&change, OCTANT_VALUES, add_values);
	host_run(host, abacus_octree_edit_set, host->handle, change.writer.header, &set);
	end(&change);
	PG_RETURN_INT64((int64) set);
}

/* abacus_octree_from_rows(octree regclass, query text) -> bigint */
Datum
abacus_sql_octree_from_rows(PG_FUNCTION_ARGS)
{
	abacus_octree_load *load = NULL;
	OctreeChange change;
	Host	   *host;

	begin(&change, fcinfo, "abacus_octree_from_rows()");
	host = change.writer.host;
	host_run(host, abacus_octree_load_open, &host->table, &change.writer.header->facts,
			 setting_sort_bytes(), &load);
	host_own(host, load, (void (*) (void *)) abacus_octree_load_close);
	read_rows(&change, OCTANT_LEAVES, add_leaves);
	host_run(host, abacus_octree_load_write, load, change.writer.header);
	PG_RETURN_INT64(end(&change));
}

/* ---- Balance ----------------------------------------------------------------- */

/* Whether to balance leaves across faces, edges or corners, from an argument. */
static int32
across_what(text *given, uint32 dimension)
{
	char	   *name = text_to_cstring(given);

	if (strcmp(name, "faces") == 0)
		return 1;
	if (strcmp(name, "edges") == 0 && dimension == 3)
		return 2;
	if (strcmp(name, "corners") == 0)
		return (int32) dimension;
	ereport(ERROR,
			(errcode(ERRCODE_INVALID_PARAMETER_VALUE),
			 errmsg("across must not be \"%s\"", name),
			 dimension == 3 ? errhint("Use 'faces', 'edges' or 'corners'.")
			 : errhint("In the plane, use 'faces' or 'corners'.")));
	return 0;					/* not reached */
}

/* abacus_octree_balance(octree regclass, across text) -> bigint */
Datum
abacus_sql_octree_balance(PG_FUNCTION_ARGS)
{
	Writer		writer;
	int32		across;
	int64		leaves;

	writer_begin_of(&writer, PG_GETARG_OID(0), ABACUS_OCTREE, "abacus_octree_balance()");
	across = across_what(PG_GETARG_TEXT_PP(1), writer.header->facts.form.dimension);
	octree_growth_open(&writer);
	host_run(writer.host, abacus_octree_growth_balance, writer.host->handle, across,
			 writer.header);
	leaves = (int64) writer.header->facts.census.leaves;
	writer_end(&writer);
	PG_RETURN_INT64(leaves);
}
