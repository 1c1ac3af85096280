/*
 * mesh_regions.c: the regions of a mesh that is being changed, for the core.
 *
 * The core knows numbers of regions alone. Names, outlines and seeds are in the table of regions
 * (regions_table.c). A region is a function of these and of the lines. So where new lines lie within a
 * region that has seeds, it may lose triangles.
 */
#include "postgres.h"

#include "catalog/pg_type.h"
#include "executor/spi.h"
#include "nodes/bitmapset.h"
#include "utils/array.h"
#include "utils/builtins.h"
#include "utils/float.h"
#include "utils/memutils.h"
#include "utils/snapmgr.h"

#include "pg/base/settings.h"
#include "pg/host/guard.h"
#include "pg/mesh/lines_table.h"
#include "pg/mesh/mesh_regions.h"
#include "pg/mesh/regions_table.h"
#include "pg/port/port.h"

#define ROWS_A_FETCH 1024

static Relation
mesh_of(const Writer *writer)
{
	return mesh_pages(writer->host)->simplices.heap;
}

/* ---- Outlines and seeds ---------------------------------------------------------- */

/* The row before. */
typedef struct LastCorner
{
	bool		is_known;
	int32		region;
	int64		line;
	int64		part;
	double		at[2];
} LastCorner;

/* Adds the segment that ends with a row, or its seed. */
static void
add_row(Host *host, abacus_region_parts *parts, HeapTuple row, TupleDesc desc, LastCorner *last)
{
	LastCorner	corner = {.is_known = true};
	double		ends[2][2];
	bool		isnull;
	bool		is_seed;
	Datum		part;

	corner.region = DatumGetInt32(SPI_getbinval(row, desc, 1, &isnull));
	corner.line = DatumGetInt64(SPI_getbinval(row, desc, 2, &is_seed));
	part = SPI_getbinval(row, desc, 3, &isnull);
	corner.part = isnull ? 0 : DatumGetInt64(part);
	for (int axis = 0; axis < 2; axis++)
		corner.at[axis] = DatumGetFloat8(SPI_getbinval(row, desc, 4 + axis, &isnull));
	if (is_seed)
	{
		host_run(host, abacus_region_parts_seed, parts, (uint32) corner.region, corner.at);
		return;
	}
	if (last->is_known && corner.region == last->region && corner.line == last->line &&
		corner.part == last->part)
	{
		memcpy(ends[0], last->at, sizeof(last->at));
		memcpy(ends[1], corner.at, sizeof(corner.at));
		host_run(host, abacus_region_parts_outline, parts, (uint32) corner.region, ends);
	}
	*last = corner;
}

static void
add_rows(Host *host, abacus_region_parts *parts, const char *query)
{
	SPIParseOpenOptions options = {.cursorOptions = CURSOR_OPT_NO_SCROLL};
	Portal		portal = SPI_cursor_parse_open(NULL, query, &options);
	LastCorner	last = {false};

	for (;;)
	{
		SPI_cursor_fetch(portal, true, ROWS_A_FETCH);
		if (SPI_processed == 0)
			break;
		for (uint64 i = 0; i < SPI_processed; i++)
			add_row(host, parts, SPI_tuptable->vals[i], SPI_tuptable->tupdesc, &last);
		SPI_freetuptable(SPI_tuptable);
	}
	SPI_cursor_close(portal);
}

/*
 * The outlines and seeds of the regions of the mesh for whose rows r `filter` holds, in SQL. The host
 * owns them until they are closed.
 */
abacus_region_parts *
mesh_regions_read(Host *host, const abacus_facts *facts, Relation mesh, MeshAccess access, const char *filter)
{
	char	   *regions = regions_table_require(mesh, access);
	char	   *lines = lines_table_name(lines_table_require(mesh, access));
	abacus_region_parts *parts = NULL;

	host_run(host, abacus_region_parts_open, &host->table, facts,
			 access == MESH_READ ? setting_query_sort_bytes() : setting_sort_bytes(), &parts);
	SPI_connect();
	add_rows(host, parts,
			 psprintf("SELECT r.number, l.line, l.part, l.x, l.y FROM %s AS r JOIN %s AS l "
					  "ON l.line OPERATOR(pg_catalog.=) r.line WHERE %s "
					  "ORDER BY r.number, l.line, l.position", regions, lines, filter));
	add_rows(host, parts,
			 psprintf("SELECT r.number, r.line, NULL::pg_catalog.int8, r.x, r.y FROM %s AS r "
					  "WHERE r.line IS NULL AND %s", regions, filter));
	SPI_finish();
	return parts;
}

static abacus_region_parts *
read_parts(Writer *writer, const char *filter)
{
	return mesh_regions_read(writer->host, &writer->header->facts, mesh_of(writer), MESH_WRITE, filter);
}

/* ---- Faults ------------------------------------------------------------------------ */

static char *
place_in_words(const double *place)
{
	return psprintf("(%s, %s)", float8out_internal(place[0]), float8out_internal(place[1]));
}

/* "line 7", the result of a query; `others` without one. `before`: of what the active snapshot shows. */
static char *
line_in_words(const char *query, int count, Oid *types, Datum *arguments, bool before, const char *others)
{
	MemoryContext caller = CurrentMemoryContext;
	char	   *line = NULL;

	SPI_connect();
	if (SPI_execute_with_args(query, count, types, arguments, NULL, before, 1) == SPI_OK_SELECT &&
		SPI_processed > 0)
		line = MemoryContextStrdup(caller, SPI_getvalue(SPI_tuptable->vals[0], SPI_tuptable->tupdesc, 1));
	SPI_finish();
	return line == NULL ? pstrdup(others) : psprintf("line %s", line);
}

/* A line of an open outline that has a point at the place, in words for a message. */
static char *
open_line(Writer *writer, const abacus_region_fault *fault)
{
	Relation	mesh = mesh_of(writer);
	Oid			types[] = {INT4OID, FLOAT8OID, FLOAT8OID};
	Datum		arguments[] = {
		Int32GetDatum((int32) fault->region), Float8GetDatum(fault->place[0]), Float8GetDatum(fault->place[1])
	};

	return line_in_words(psprintf("SELECT l.line FROM %s AS r JOIN %s AS l "
								  "ON l.line OPERATOR(pg_catalog.=) r.line "
								  "WHERE r.number OPERATOR(pg_catalog.=) $1 "
								  "AND l.x OPERATOR(pg_catalog.=) $2 AND l.y OPERATOR(pg_catalog.=) $3 "
								  "ORDER BY l.line LIMIT 1", regions_table_require(mesh, MESH_WRITE),
								  lines_table_name(lines_table_require(mesh, MESH_WRITE))),
						 lengthof(types), types, arguments, false, "its lines");
}

/*
 * The line that goes with a segment that a region ends at, in words for a message. Its rows have gone
 * already: they are seen as they were when the change began.
 */
static char *
border_line(Writer *writer, const abacus_region_fault *fault)
{
	Oid			types[] = {FLOAT8OID, FLOAT8OID, FLOAT8OID, FLOAT8OID};
	Datum		ends[] = {
		Float8GetDatum(fault->edge[0][0]), Float8GetDatum(fault->edge[0][1]),
		Float8GetDatum(fault->edge[1][0]), Float8GetDatum(fault->edge[1][1])
	};
	char	   *table = lines_table_name(lines_table_require(mesh_of(writer), MESH_WRITE));
	char	   *line;

	PushCopiedSnapshot(GetActiveSnapshot());
	GetActiveSnapshot()->curcid = writer->began;
	line = line_in_words(psprintf("SELECT line FROM (SELECT l.line, l.x, l.y, pg_catalog.lead(l.x) OVER w AS x1, "
								  "pg_catalog.lead(l.y) OVER w AS y1 FROM %s AS l WHERE l.line IN (SELECT o.line FROM %s AS o "
								  "WHERE o.x OPERATOR(pg_catalog.=) $1 AND o.y OPERATOR(pg_catalog.=) $2) "
								  "WINDOW w AS (PARTITION BY l.line, l.part ORDER BY l.position)) AS s "
								  "WHERE ((x OPERATOR(pg_catalog.=) $1 AND y OPERATOR(pg_catalog.=) $2 "
								  "AND x1 OPERATOR(pg_catalog.=) $3 AND y1 OPERATOR(pg_catalog.=) $4) "
								  "OR (x1 OPERATOR(pg_catalog.=) $1 AND y1 OPERATOR(pg_catalog.=) $2 "
								  "AND x OPERATOR(pg_catalog.=) $3 AND y OPERATOR(pg_catalog.=) $4)) ORDER BY line LIMIT 1",
								  table, table), lengthof(types), types, ends, true, "a line that goes");
	PopActiveSnapshot();
	return line;
}

/* Raises the error for regions that cannot be. */
void
mesh_regions_refuse(Writer *writer, const abacus_region_fault *fault)
{
	Relation	mesh = mesh_of(writer);
	char	   *region = regions_table_region(mesh, MESH_WRITE, fault->region);
	char	   *place = place_in_words(fault->place);

	switch (fault->kind)
	{
		case ABACUS_REGION_OPEN:
			ereport(ERROR,
					(errcode(ERRCODE_INVALID_PARAMETER_VALUE),
					 errmsg("outline of region \"%s\" is not closed", region),
					 errdetail("An odd number of its edges meets at %s, where %s has a point.", place,
							   open_line(writer, fault)),
					 errhint("Let each outline end where it begins, or add the lines that close it.")));
			break;
		case ABACUS_REGION_EMPTY:
			ereport(ERROR,
					(errcode(ERRCODE_INVALID_PARAMETER_VALUE),
					 errmsg("region \"%s\" is empty", region),
					 errdetail("Its outlines have each edge an even number of times, so no place is inside.")));
			break;
		case ABACUS_REGION_SEED_OUTSIDE:
			ereport(ERROR,
					(errcode(ERRCODE_INVALID_PARAMETER_VALUE),
					 errmsg("seed %s of region \"%s\" is outside of mesh \"%s\"", place, region,
							RelationGetRelationName(mesh))));
			break;
		case ABACUS_REGION_SEED_FIXED:
			ereport(ERROR,
					(errcode(ERRCODE_INVALID_PARAMETER_VALUE),
					 errmsg("seed %s of region \"%s\" is on a fixed edge", place, region),
					 fault->has_line ? errdetail("It is one of line " INT64_FORMAT ".", fault->line) : 0,
					 errhint("Place it inside of the region.")));
			break;
		case ABACUS_REGION_LEAK:
			ereport(ERROR,
					(errcode(ERRCODE_INVALID_PARAMETER_VALUE),
					 errmsg("region \"%s\" leaks to the hull of mesh \"%s\"", region,
							RelationGetRelationName(mesh)),
					 errdetail("From its seed the hull can be reached without crossing a fixed edge, at %s.", place),
					 errhint("Add the line that closes it, or give its outline instead of a seed.")));
			break;
		case ABACUS_REGION_TWICE:
			ereport(ERROR,
					(errcode(ERRCODE_INVALID_PARAMETER_VALUE),
					 errmsg("regions \"%s\" and \"%s\" overlap", region,
							regions_table_region(mesh, MESH_WRITE, fault->other)),
					 fault->has_line
					 ? errdetail("A triangle at %s beside line " INT64_FORMAT " would be in both.", place, fault->line)
					 : errdetail("A triangle at %s would be in both.", place),
					 errhint("Give the inner region to the outer one as a hole, or remove it with "
							 "abacus_unregion().")));
			break;
		case ABACUS_REGION_BORDER:
			ereport(ERROR,
					(errcode(ERRCODE_OBJECT_NOT_IN_PREREQUISITE_STATE),
					 errmsg("region \"%s\" ends at %s", region, border_line(writer, fault)),
					 errdetail("Without its segment from %s to %s the region would have no border there.", place,
							   place_in_words(fault->edge[1])),
					 errhint("Remove the region first, with abacus_unregion().")));
			break;
	}
}

/* ---- Changes ------------------------------------------------------------------------- */

/* Boxes around regions: numbers, and lower and upper corners. */
typedef struct Boxes
{
	Host	   *host;
	int			count;
	int			room;
	Datum	   *numbers;
	Datum	   *corners[4];
} Boxes;

/* Called by the core. */
static abacus_host_status
add_box(void *context, uint32_t region, const double *lower, const double *upper)
{
	Boxes	   *boxes = context;

	GUARD_BEGIN();
	if (boxes->count == boxes->room)
	{
		boxes->room = 2 * boxes->room + 64;
		boxes->numbers = boxes->numbers == NULL ? palloc(boxes->room * sizeof(Datum))
			: repalloc(boxes->numbers, boxes->room * sizeof(Datum));
		for (int i = 0; i < 4; i++)
			boxes->corners[i] = boxes->corners[i] == NULL ? palloc(boxes->room * sizeof(Datum))
				: repalloc(boxes->corners[i], boxes->room * sizeof(Datum));
	}
	boxes->numbers[boxes->count] = Int32GetDatum((int32) region);
	for (int i = 0; i < 2; i++)
	{
		boxes->corners[i][boxes->count] = Float8GetDatum(lower[i]);
		boxes->corners[2 + i][boxes->count] = Float8GetDatum(upper[i]);
	}
	boxes->count++;
	GUARD_END(boxes->host);
	return ABACUS_HOST_OK;
}

/* Writes the boxes into the rows of their regions, which questions read. */
static void
write_boxes(Writer *writer, const Boxes *boxes)
{
	char	   *table = regions_table_require(mesh_of(writer), MESH_WRITE);
	Oid			types[] = {INT4ARRAYOID, FLOAT8ARRAYOID, FLOAT8ARRAYOID, FLOAT8ARRAYOID, FLOAT8ARRAYOID};
	Datum		arguments[lengthof(types)];

	if (boxes->count == 0)
		return;
	arguments[0] = PointerGetDatum(construct_array(boxes->numbers, boxes->count, INT4OID, sizeof(int32), true, TYPALIGN_INT));
	for (int i = 0; i < 4; i++)
		arguments[1 + i] = PointerGetDatum(construct_array(boxes->corners[i], boxes->count, FLOAT8OID, sizeof(float8),
														   FLOAT8PASSBYVAL, TYPALIGN_DOUBLE));
	SPI_connect();
	if (SPI_execute_with_args(psprintf("UPDATE %s AS r SET lower = b.lower, upper = b.upper FROM (SELECT u.number, "
									   "ARRAY[pg_catalog.min(u.x0), pg_catalog.min(u.y0)] AS lower, "
									   "ARRAY[pg_catalog.max(u.x1), pg_catalog.max(u.y1)] AS upper "
									   "FROM ROWS FROM (pg_catalog.unnest($1), pg_catalog.unnest($2), pg_catalog.unnest($3), pg_catalog.unnest($4), "
									   "pg_catalog.unnest($5)) AS u (number, x0, y0, x1, y1) GROUP BY u.number) AS b "
									   "WHERE r.number OPERATOR(pg_catalog.=) b.number", table),
							  lengthof(types), types, arguments, NULL, false, 0) != SPI_OK_UPDATE)
		elog(ERROR, "could not write the boxes of regions: %s", SPI_result_code_string(SPI_result));
	SPI_finish();
}

/* Puts triangles into regions, and closes their parts. */
void
mesh_regions_fill(Writer *writer, abacus_build *build, abacus_region_parts *parts)
{
	Host	   *host = writer->host;
	Boxes		boxes = {.host = host};
	abacus_region_fault fault;

	if (host_run(host, abacus_build_fill_regions, build, parts, writer->header, add_box, &boxes, &fault) == ABACUS_END)
		mesh_regions_refuse(writer, &fault);
	abacus_region_parts_close(parts);
	write_boxes(writer, &boxes);
}

/* Takes all triangles out of regions, and closes their parts. */
void
mesh_regions_clear(Writer *writer, abacus_build *build, abacus_region_parts *parts)
{
	host_run(writer->host, abacus_build_clear_regions, build, parts, writer->header);
	abacus_region_parts_close(parts);
}

/* Finds all regions anew: the mesh may have been built anew, and all its edges fixed. */
void
mesh_regions_renew(Writer *writer, abacus_build *build)
{
	if (writer->header->facts.census.regions == 0)
		return;
	mesh_regions_clear(writer, build, read_parts(writer, "true"));
	mesh_regions_fill(writer, build, read_parts(writer, "true"));
}

/* Regions met along segments. */
typedef struct MetRegions
{
	Host	   *host;
	Bitmapset  *numbers;
} MetRegions;

/* Called by the core. */
static abacus_host_status
meet(void *context, uint32_t region)
{
	MetRegions *met = context;

	GUARD_BEGIN();
	met->numbers = bms_add_member(met->numbers, (int) region);
	GUARD_END(met->host);
	return ABACUS_HOST_OK;
}

/* The numbers as an array in SQL. */
static char *
array_of(const Bitmapset *numbers)
{
	StringInfoData array;

	initStringInfo(&array);
	for (int number = -1; (number = bms_next_member(numbers, number)) >= 0;)
		appendStringInfo(&array, "%s%d", array.len > 0 ? "," : "", number);
	return array.data;
}

/* Segments have been fixed: the regions with seeds through which they lead lose what they cut off. */
void
mesh_regions_follow(Writer *writer, abacus_build *build, abacus_segments *segments)
{
	MetRegions	met = {.host = writer->host};
	abacus_region_parts *parts;
	abacus_region_fault fault;

	if (writer->header->facts.census.seeded == 0)
		return;
	host_run(writer->host, abacus_build_regions_along, build, segments, meet, &met);
	if (!bms_is_empty(met.numbers))
	{
		parts = read_parts(writer,
						   psprintf("r.line IS NULL AND r.number OPERATOR(pg_catalog.=) ANY ('{%s}'::pg_catalog.int4[])",
										   array_of(met.numbers)));
		if (host_run(writer->host, abacus_build_cut_regions, build, segments, parts, writer->header, &fault) == ABACUS_END)
			mesh_regions_refuse(writer, &fault);
		abacus_region_parts_close(parts);
	}
	bms_free(met.numbers);
}
