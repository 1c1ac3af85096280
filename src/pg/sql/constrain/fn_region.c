/*
 * fn_region.c: abacus_region, which gives a mesh regions, abacus_unregion, which takes one away,
 * abacus_region_at, which says in which one a place is, and abacus_regions, which lists them.
 */
#include "postgres.h"

#include "funcapi.h"
#include "utils/builtins.h"

#include "pg/base/sql_function.h"
#include "pg/input/place.h"
#include "pg/lines/new_lines.h"
#include "pg/lines/new_regions.h"
#include "pg/mesh/regions_table.h"
#include "pg/port/port.h"
#include "pg/sql/arguments/extent_arguments.h"
#include "pg/sql/constrain/regions_fault.h"

SQL_FUNCTION(abacus_sql_region);
SQL_FUNCTION(abacus_sql_unregion);
SQL_FUNCTION(abacus_sql_region_at);
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

/* ---- abacus_region_at ------------------------------------------------------------------ */

/* abacus_region_at(mesh regclass, x float8, y float8) -> text */
Datum
abacus_sql_region_at(PG_FUNCTION_ARGS)
{
	double		place[ABACUS_MAX_DIMENSION];
	CachedMesh *cached = mesh_cache_get(PG_GETARG_OID(0));
	abacus_simplex simplex;
	abacus_status status;

	if (!place_arguments(fcinfo, PG_NARGS() - 1, &cached->header.facts.form, place))
		PG_RETURN_NULL();
	status = host_run(cached->host, abacus_mesh_locate, cached->mesh, place, &simplex);
	host_release(cached->host);
	if (status == ABACUS_END || simplex.region == 0)
		PG_RETURN_NULL();
	PG_RETURN_TEXT_P(cstring_to_text(extent_region_name(PG_GETARG_OID(0), &cached->header, simplex.region)));
}

/* ---- abacus_regions -------------------------------------------------------------------- */

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
	sizes = region_sizes_read(cached);
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
