/*
 * fn_region.c: abacus_region, which gives a mesh regions, abacus_unregion, which takes one away, and
 * abacus_regions, which lists them.
 */
#include "postgres.h"

#include "funcapi.h"
#include "utils/builtins.h"

#include "pg/base/settings.h"
#include "pg/base/sql_function.h"
#include "pg/host/guard.h"
#include "pg/lines/named_rows.h"
#include "pg/lines/new_lines.h"
#include "pg/lines/new_regions.h"
#include "pg/mesh/mesh_cache.h"
#include "pg/mesh/mesh_regions.h"
#include "pg/mesh/regions_table.h"
#include "pg/port/port.h"

SQL_FUNCTION(abacus_sql_region);
SQL_FUNCTION(abacus_sql_unregion);
SQL_FUNCTION(abacus_sql_regions);

/* Columns of abacus_regions. */
enum
{
	REGIONS_REGION,
	REGIONS_NUMBER,
	REGIONS_TRIANGLES,
	REGIONS_AREA,
	REGIONS_EDGES,
	REGIONS_COLUMNS
};

/* abacus_region(mesh regclass, query text) -> bigint */
Datum
abacus_sql_region(PG_FUNCTION_ARGS)
{
	Source		source;
	Change	   *change;
	uint64		regions;

	source_prepare(&source, text_to_cstring(PG_GETARG_TEXT_PP(1)));
	change = change_begin(PG_GETARG_OID(0), "abacus_region()");
	new_lines_check_mesh(change);
	regions = new_regions_add(change, &source);
	if (regions > 0)
		change_end(change);
	else
		change_abandon(change);
	source_finish(&source);
	PG_RETURN_INT64((int64) regions);
}

/* abacus_unregion(mesh regclass, region text) -> void */
Datum
abacus_sql_unregion(PG_FUNCTION_ARGS)
{
	Change	   *change = change_begin(PG_GETARG_OID(0), "abacus_unregion()");

	new_lines_check_mesh(change);
	new_regions_remove(change, text_to_cstring(PG_GETARG_TEXT_PP(1)));
	change_end(change);
	PG_RETURN_VOID();
}

/* ---- abacus_regions -------------------------------------------------------------------- */

#define REGION_SIZES "abacus_region_sizes"

typedef struct Sizes
{
	Host	   *host;
	NamedRows  *rows;
} Sizes;

/* Called by the core. */
static abacus_host_status
put_size(void *context, const abacus_region_size *size)
{
	const Sizes *sizes = context;
	Datum		values[4];
	bool		isnull[4] = {false};

	GUARD_BEGIN();
	values[0] = Int32GetDatum((int32) size->region);
	values[1] = Int64GetDatum((int64) size->triangles);
	values[2] = Float8GetDatum(size->area);
	values[3] = Int64GetDatum((int64) size->edges);
	named_rows_put(sizes->rows, values, isnull);
	GUARD_END(sizes->host);
	return ABACUS_HOST_OK;
}

/* The sizes of all regions that have triangles, as rows with a name. */
static NamedRows *
read_sizes(CachedMesh *cached)
{
	static const NamedColumn columns[] = {
		{"number", INT4OID}, {"triangles", INT8OID}, {"area", FLOAT8OID}, {"edges", INT8OID}
	};
	Sizes		sizes = {cached->host, named_rows_create(REGION_SIZES, columns, lengthof(columns))};

	host_run(cached->host, abacus_region_sizes, cached->mesh, setting_query_sort_bytes(), put_size, &sizes);
	return sizes.rows;
}

/* The name of the table of regions in SQL; NULL if there are none. */
static char *
table_of(Oid mesh, bool has_regions)
{
	Relation	heap;
	char	   *name;

	if (!has_regions)
		return NULL;
	heap = table_open(mesh, NoLock);	/* locked since the mesh was got */
	name = regions_table_require(heap, MESH_READ);
	table_close(heap, NoLock);
	return name;
}

/* abacus_regions(mesh regclass) -> region, number, triangles, area, edges */
Datum
abacus_sql_regions(PG_FUNCTION_ARGS)
{
	ReturnSetInfo *set = (ReturnSetInfo *) fcinfo->resultinfo;
	CachedMesh *cached = mesh_cache_get(PG_GETARG_OID(0));
	NamedRows  *sizes;
	char	   *table;
	int			level;

	InitMaterializedSRF(fcinfo, 0);
	table = table_of(PG_GETARG_OID(0), cached->header.facts.census.regions > 0);
	if (table == NULL)
	{
		host_release(cached->host);
		PG_RETURN_NULL();
	}
	SPI_connect();
	sizes = read_sizes(cached);
	host_release(cached->host);
	level = plain_names_begin(false);
	named_rows_register(sizes);
	query_into(set->setResult, psprintf("SELECT r.region, r.number, coalesce(s.triangles, 0), coalesce(s.area, 0), "
										"coalesce(s.edges, 0) FROM (SELECT DISTINCT region, number FROM %s) AS r "
										"LEFT JOIN " REGION_SIZES " AS s ON s.number = r.number "
										"ORDER BY r.region COLLATE \"C\"", table));
	plain_names_end(level);
	named_rows_free(sizes);
	SPI_finish();
	PG_RETURN_NULL();
}
