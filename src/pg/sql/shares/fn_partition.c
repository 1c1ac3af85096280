/*
 * fn_partition.c: abacus_partition, the sizes of the parts of a mesh.
 */
#include "postgres.h"

#include "funcapi.h"

#include "pg/base/settings.h"
#include "pg/base/sql_function.h"
#include "pg/mesh/mesh_cache.h"
#include "pg/sql/rows/answers.h"
#include "pg/sql/shares/share_arguments.h"

SQL_FUNCTION(abacus_sql_partition);

/* Arguments of abacus_partition */
enum
{
	PARTITION_MESH,
	PARTITION_PARTS,
	PARTITION_WEIGHT
};

/* Columns of its result */
enum
{
	PART_NUMBER,
	PART_VERTICES,
	PART_SIMPLICES,
	PART_CUT_FACETS,
	PART_HALO,
	PART_COLUMNS
};

/* Adds the row of a part; called by the core. */
static abacus_host_status
put_part(void *context, const abacus_part *part)
{
	const Datum values[PART_COLUMNS] = {
		Int32GetDatum((int32) part->part), Int64GetDatum((int64) part->vertices),
		Int64GetDatum((int64) part->simplices), Int64GetDatum((int64) part->cut_facets),
		Int64GetDatum((int64) part->halo)
	};
	const bool	isnull[PART_COLUMNS] = {false};

	return answers_put(context, values, isnull);
}

/*
 * abacus_partition(mesh regclass, parts int, weight text)
 *     -> part, vertices, simplices, cut_facets, halo
 */
Datum
abacus_sql_partition(PG_FUNCTION_ARGS)
{
	Answers		answers = {.set = (ReturnSetInfo *) fcinfo->resultinfo};
	abacus_cut	cut = {0};
	CachedMesh *cached;

	InitMaterializedSRF(fcinfo, 0);
	if (PG_ARGISNULL(PARTITION_MESH) || PG_ARGISNULL(PARTITION_PARTS))
		PG_RETURN_NULL();
	cached = mesh_cache_get(PG_GETARG_OID(PARTITION_MESH));
	cut_arguments(fcinfo, PARTITION_PARTS, PARTITION_WEIGHT, abacus_names_of(&cached->header), &cut);
	answers.host = cached->host;
	progress_begin(&cached->host->progress, PG_GETARG_OID(PARTITION_MESH));
	host_run(cached->host, abacus_mesh_parts, cached->mesh, &cut, setting_query_sort_bytes(),
			 put_part, &answers);
	progress_end(&cached->host->progress);
	host_release(cached->host);
	PG_RETURN_NULL();
}
