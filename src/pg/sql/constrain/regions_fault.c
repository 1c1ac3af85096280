/*
 * regions_fault.c: whether the regions of a mesh are those of its table; and how large they are.
 */
#include "postgres.h"

#include "access/table.h"
#include "catalog/pg_type.h"
#include "executor/spi.h"
#include "utils/memutils.h"

#include "abacus/regions.h"
#include "pg/base/settings.h"
#include "pg/host/guard.h"
#include "pg/mesh/mesh_regions.h"
#include "pg/mesh/regions_table.h"
#include "pg/sql/constrain/regions_fault.h"

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
	Datum		values[8];
	bool		isnull[8] = {false};

	GUARD_BEGIN();
	values[0] = Int32GetDatum((int32) size->region);
	values[1] = Int64GetDatum((int64) size->triangles);
	values[2] = Float8GetDatum(size->area);
	values[3] = Int64GetDatum((int64) size->edges);
	for (int i = 0; i < 2; i++)
	{
		values[4 + i] = Float8GetDatum(size->lower[i]);
		values[6 + i] = Float8GetDatum(size->upper[i]);
	}
	named_rows_put(sizes->rows, values, isnull);
	GUARD_END(sizes->host);
	return ABACUS_HOST_OK;
}

/* The sizes of all regions that have triangles, as rows with a name. */
NamedRows *
region_sizes_read(CachedMesh *cached)
{
	static const NamedColumn columns[] = {
		{"number", INT4OID}, {"triangles", INT8OID}, {"area", FLOAT8OID}, {"edges", INT8OID},
		{"x0", FLOAT8OID}, {"y0", FLOAT8OID}, {"x1", FLOAT8OID}, {"y1", FLOAT8OID}
	};
	Sizes		sizes = {cached->host, named_rows_create(REGION_SIZES, columns, lengthof(columns))};

	host_run(cached->host, abacus_region_sizes, cached->mesh, setting_query_sort_bytes(), put_size, &sizes);
	return sizes.rows;
}

/* Compares the triangles of all regions with what their outlines and seeds give them. */
static char *
parts_fault(CachedMesh *cached, Relation heap)
{
	abacus_region_parts *parts = mesh_regions_read(cached->host, &cached->header.facts, heap, MESH_READ, "true");
	uint32		wrong;

	host_run(cached->host, abacus_region_check, cached->mesh, parts, setting_query_sort_bytes(), &wrong);
	abacus_region_parts_close(parts);
	host_release(cached->host);
	return wrong == 0 ? NULL
		: psprintf("Region \"%s\" does not have the triangles that its outlines or seeds give it.",
				   regions_table_region(heap, MESH_READ, wrong));
}

/*
 * Looks for a fault of the regions of a sound mesh: a number that no region has, or several, a region
 * without triangles or with others than its own, regions that are not counted. Returns what is wrong, or
 * NULL.
 */
char *
regions_fault(Oid mesh)
{
	CachedMesh *cached = mesh_cache_get(mesh);
	uint64		regions = cached->header.facts.census.regions;
	uint64		seeded = cached->header.facts.census.seeded;
	Relation	heap = table_open(mesh, NoLock);
	char	   *table = regions_table_require(heap, MESH_READ);
	char	   *fault = NULL;
	NamedRows  *sizes;
	Datum		counts[5];
	bool		isnull[5];
	int			level;

	SPI_connect();
	sizes = region_sizes_read(cached);
	host_release(cached->host);
	level = plain_names_begin(false);
	named_rows_register(sizes);
	query_first(psprintf("SELECT (SELECT count(*) FROM (SELECT DISTINCT region, number FROM %1$s) AS r), "
						 "(SELECT count(DISTINCT region) FROM %1$s WHERE line IS NULL), "
						 "(SELECT count(*) FROM " REGION_SIZES " AS s WHERE NOT EXISTS (SELECT FROM %1$s AS r WHERE r.number = s.number)), "
						 "(SELECT count(*) FROM %1$s AS r WHERE NOT EXISTS (SELECT FROM " REGION_SIZES " AS s WHERE r.number = s.number)), "
						 "(SELECT count(*) FROM %1$s AS r JOIN " REGION_SIZES " AS s ON s.number = r.number WHERE s.x0 < r.lower[1] "
						 "OR s.y0 < r.lower[2] OR s.x1 > r.upper[1] OR s.y1 > r.upper[2])",
						 table), counts, isnull, 5);
	plain_names_end(level);
	named_rows_free(sizes);
	SPI_finish();
	if ((uint64) DatumGetInt64(counts[0]) != regions || (uint64) DatumGetInt64(counts[1]) != seeded)
		fault = pstrdup("The header counts more or fewer regions than there are.");
	else if (DatumGetInt64(counts[2]) > 0)
		fault = pstrdup("Triangles have the number of a region that does not exist.");
	else if (DatumGetInt64(counts[3]) > 0)
		fault = pstrdup("A region has no triangles.");
	else if (DatumGetInt64(counts[4]) > 0)
		fault = pstrdup("A region goes beyond its box.");
	else
		fault = parts_fault(cached, heap);
	table_close(heap, NoLock);
	return fault;
}
