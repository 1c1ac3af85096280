/*
 * fn_thin.c: abacus_thin, which makes a mesh of some vertices of another one, within a stated error,
 * and abacus_thin_build, which commits after each step.
 *
 * What a step adds depends on the two meshes alone. So a build that was interrupted goes on by doing
 * all steps again: those that are done add nothing.
 */
#include "postgres.h"

#include <math.h>

#include "access/table.h"
#include "catalog/namespace.h"
#include "executor/spi.h"
#include "storage/lmgr.h"
#include "utils/builtins.h"
#include "utils/lsyscache.h"

#include "pg/base/commits.h"
#include "pg/base/settings.h"
#include "pg/base/sql_function.h"
#include "pg/mesh/lines_table.h"
#include "pg/mesh/new_mesh.h"
#include "pg/mesh/new_table.h"
#include "pg/sql/thin/thinning_table.h"
#include "pg/sql/arguments/attribute.h"
#include "pg/sql/thin/kept.h"

SQL_FUNCTION(abacus_sql_thin);
SQL_FUNCTION(abacus_sql_thin_build);

/* Arguments */
enum
{
	OF_MESH,
	OF_NEW_MESH,
	OF_MAX_ERROR,
	OF_ATTRIBUTE,
	OF_KEEP,
	OF_TARGET
};

/* A call: what to do, and what is known of the mesh. */
typedef struct Thinning
{
	Thinner		thinner;
	Kept		kept;
	ThinningRow row;
	abacus_header *header;		/* of a new mesh like the source */
	uint64		beside;			/* points of the source that are not vertices */
	bool		has_lines;		/* the source */
	bool		fills_holes;	/* the new mesh, as the source is not convex */
	char	   *lost;			/* what the source has and the new mesh does not get; NULL: nothing */
	bool		goes_on;		/* after an interrupted call */
} Thinning;

static void
check_arguments(FunctionCallInfo fcinfo)
{
	double		max_error;

	if (PG_ARGISNULL(OF_MESH) || PG_ARGISNULL(OF_NEW_MESH) || PG_ARGISNULL(OF_MAX_ERROR))
		ereport(ERROR,
				(errcode(ERRCODE_NULL_VALUE_NOT_ALLOWED),
				 errmsg("mesh, new_mesh and max_error must not be NULL"),
				 errhint("max_error is in units of the attribute. With target, it may be 0.")));
	max_error = PG_GETARG_FLOAT8(OF_MAX_ERROR);
	if (!(max_error >= 0) || isinf(max_error))
		ereport(ERROR,
				(errcode(ERRCODE_INVALID_PARAMETER_VALUE),
				 errmsg("max_error must be finite and not negative"),
				 errhint("Give the greatest difference between the values of vertices and the new surface.")));
	if (!PG_ARGISNULL(OF_TARGET) && PG_GETARG_INT64(OF_TARGET) < 1)
		ereport(ERROR,
				(errcode(ERRCODE_INVALID_PARAMETER_VALUE),
				 errmsg("target must be at least 1"),
				 errhint("Give the number of vertices at which the new mesh stops, or leave target out.")));
}

static void
check_source(const Reader *source, Oid mesh, bool keeps_lines)
{
	const abacus_census *census = &source->header.facts.census;

	if (thinning_is_unfinished(mesh))
		ereport(ERROR,
				(errcode(ERRCODE_OBJECT_NOT_IN_PREREQUISITE_STATE),
				 errmsg("mesh \"%s\" is not finished", get_rel_name(mesh)),
				 errdetail("It is being thinned by abacus_thin_build()."),
				 errhint("CALL abacus_thin_build() again with the same arguments: it goes on from its last round.")));
	if (census->simplices == 0)
		ereport(ERROR,
				(errcode(ERRCODE_OBJECT_NOT_IN_PREREQUISITE_STATE),
				 errmsg("mesh \"%s\" has no simplices", get_rel_name(mesh)),
				 errhint("Insert points first; those that wait come in with abacus_triangulate().")));
	if (census->split > 0)
		ereport(ERROR,
				(errcode(ERRCODE_OBJECT_NOT_IN_PREREQUISITE_STATE),
				 errmsg("mesh \"%s\" has several vertices at one place", get_rel_name(mesh)),
				 errdetail("The surface has no single value there."),
				 errhint("Triangulate its vertices anew, by abacus_load() with retriangulate => true.")));
	if (census->lines_wait > 0 && keeps_lines)
		ereport(ERROR,
				(errcode(ERRCODE_OBJECT_NOT_IN_PREREQUISITE_STATE),
				 errmsg("lines of mesh \"%s\" wait for points", get_rel_name(mesh)),
				 errhint("Insert the points that wait, with abacus_triangulate(), or leave the lines out "
						 "with keep => 'none'.")));
}

/* What a mesh has that a thinned one does not get, in words; NULL if it has nothing of that kind. */
static char *
lost_of(const abacus_census *census)
{
	const char *const found[] = {
		census->labelled > 0 ? "labels" : NULL, census->marked > 0 ? "markers" : NULL,
		census->regions > 0 ? "regions" : NULL
	};
	char	   *text = NULL;

	for (int i = lengthof(found); i-- > 0;)
		if (found[i] != NULL)
			text = text == NULL ? pstrdup(found[i])
				: psprintf("%s%s%s", found[i], strchr(text, ' ') == NULL ? " and " : ", ", text);
	return text;
}

/* The header of a new mesh like the source: its form and the names of its attributes. */
static abacus_header *
header_like(const abacus_header *source)
{
	abacus_header *header = palloc0(sizeof(abacus_header));

	header->facts.form = source->facts.form;
	header->facts.columns.attributes = source->facts.columns.attributes;
	memcpy(header->names, source->names, source->facts.columns.attributes * sizeof(header->names[0]));
	memcpy(header->types, source->types, source->facts.columns.attributes);
	return header;
}

static Thinning *
read_arguments(FunctionCallInfo fcinfo, const char *command)
{
	Thinning   *thinning = palloc0(sizeof(Thinning));
	Thinner    *thinner = &thinning->thinner;
	ThinningRow *row = &thinning->row;
	Reader	   *source;

	check_arguments(fcinfo);
	thinner->source = PG_GETARG_OID(OF_MESH);
	thinner->command = command;
	row->keep = PG_ARGISNULL(OF_KEEP) ? NULL : text_to_cstring(PG_GETARG_TEXT_PP(OF_KEEP));
	kept_parse(row->keep, &thinning->kept);

	source = reader_open(thinner->source, CurrentMemoryContext);
	check_source(source, thinner->source, thinning->kept.lines);
	thinner->stamp = source->header.stamp;
	thinner->options.attribute = attribute_argument(fcinfo, OF_ATTRIBUTE, abacus_names_of(&source->header));
	thinner->options.max_error = PG_GETARG_FLOAT8(OF_MAX_ERROR);
	thinner->options.target = PG_ARGISNULL(OF_TARGET) ? 0 : (uint64) PG_GETARG_INT64(OF_TARGET);
	thinner->options.sort_bytes = setting_sort_bytes() / 2;
	thinner->options.cache_bytes = setting_cache_bytes();
	thinning->header = header_like(&source->header);
	thinning->has_lines = source->header.facts.census.lines > 0;
	thinning->kept.lines = thinning->kept.lines && thinning->has_lines;
	thinning->fills_holes = source->header.facts.standing == ABACUS_NOT_CONVEX;
	thinning->lost = lost_of(&source->header.facts.census);
	thinning->beside = source->header.facts.census.duplicates;
	if (abacus_is_own(source->header.facts.standing))
		thinning->beside += source->header.facts.census.staged - source->header.facts.census.inserted;

	row->mesh = lines_table_name(thinner->source);
	row->stamp = (int64) thinner->stamp;
	row->attribute = pstrdup(source->header.names[thinner->options.attribute]);
	row->max_error = thinner->options.max_error;
	row->target = (int64) thinner->options.target;
	host_release(source->host);
	host_destroy(source->host);
	return thinning;
}

/* Makes the new mesh, and beside it the row that says how it is thinned. */
static void
make_mesh(Thinning *thinning, text *name, Oid extension_namespace)
{
	Thinner    *thinner = &thinning->thinner;
	Relation	mesh;

	thinner->mesh = new_mesh(name, extension_namespace, thinning->header, thinner->command);
	mesh = mesh_table_open(thinner->mesh, MESH_WRITE);
	thinning_table_make(mesh, &thinning->row);
	table_close(mesh, NoLock);
	CommandCounterIncrement();
}

static void
finish_row(const Thinner *thinner, double greatest)
{
	Relation	mesh = mesh_table_open(thinner->mesh, MESH_WRITE);

	thinning_table_finish(mesh, greatest);
	table_close(mesh, NoLock);
}

static void
notice_left_out(const Thinning *thinning, uint64 without_value)
{
	const char *mesh = get_rel_name(thinning->thinner.source);

	if (without_value > 0)
		ereport(NOTICE,
				(errmsg_plural(UINT64_FORMAT " vertex of mesh \"%s\" has no value of \"%s\" and is left out",
							   UINT64_FORMAT " vertices of mesh \"%s\" have no value of \"%s\" and are left out",
							   (unsigned long) without_value, without_value, mesh, thinning->row.attribute)));
	if (thinning->beside > 0)
		ereport(NOTICE,
				(errmsg_plural(UINT64_FORMAT " point of mesh \"%s\" is a duplicate or waits, and is left out",
							   UINT64_FORMAT " points of mesh \"%s\" are duplicates or wait, and are left out",
							   (unsigned long) thinning->beside, thinning->beside, mesh)));
	if (thinning->lost != NULL)
		ereport(NOTICE,
				(errmsg("mesh \"%s\" does not get the %s of mesh \"%s\"", get_rel_name(thinning->thinner.mesh),
						thinning->lost, mesh)));
	if (thinning->fills_holes)
		ereport(WARNING,
				(errmsg("mesh \"%s\" has holes or notches, which mesh \"%s\" fills", mesh,
						get_rel_name(thinning->thinner.mesh)),
				 errdetail("A thinned mesh is the Delaunay triangulation of the vertices that stay, and covers their convex hull."),
				 errhint("In functions that read the new mesh, leave out long edges with max_edge, or all outside a polygon "
						 "with within.")));
}

/* Others may have changed the mesh between two calls: its vertices are then not those of the rounds. */
static void
require_untouched(const Thinning *thinning)
{
	const Thinner *thinner = &thinning->thinner;

	if ((int64) thinner->writer.header->stamp != thinning->row.reached)
		ereport(ERROR,
				(errcode(ERRCODE_OBJECT_NOT_IN_PREREQUISITE_STATE),
				 errmsg("mesh \"%s\" has changed since its last round", get_rel_name(thinner->mesh)),
				 errhint("Drop it, and thin anew.")));
}

/* All steps; returns the greatest error. */
static double
thin(Thinning *thinning, Oid extension_namespace)
{
	Thinner    *thinner = &thinning->thinner;
	double		greatest;
	uint64		without_value;

	/* what may find bad input comes first: after an error there is no mesh */
	thinner->holds = true;
	thinner_begin(thinner);
	if (thinning->goes_on)
		require_untouched(thinning);
	if (thinner->writer.header->facts.census.vertices == 0)
		thinner_step(thinner, ABACUS_THIN_START);
	kept_insert(thinner, &thinning->kept);
	if (thinning->kept.lines && thinner->writer.header->facts.census.lines == 0)
	{
		thinner_end(thinner);
		kept_constrain(thinner, extension_namespace);
		thinner_begin(thinner);
	}
	thinner->holds = false;
	while (thinner_step(thinner, ABACUS_THIN_HULL) > 0)
		;
	while (thinner_step(thinner, ABACUS_THIN_WORST) > 0)
		;
	greatest = thinner_greatest(thinner, &without_value);
	writer_end(&thinner->writer);
	finish_row(thinner, greatest);
	notice_left_out(thinning, without_value);
	return greatest;
}

/*
 * abacus_thin(mesh regclass, new_mesh text, max_error float8, attribute text, keep text,
 *             target bigint) -> float8
 */
Datum
abacus_sql_thin(PG_FUNCTION_ARGS)
{
	Oid			extension_namespace = get_func_namespace(fcinfo->flinfo->fn_oid);
	Thinning   *thinning = read_arguments(fcinfo, "abacus_thin()");

	make_mesh(thinning, PG_GETARG_TEXT_PP(OF_NEW_MESH), extension_namespace);
	PG_RETURN_FLOAT8(thin(thinning, extension_namespace));
}

/* ---- abacus_thin_build -------------------------------------------------------------------- */

static bool
is_same_text(const char *a, const char *b)
{
	return a == NULL || b == NULL ? a == b : strcmp(a, b) == 0;
}

/* Whether there is a mesh of this name that a call with the same arguments has left unfinished. */
static bool
find_unfinished(Thinning *thinning, text *name)
{
	ThinningRow *wanted = &thinning->row;
	ThinningRow found;
	Oid			mesh = RangeVarGetRelid(new_table_name(name), NoLock, true);
	Relation	table;
	bool		is_there;

	if (!OidIsValid(mesh) || mesh_of_table(mesh) != mesh)
		return false;
	table = mesh_table_open(mesh, MESH_WRITE);
	is_there = thinning_table_read(table, &found) && !found.is_done;
	table_close(table, NoLock);
	if (!is_there)
		return false;
	if (!is_same_text(found.mesh, wanted->mesh) || !is_same_text(found.attribute, wanted->attribute) ||
		found.max_error != wanted->max_error || !is_same_text(found.keep, wanted->keep) ||
		found.target != wanted->target)
		ereport(ERROR,
				(errcode(ERRCODE_OBJECT_NOT_IN_PREREQUISITE_STATE),
				 errmsg("mesh \"%s\" is not finished, and was begun with other arguments", get_rel_name(mesh)),
				 errhint("Its table \"%s" THINNING_TABLE_SUFFIX "\" has them. Call abacus_thin_build() with "
						 "those, or drop the mesh.", get_rel_name(mesh))));
	thinning->thinner.mesh = mesh;
	thinning->thinner.stamp = (uint64) found.stamp;
	thinning->row.reached = found.reached;
	thinning->goes_on = true;
	return true;
}

/*
 * abacus_thin_build(mesh regclass, new_mesh text, max_error float8, attribute text, keep text,
 *                   target bigint), a procedure
 */
Datum
abacus_sql_thin_build(PG_FUNCTION_ARGS)
{
	Oid			extension_namespace = get_func_namespace(fcinfo->flinfo->fn_oid);
	Thinning   *thinning;
	Thinner    *thinner;
	LockRelId	source_lock;
	LockRelId	mesh_lock;
	Relation	source;

	require_commits(fcinfo, "abacus_thin_build", "round", "abacus_thin");
	SPI_connect_ext(SPI_OPT_NONATOMIC); /* its memory outlives transactions */
	thinning = read_arguments(fcinfo, "abacus_thin_build()");
	thinner = &thinning->thinner;
	thinner->commits = true;
	source = mesh_table_open(thinner->source, MESH_READ);
	source_lock = source->rd_lockInfo.lockRelId;
	LockRelationIdForSession(&source_lock, AccessShareLock);	/* it is not dropped meanwhile */
	table_close(source, NoLock);
	if (!find_unfinished(thinning, PG_GETARG_TEXT_PP(OF_NEW_MESH)))
		make_mesh(thinning, PG_GETARG_TEXT_PP(OF_NEW_MESH), extension_namespace);
	mesh_lock = mesh_lock_for_session(thinner->mesh);
	thin(thinning, extension_namespace);
	SPI_finish();
	UnlockRelationIdForSession(&mesh_lock, ShareRowExclusiveLock);
	UnlockRelationIdForSession(&source_lock, AccessShareLock);
	PG_RETURN_VOID();
}
