/*
 * loaded_lines.c: lines of a triangulation that is loaded: rows of its edges.
 *
 * The core finds each edge among those of the simplices, and returns it with the places of its ends.
 * Rows of a line in sequence, each of which begins where the one before ended, are a part of the line.
 */
#include "postgres.h"

#include "catalog/pg_type.h"

#include "pg/lines/loaded_lines.h"
#include "pg/lines/new_lines.h"

#define EDGES "abacus_edges_given"
#define EDGES_A_FETCH 1024

/* Passes the rows of a prepared query to the core. */
void
loaded_lines_read(Change *change, Source *source)
{
	Host	   *host = change->writer.host;
	const uint64 *records;
	size_t		count;

	source_open_loaded_lines(source, abacus_names_of(change->writer.header));
	do
	{
		count = source_fetch(source, &records);
		host_run(host, abacus_load_lines, change->load, records, count);
	} while (count > 0);
	source_close(source);
}

/* The edges of the lines, after the core has checked them. */
NamedRows *
loaded_lines_take(Change *change)
{
	static const NamedColumn columns[] = {
		{"line", INT8OID}, {"n", INT8OID}, {"v0", INT8OID}, {"x0", FLOAT8OID}, {"y0", FLOAT8OID},
		{"v1", INT8OID}, {"x1", FLOAT8OID}, {"y1", FLOAT8OID}
	};
	static const bool isnull[lengthof(columns)] = {false};
	NamedRows  *rows = named_rows_create(EDGES, columns, lengthof(columns));
	abacus_loaded_edge *edges = palloc(EDGES_A_FETCH * sizeof(abacus_loaded_edge));
	size_t		count;

	do
	{
		host_run(change->writer.host, abacus_load_edges, change->load, edges, EDGES_A_FETCH, &count);
		for (size_t i = 0; i < count; i++)
		{
			const abacus_loaded_edge *edge = &edges[i];
			Datum		values[] = {
				Int64GetDatum(edge->line), Int64GetDatum(edge->row),
				Int64GetDatum(edge->ids[0]), Float8GetDatum(edge->ends[0][0]), Float8GetDatum(edge->ends[0][1]),
				Int64GetDatum(edge->ids[1]), Float8GetDatum(edge->ends[1][0]), Float8GetDatum(edge->ends[1][1])
			};

			named_rows_put(rows, values, isnull);
		}
	} while (count > 0);
	pfree(edges);
	return rows;
}

/* The points of the lines: both ends of the first edge of a part, and the second ones of the others. */
static NamedRows *
find_points(void)
{
	return line_points_of_query(
		"WITH begun AS (SELECT *, lag(v1) OVER w IS DISTINCT FROM v0 AS begins FROM " EDGES
		" WINDOW w AS (PARTITION BY line ORDER BY n)), "
		"parted AS (SELECT *, count(*) FILTER (WHERE begins) OVER (PARTITION BY line ORDER BY n) - 1 AS part FROM begun), "
		"points AS (SELECT line, n, 0 AS place, v0 AS point, x0 AS x, y0 AS y, part FROM parted WHERE begins "
		" UNION ALL SELECT line, n, 1, v1, x1, y1, part FROM parted) "
		"SELECT line, row_number() OVER (PARTITION BY line ORDER BY n, place), point, x, y, NULL::float8[], false, "
		"CASE WHEN max(part) OVER (PARTITION BY line) > 0 THEN part END FROM points");
}

/* Adds the lines to the mesh, which has their vertices. Ends the rows of edges. */
void
loaded_lines_add(Change *change, NamedRows *edges)
{
	static const NewPoints points = {0};
	NamedRows  *found;
	int			level;

	if (edges->count > 0)
	{
		named_rows_register(edges);
		level = plain_names_begin(true);
		found = find_points();
		plain_names_end(level);
		new_lines_put(change, found, "hard", EXISTING_ERROR, &points);
		named_rows_free(found);
	}
	named_rows_free(edges);
}
