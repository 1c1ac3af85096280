/*
 * line_crossings.c: where lines cross elsewhere than in a vertex, by a sweep of the core.
 *
 * The core takes corners of lines in any order and sorts them. It leaves out crossings at corners of
 * lines. Those at other vertices are left out here; only an exact place can be one.
 */
#include "postgres.h"

#include "executor/spi.h"
#include "lib/stringinfo.h"
#include "utils/builtins.h"
#include "utils/float.h"

#include "pg/base/settings.h"
#include "pg/mesh/line_crossings.h"
#include "pg/mesh/lines_table.h"

#define ROWS_A_FETCH 1024
#define SHOWN 10

/* Opens a sweep without lines, with `memory` bytes and temporary files. */
void
line_crossings_open(LineCrossings *crossings, size_t memory)
{
	Host	   *host = host_create(CurrentMemoryContext);

	crossings->host = host;
	crossings->swept = NULL;
	host_run(host, abacus_crossings_open, &host->table, memory, &crossings->swept);
	host_own(host, crossings->swept, (void (*) (void *)) abacus_crossings_close);
}

/* Adds corners of lines, CORNER_COLUMNS words each. */
void
line_crossings_add(LineCrossings *crossings, const uint64 *corners, size_t count)
{
	host_run(crossings->host, abacus_crossings_add_corners, crossings->swept, corners, count);
}

/*
 * Adds the rows of a query of line, position, x, y and part, which are not NULL. It reads what the active
 * snapshot sees, or also what this command has changed. SPI is connected.
 */
void
line_crossings_add_query(LineCrossings *crossings, const char *query, bool sees_changes)
{
	SPIParseOpenOptions options = {.cursorOptions = CURSOR_OPT_NO_SCROLL, .read_only = !sees_changes};
	Portal		portal = SPI_cursor_parse_open(NULL, query, &options);
	uint64	   *corners = palloc(ROWS_A_FETCH * CORNER_COLUMNS * sizeof(uint64));

	for (;;)
	{
		uint64		count;

		SPI_cursor_fetch(portal, true, ROWS_A_FETCH);
		count = SPI_processed;
		if (count == 0)
			break;
		for (uint64 i = 0; i < count * CORNER_COLUMNS; i++)
		{
			bool		isnull;

			/* a double has the bits of its Datum */
			corners[i] = (uint64) SPI_getbinval(SPI_tuptable->vals[i / CORNER_COLUMNS],
												SPI_tuptable->tupdesc, (int) (i % CORNER_COLUMNS) + 1,
												&isnull);
		}
		SPI_freetuptable(SPI_tuptable);
		line_crossings_add(crossings, corners, count);
	}
	SPI_freetuptable(SPI_tuptable);
	SPI_cursor_close(portal);
	pfree(corners);
}

/* The next crossing that is at no vertex; false if there is none. No more lines may be added. */
bool
line_crossings_next(LineCrossings *crossings, VertexTest is_vertex, void *context,
					abacus_crossing *crossing)
{
	while (host_run(crossings->host, abacus_crossings_next, crossings->swept, crossing) == ABACUS_OK)
		if (!crossing->is_exact || !is_vertex(context, crossing->place))
			return true;
	return false;
}

void
line_crossings_close(LineCrossings *crossings)
{
	host_destroy(crossings->host);
}

/* ---- Those of the mesh ------------------------------------------------------------------- */

static char *
shown(double number)
{
	return DatumGetCString(DirectFunctionCall1(float8out, Float8GetDatum(number)));
}

/* All corners of the lines of the mesh. */
static void
add_lines(LineCrossings *crossings, Writer *writer)
{
	Oid			table = lines_table_require(mesh_pages(writer->host)->simplices.heap, MESH_WRITE);

	SPI_connect();
	line_crossings_add_query(crossings, psprintf("SELECT line, position, x, y, coalesce(part, 0) FROM %s",
												 lines_table_name(table)), true);
	SPI_finish();
}

/* Whether any lines of the mesh cross. */
bool
line_crossings_any(Writer *writer, VertexTest is_vertex, void *context)
{
	LineCrossings crossings;
	abacus_crossing crossing;
	bool		any;

	line_crossings_open(&crossings, setting_sort_bytes());
	add_lines(&crossings, writer);
	any = line_crossings_next(&crossings, is_vertex, context, &crossing);
	line_crossings_close(&crossings);
	return any;
}

/*
 * Refuses lines of the mesh that cross, with their number and the first ones. Returns only if there
 * are none.
 */
void
line_crossings_refuse(Writer *writer, VertexTest is_vertex, void *context)
{
	LineCrossings crossings;
	abacus_crossing crossing;
	StringInfoData list;
	StringInfoData detail;
	uint64		count = 0;

	line_crossings_open(&crossings, setting_sort_bytes());
	add_lines(&crossings, writer);
	initStringInfo(&list);
	for (; line_crossings_next(&crossings, is_vertex, context, &crossing); count++)
		if (count < SHOWN)
			appendStringInfo(&list, "%sLine " INT64_FORMAT " after position " INT64_FORMAT " crosses line "
							 INT64_FORMAT " after position " INT64_FORMAT " at (%s, %s).",
							 count > 0 ? "\n" : "", crossing.line[0], crossing.position[0], crossing.line[1],
							 crossing.position[1], shown(crossing.place[0]), shown(crossing.place[1]));
	line_crossings_close(&crossings);
	if (count == 0)
		return;
	initStringInfo(&detail);
	if (count > 1)
		appendStringInfo(&detail, "There are " UINT64_FORMAT " crossings%s:\n", count,
						 count > SHOWN ? "; these are the first ten" : "");
	appendStringInfoString(&detail, list.data);
	ereport(ERROR,
			(errcode(ERRCODE_INVALID_PARAMETER_VALUE),
			 errmsg("lines cross"),
			 errdetail_internal("%s", detail.data),
			 errhint("Find all crossings with abacus_crossings().")));
}
