/*
 * tile_lines.c: the lines over the fixed edges of a vector tile.
 *
 * The pages of a mesh say which edges are fixed, and the table of lines, by which lines. A tile that has
 * triangles has few of them, so their lines are found as abacus_edges() finds those of a window.
 */
#include "postgres.h"

#include "executor/spi.h"
#include "miscadmin.h"
#include "utils/acl.h"
#include "utils/rls.h"

#include "pg/lines/named_rows.h"
#include "pg/mesh/lines_table.h"
#include "pg/mesh/mesh_cache.h"
#include "pg/sql/constrain/fixed_window.h"
#include "pg/sql/draw/tile_lines.h"

typedef struct TileEdges
{
	abacus_tile_edge *edges;
	uint64		count;			/* of all; those beyond the most are not kept */
} TileEdges;

/* Whether the user may read the lines of a mesh that has some, and whose edges are fixed. */
bool
tile_lines_may_read(Oid mesh, const abacus_census *census)
{
	Oid			table = census->lines > 0 && census->lines_wait == 0 ? mesh_find_rows_table(mesh, MESH_LINES) : InvalidOid;

	return OidIsValid(table) && pg_class_aclcheck(table, GetUserId(), ACL_SELECT) == ACLCHECK_OK &&
		check_enable_rls(table, GetUserId(), true) != RLS_ENABLED;
}

static void
put_edge(void *context, const int64 ids[2], const double ends[4], int64 line, bool is_hard)
{
	TileEdges  *edges = context;

	if (edges->count < ABACUS_MOST_TILE_EDGES)
	{
		abacus_tile_edge *edge = &edges->edges[edges->count];

		memcpy(edge->ends, ends, sizeof(edge->ends));
		edge->line = line;
		edge->is_hard = is_hard;
	}
	edges->count++;
}

/*
 * Makes the layer of the fixed edges of a tile; false if they are too many, or have no room in work_mem.
 */
bool
tile_lines_layer(Reader *reader, const abacus_tile *tile, const abacus_extent *extent, abacus_picture *layer)
{
	Host	   *host = reader->host;
	const abacus_facts *facts = &reader->header.facts;
	const MeshPages *pages = mesh_pages(host);
	abacus_window window = {.kind = ABACUS_BOX_WINDOW};
	TileEdges	edges = {.edges = palloc(ABACUS_MOST_TILE_EDGES * sizeof(abacus_tile_edge))};
	Oid			table = lines_table_require(pages->simplices.heap, MESH_READ);
	bool		fits;
	int			level;

	host_run(host, abacus_tile_window, facts, tile, window.lower, window.upper);
	SPI_connect();
	level = plain_names_begin(false);
	fits = fixed_window_read(reader, mesh_cache_get(pages->mesh), &window, extent, table, put_edge, &edges);
	plain_names_end(level);
	SPI_finish();
	fits = fits && edges.count <= ABACUS_MOST_TILE_EDGES;
	if (fits)
		host_run(host, abacus_tile_fixed, &host->table, facts, tile, extent, edges.edges, edges.count, layer);
	pfree(edges.edges);
	return fits;
}
