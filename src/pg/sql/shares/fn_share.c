/*
 * fn_share.c: abacus_share_vertices and abacus_share_simplices, what a rank of a parallel program
 * gets of a mesh: its part, and layers of simplices around it.
 *
 * Both cut the mesh in the session's cache, which keeps the cut while the mesh stays as it is.
 */
#include "postgres.h"

#include "funcapi.h"

#include "pg/base/settings.h"
#include "pg/base/sql_function.h"
#include "pg/host/guard.h"
#include "pg/mesh/mesh_cache.h"
#include "pg/sql/rows/answers.h"
#include "pg/sql/shares/share_arguments.h"

SQL_FUNCTION(abacus_sql_share_vertices);
SQL_FUNCTION(abacus_sql_share_simplices);

/* Arguments of both */
enum
{
	SHARE_MESH,
	SHARE_PARTS,
	SHARE_PART,
	SHARE_HALO,
	SHARE_WEIGHT
};

/* Columns of abacus_share_vertices */
enum
{
	VERTEX_LOCAL,
	VERTEX_ID,
	VERTEX_OWNER,
	VERTEX_X,
	VERTEX_ATTRIBUTES = VERTEX_X + ABACUS_MAX_DIMENSION,
	VERTEX_COLUMNS
};

/* Columns of abacus_share_simplices */
enum
{
	SIMPLEX_CODE,
	SIMPLEX_V0,
	SIMPLEX_OWNER = SIMPLEX_V0 + ABACUS_MAX_DIMENSION + 1,
	SIMPLEX_LABELS,
	SIMPLEX_MARKERS,
	SIMPLEX_COLUMNS
};

static uint32
halo_argument(FunctionCallInfo fcinfo)
{
	int32		halo = PG_GETARG_INT32(SHARE_HALO);

	if (halo < 0)
		ereport(ERROR,
				(errcode(ERRCODE_INVALID_PARAMETER_VALUE),
				 errmsg("halo must be at least 0, not %d", halo),
				 errhint("halo is the number of layers of simplices around the part.")));
	return (uint32) halo;
}

/* The mesh in the session's cache, and the share; false if an argument is NULL. */
static bool
begin(FunctionCallInfo fcinfo, Answers *answers, CachedMesh **cached, abacus_share *share)
{
	InitMaterializedSRF(fcinfo, 0);
	for (int i = SHARE_MESH; i <= SHARE_HALO; i++)
		if (PG_ARGISNULL(i))
			return false;
	*cached = mesh_cache_get(PG_GETARG_OID(SHARE_MESH));
	cut_arguments(fcinfo, SHARE_PARTS, SHARE_WEIGHT, abacus_names_of(&(*cached)->header), &share->cut);
	share->part = part_argument(fcinfo, SHARE_PART, &share->cut);
	share->halo = halo_argument(fcinfo);
	answers->set = (ReturnSetInfo *) fcinfo->resultinfo;
	answers->host = (*cached)->host;
	answers->facts = &(*cached)->header.facts;
	answers_have_arrays(answers, 0);
	progress_begin(&answers->host->progress, PG_GETARG_OID(SHARE_MESH));
	return true;
}

static void
done(const Answers *answers)
{
	progress_end(&answers->host->progress);
	host_release(answers->host);
}

/* Adds a row; called by the core. */
static abacus_host_status
put_vertex(void *context, const abacus_share_vertex *vertex)
{
	const Answers *answers = context;
	Datum		values[VERTEX_COLUMNS] = {0};
	bool		isnull[VERTEX_COLUMNS] = {false};

	GUARD_BEGIN();
	values[VERTEX_LOCAL] = Int64GetDatum((int64) vertex->local);
	values[VERTEX_ID] = Int64GetDatum(vertex->id);
	values[VERTEX_OWNER] = Int32GetDatum((int32) vertex->owner);
	for (uint32 i = 0; i < ABACUS_MAX_DIMENSION; i++)
	{
		isnull[VERTEX_X + i] = i >= answers->facts->form.dimension;
		values[VERTEX_X + i] = Float8GetDatum(vertex->point[i]);
	}
	values[VERTEX_ATTRIBUTES] = answers_array(answers, vertex->attributes,
											  answers->facts->columns.attributes);
	answers_add(answers, values, isnull);
	GUARD_END(answers->host);
	return ABACUS_HOST_OK;
}

/*
 * abacus_share_vertices(mesh regclass, parts int, part int, halo int, weight text)
 *     -> local, id, owner, x, y, z, attributes
 */
Datum
abacus_sql_share_vertices(PG_FUNCTION_ARGS)
{
	Answers		answers = {0};
	abacus_share share = {0};
	CachedMesh *cached;

	if (!begin(fcinfo, &answers, &cached, &share))
		PG_RETURN_NULL();
	host_run(answers.host, abacus_mesh_share_vertices, cached->mesh, &share,
			 setting_query_sort_bytes(), put_vertex, &answers);
	done(&answers);
	PG_RETURN_NULL();
}

/* Adds a row; called by the core. */
static abacus_host_status
put_simplex(void *context, const abacus_share_simplex *simplex)
{
	const Answers *answers = context;
	const abacus_facts *facts = answers->facts;
	uint32		corners = facts->form.dimension + 1;
	Datum		values[SIMPLEX_COLUMNS] = {0};
	bool		isnull[SIMPLEX_COLUMNS] = {false};

	GUARD_BEGIN();
	values[SIMPLEX_CODE] = Int64GetDatum((int64) simplex->simplex.code);
	for (uint32 i = 0; i <= ABACUS_MAX_DIMENSION; i++)
	{
		isnull[SIMPLEX_V0 + i] = i >= corners;
		values[SIMPLEX_V0 + i] = Int64GetDatum((int64) simplex->local[i]);
	}
	values[SIMPLEX_OWNER] = Int32GetDatum((int32) simplex->owner);
	isnull[SIMPLEX_LABELS] = facts->columns.labels == 0;
	if (facts->columns.labels > 0)
		values[SIMPLEX_LABELS] = answers_array(answers, simplex->labels, facts->columns.labels);
	isnull[SIMPLEX_MARKERS] = facts->census.marked == 0;
	if (facts->census.marked > 0)
		values[SIMPLEX_MARKERS] = answers_array(answers, simplex->markers, corners);
	answers_add(answers, values, isnull);
	GUARD_END(answers->host);
	return ABACUS_HOST_OK;
}

/*
 * abacus_share_simplices(mesh regclass, parts int, part int, halo int, weight text)
 *     -> code, v0, v1, v2, v3, owner, labels, markers
 */
Datum
abacus_sql_share_simplices(PG_FUNCTION_ARGS)
{
	Answers		answers = {0};
	abacus_share share = {0};
	CachedMesh *cached;

	if (!begin(fcinfo, &answers, &cached, &share))
		PG_RETURN_NULL();
	host_run(answers.host, abacus_mesh_share_simplices, cached->mesh, &share,
			 setting_query_sort_bytes(), put_simplex, &answers);
	done(&answers);
	PG_RETURN_NULL();
}
