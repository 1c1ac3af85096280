/*
 * new_regions.c: regions that a mesh gets, and those that it loses.
 *
 * Their outlines and seeds are rows of a table of the mesh (regions_table.c); the core finds their
 * triangles. All checks of the rows come first.
 */
#include "postgres.h"

#include "catalog/pg_type.h"
#include "utils/builtins.h"

#include "pg/lines/new_regions.h"
#include "pg/lines/region_rows.h"
#include "pg/mesh/lines_table.h"
#include "pg/mesh/mesh_regions.h"
#include "pg/mesh/regions_table.h"

/* The rows that count. */
#define NEW_PARTS "abacus_region_parts"

/*
 * The segments of the lines that are outlines, the lesser end first. %1$s: the rows of outlines, %2$s:
 * the table of lines.
 */
#define OUTLINE_SEGMENTS \
	"(SELECT region, line, least(ARRAY[x, y], ARRAY[x1, y1]) AS a, greatest(ARRAY[x, y], ARRAY[x1, y1]) AS b FROM (" \
	"SELECT g.region, l.line, l.x, l.y, coalesce(l.part, 0) AS part, lead(l.x) OVER w AS x1, " \
	"lead(l.y) OVER w AS y1, lead(coalesce(l.part, 0)) OVER w AS part1 " \
	"FROM %1$s AS g JOIN %2$s AS l ON l.line = g.line " \
	"WINDOW w AS (PARTITION BY g.region, l.line ORDER BY l.position)) AS c WHERE part1 = part)"

static Relation
mesh_of(const Change *change)
{
	return mesh_pages(change->writer.host)->simplices.heap;
}

/* ---- Checks ------------------------------------------------------------------------ */

/* A text in the caller's memory. */
static char *
text_of(Datum value)
{
	return TextDatumGetCString(value);
}

static void
refuse_unknown_line(const char *lines)
{
	Datum		values[2];
	bool		isnull[2];

	if (query_first(psprintf("SELECT g.region, g.line FROM " REGION_ROWS " AS g WHERE g.line IS NOT NULL AND "
							 "NOT EXISTS (SELECT FROM %s AS l WHERE l.line = g.line) ORDER BY g.line, g.region LIMIT 1",
							 lines), values, isnull, 2))
		ereport(ERROR,
				(errcode(ERRCODE_INVALID_PARAMETER_VALUE),
				 errmsg("the mesh has no line " INT64_FORMAT, DatumGetInt64(values[1])),
				 errdetail("It is an outline of region \"%s\".", text_of(values[0])),
				 errhint("Give the mesh its lines first, with abacus_constrain().")));
}

static void
refuse_existing(const char *table)
{
	Datum		region;
	bool		isnull;

	if (query_first(psprintf("SELECT g.region FROM " REGION_ROWS " AS g WHERE EXISTS ("
							 "SELECT FROM %s AS r WHERE r.region = g.region) ORDER BY g.region LIMIT 1", table),
					&region, &isnull, 1))
		ereport(ERROR,
				(errcode(ERRCODE_DUPLICATE_OBJECT),
				 errmsg("the mesh already has a region \"%s\"", text_of(region)),
				 errhint("Remove it first, with abacus_unregion().")));
}

/* ---- Outlines that are given twice ---------------------------------------------------- */

/*
 * The outlines and seeds that count, each once. Of lines with the same segments the least one counts:
 * those whose segments have equal counts and sums of hashes are compared.
 */
static NamedRows *
find_parts(const char *lines)
{
	static const NamedColumn columns[] = {
		{"region", TEXTOID}, {"line", INT8OID}, {"x", FLOAT8OID}, {"y", FLOAT8OID}
	};
	char	   *segments = psprintf(OUTLINE_SEGMENTS, "(SELECT DISTINCT region, line FROM " REGION_ROWS ")", lines);

	return named_rows_of_query(
		NEW_PARTS, columns, lengthof(columns),
		psprintf("WITH segments AS MATERIALIZED (SELECT DISTINCT region, line, a, b, count(*) AS n FROM %s AS s "
				 "GROUP BY region, line, a, b), "
				 "sums AS (SELECT region, line, count(*) AS n, "
				 "sum(hash_array_extended(a || b || n::double precision, 0)::numeric) AS hash FROM segments GROUP BY region, line), "
				 "again AS (SELECT DISTINCT q.region, q.line FROM sums AS p JOIN sums AS q "
				 "ON q.region = p.region AND q.n = p.n AND q.hash = p.hash AND q.line > p.line "
				 "WHERE NOT EXISTS (SELECT a, b, n FROM segments AS s WHERE s.region = p.region AND s.line = p.line "
				 "EXCEPT SELECT a, b, n FROM segments AS s WHERE s.region = q.region AND s.line = q.line)) "
				 "SELECT DISTINCT g.region, g.line, g.x, g.y FROM " REGION_ROWS " AS g "
				 "WHERE NOT EXISTS (SELECT FROM again AS o WHERE o.region = g.region AND o.line = g.line)", segments));
}

static void
notice_repeated(uint64 given, uint64 kept)
{
	if (given > kept)
		ereport(NOTICE,
				(errmsg_plural(UINT64_FORMAT " outline or seed is given twice, and counts once",
							   UINT64_FORMAT " outlines or seeds are given twice, and count once",
							   (unsigned long) (given - kept), given - kept)));
}

/* ---- Regions that come and go ---------------------------------------------------------- */

/* Writes the rows; *first is the number of the first region, *count how many there are. */
static void
write_parts(Change *change, const char *table, const NamedRows *parts, int32 *first, uint64 *count)
{
	abacus_census *census = &change->writer.header->facts.census;
	Datum		values[3];
	bool		isnull[3];

	query_first(psprintf("SELECT (SELECT coalesce(max(number), 0) FROM %s) + 1, count(DISTINCT region), "
						 "count(DISTINCT region) FILTER (WHERE line IS NULL) FROM " NEW_PARTS, table),
				values, isnull, 3);
	*first = DatumGetInt32(values[0]);
	*count = (uint64) DatumGetInt64(values[1]);
	if ((uint64) *first + *count - 1 > ABACUS_MAX_REGIONS)
		ereport(ERROR,
				(errcode(ERRCODE_PROGRAM_LIMIT_EXCEEDED),
				 errmsg("mesh \"%s\" would have too many regions", RelationGetRelationName(mesh_of(change))),
				 errdetail("Numbers of regions go up to %d.", ABACUS_MAX_REGIONS),
				 errhint("Remove all regions, and give those that are needed anew.")));
	query_change(table, "regions",
				psprintf("INSERT INTO %s (region, number, part, line, x, y) SELECT region, "
						 "%d - 1 + dense_rank() OVER (ORDER BY region COLLATE \"C\"), "
						 "row_number() OVER (PARTITION BY region ORDER BY line, x, y), line, x, y FROM " NEW_PARTS
						 " ORDER BY region COLLATE \"C\", line, x, y", table, *first), parts->count);
	census->regions += *count;
	census->seeded += (uint64) DatumGetInt64(values[2]);
}

/* The outlines and seeds for whose rows r `filter` holds. */
static abacus_region_parts *
read_parts(const Change *change, const char *filter)
{
	return mesh_regions_read(change->writer.host, &change->writer.header->facts, mesh_of(change), MESH_WRITE, filter);
}

static uint64
add_regions(Change *change, const NamedRows *given)
{
	Relation	mesh = mesh_of(change);
	char	   *lines = lines_table_name(lines_table_require(mesh, MESH_WRITE));
	char	   *table = change->writer.header->facts.census.regions > 0 ? regions_table_require(mesh, MESH_WRITE)
		: lines_table_name(regions_table_make(mesh));
	NamedRows  *parts;
	int32		first;
	uint64		count;
	int			level = plain_names_begin(true);

	refuse_existing(table);
	refuse_unknown_line(lines);
	parts = find_parts(lines);
	notice_repeated(given->count, parts->count);
	write_parts(change, table, parts, &first, &count);
	plain_names_end(level);
	named_rows_free(parts);
	change_open_build(change);
	mesh_regions_fill(&change->writer, change->build,
					  read_parts(change, psprintf("r.number OPERATOR(pg_catalog.>=) %d", first)));
	return count;
}

static void
require_lines(const Change *change)
{
	const abacus_census *census = &change->writer.header->facts.census;
	const char *mesh = RelationGetRelationName(mesh_of(change));

	if (census->lines == 0)
		ereport(ERROR,
				(errcode(ERRCODE_OBJECT_NOT_IN_PREREQUISITE_STATE),
				 errmsg("mesh \"%s\" has no lines", mesh),
				 errdetail("A region ends at the fixed edges of lines."),
				 errhint("Give the mesh its lines first, with abacus_constrain().")));
	if (census->lines_wait > 0)
		ereport(ERROR,
				(errcode(ERRCODE_OBJECT_NOT_IN_PREREQUISITE_STATE),
				 errmsg("lines of mesh \"%s\" wait", mesh),
				 errdetail("A region ends at the fixed edges of lines."),
				 errhint("Insert the points that wait, with abacus_build(), or remove lines that cross, with "
						 "abacus_unconstrain().")));
}

/*
 * Reads the rows of a prepared query, and adds its regions; returns how many they are. Without any,
 * nothing has changed.
 */
uint64
new_regions_add(Change *change, Source *source)
{
	NamedRows  *given = region_rows_read(source);
	uint64		count = 0;

	if (given->count > 0)
	{
		require_lines(change);
		named_rows_register(given);
		count = add_regions(change, given);
	}
	named_rows_free(given);
	return count;
}

/* Removes a region, which must be there. */
void
new_regions_remove(Change *change, const char *region)
{
	abacus_census *census = &change->writer.header->facts.census;
	Relation	mesh = mesh_of(change);
	abacus_extent found;
	uint32		number;
	char	   *table;
	Datum		seeds;
	bool		isnull;
	int			level;

	if (census->regions == 0)
		ereport(ERROR,
				(errcode(ERRCODE_UNDEFINED_OBJECT),
				 errmsg("mesh \"%s\" has no regions", RelationGetRelationName(mesh)),
				 errhint("Make regions with abacus_region().")));
	table = regions_table_require(mesh, MESH_WRITE);
	regions_table_find(mesh, MESH_WRITE, region, &found);
	number = found.region;
	require_lines(change);
	change_open_build(change);
	mesh_regions_clear(&change->writer, change->build,
					   read_parts(change, psprintf("r.number OPERATOR(pg_catalog.=) %u", number)));
	SPI_connect();
	level = plain_names_begin(true);
	query_first(psprintf("SELECT count(*) FROM (SELECT FROM %s WHERE number = %u AND line IS NULL LIMIT 1) AS s",
						 table, number), &seeds, &isnull, 1);
	query_run(psprintf("DELETE FROM %s WHERE number = %u", table, number));
	plain_names_end(level);
	SPI_finish();
	census->regions--;
	census->seeded -= (uint64) DatumGetInt64(seeds);
}
