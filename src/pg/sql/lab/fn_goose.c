/*
 * fn_goose.c: abacus_goose, the dissertation's chapter 2: a triangulation as a table of rows, grown
 * by searches of an R-tree, and its cost.
 */
#include "postgres.h"

#include "funcapi.h"
#include "miscadmin.h"
#include "utils/builtins.h"

#include "pg/base/settings.h"
#include "pg/base/sql_function.h"
#include "pg/goose/goose_table.h"
#include "pg/input/source.h"
#include "pg/mesh/shape.h"
#include "pg/sql/rows/result.h"

SQL_FUNCTION(abacus_sql_goose);

static double
share(uint64 part, uint64 whole)
{
	return whole == 0 ? 0 : (double) part / (double) whole;
}

/* Counts of the mesh, and of the work for it. */
static void
put_counts(const Figures *figures, const abacus_goose_figures *goose)
{
	put_figure(figures, "vertices", (double) goose->vertices,
			   "distinct points; 0 while they span no simplex");
	put_figure(figures, "duplicates", (double) goose->duplicates, "points that equal an earlier one");
	put_figure(figures, "simplices", (double) goose->simplices, "simplices, a row each");
	put_figure(figures, "hull_facets", (double) goose->ghosts,
			   "facets of the convex hull, rows until the end");
	put_figure(figures, "created", (double) goose->created, "rows inserted, hull facets included");
	put_figure(figures, "deleted", (double) goose->deleted, "rows deleted again");
	put_figure(figures, "deleted_percent", 100 * share(goose->deleted, goose->created),
			   "share of the rows that were deleted again");
}

/* Section 2.3.2: how many boxes a search compares for each result. */
static void
put_searches(const Figures *figures, const abacus_goose_figures *goose)
{
	put_figure(figures, "boxes_per_search", share(goose->search_boxes, goose->searches),
			   "boxes of the index that the search for a point looks at");
	put_figure(figures, "found_per_search", share(goose->found, goose->searches),
			   "simplices whose box contains the point");
	put_figure(figures, "hits_per_search", share(goose->deleted, goose->searches),
			   "simplices in conflict with the point");
	put_figure(figures, "search_efficiency_percent",
			   100 * share(goose->found, goose->search_boxes),
			   "simplices found, of the boxes looked at");
	put_figure(figures, "boxes_per_deletion", share(goose->unlink_boxes, goose->deleted),
			   "boxes that the search for a row to be deleted looks at");
	put_figure(figures, "box_unit", goose->unit, "coordinates are multiplied by this in boxes");
}

/* Figure 2.9: where the time of an insertion goes. */
static void
put_times(const Figures *figures, const abacus_goose_figures *goose)
{
	uint64		delete_ns = goose->unlink_ns + goose->erase_ns;
	uint64		other_ns = goose->total_ns - goose->search_ns - goose->test_ns - delete_ns -
		goose->insert_ns;

	put_figure(figures, "insertion_seconds", 1e-9 * (double) goose->total_ns,
			   "time of all insertions, without reading and sorting the points");
	put_figure(figures, "search_percent", 100 * share(goose->search_ns, goose->total_ns),
			   "searching the R-tree, rows included");
	put_figure(figures, "incircle_percent", 100 * share(goose->test_ns, goose->total_ns),
			   "in-circle or in-sphere tests");
	put_figure(figures, "delete_percent", 100 * share(delete_ns, goose->total_ns),
			   "deleting from the R-tree");
	put_figure(figures, "insert_percent", 100 * share(goose->insert_ns, goose->total_ns),
			   "inserting into the R-tree");
	put_figure(figures, "other_percent", 100 * share(other_ns, goose->total_ns),
			   "other operations: cavities, boxes");
	put_figure(figures, "delete_search_percent", 100 * share(goose->unlink_ns, delete_ns),
			   "share of searching in the time of deleting");
}

static void
put_sizes(const Figures *figures, Oid relid)
{
	put_figure(figures, "table_bytes", bytes_of(pg_table_size, relid),
			   "size of the table, with deleted rows until VACUUM");
	put_figure(figures, "index_bytes", bytes_of(pg_indexes_size, relid), "size of its index");
}

/* Reads the points of the query into a stage and triangulates them into the table. */
static void
triangulate(GooseTable *table, Source *source, abacus_header *header,
			abacus_goose_figures *figures)
{
	Host	   *host = host_create(CurrentMemoryContext);
	abacus_stage *stage = NULL;
	const uint64 *points;
	size_t		count;

	goose_table_own(table, host);
	progress_begin(&host->progress, table->relid);
	host_run(host, abacus_stage_open, &host->table, &header->facts, setting_sort_bytes(), &stage);
	host_own(host, stage, (void (*) (void *)) abacus_stage_close);
	source_open(source, abacus_names_of(header), true);
	while ((count = source_fetch(source, &points)) > 0)
		host_run(host, abacus_stage_add, stage, points, count);
	source_close(source);
	host_run(host, abacus_stage_end, stage, &header->facts);
	host_run(host, abacus_goose_run, &host->table, &table->rtree, stage, &header->facts, figures);
	progress_end(&host->progress);
	host_destroy(host);
}

/* abacus_goose(mesh text, query text, dimension int) -> name, value, description */
Datum
abacus_sql_goose(PG_FUNCTION_ARGS)
{
	abacus_header *header = palloc0(sizeof(abacus_header));
	abacus_goose_figures *goose = palloc0(sizeof(abacus_goose_figures));
	Figures		figures = {(ReturnSetInfo *) fcinfo->resultinfo, ""};
	Source		source;
	GooseTable *table;

	if (PG_ARGISNULL(0) || PG_ARGISNULL(1) || PG_ARGISNULL(2))
		ereport(ERROR,
				(errcode(ERRCODE_NULL_VALUE_NOT_ALLOWED),
				 errmsg("mesh, query and dimension must not be NULL")));
	PreventCommandIfReadOnly("abacus_goose()");
	PreventCommandIfParallelMode("abacus_goose()");
	InitMaterializedSRF(fcinfo, 0);
	shape_dimension(&header->facts.form, PG_GETARG_INT32(2));

	source_prepare(&source, text_to_cstring(PG_GETARG_TEXT_PP(1)));
	table = goose_table_create(PG_GETARG_TEXT_PP(0), header->facts.form.dimension);
	triangulate(table, &source, header, goose);
	goose_table_remove_ghosts(table);
	goose_table_close(table);
	put_counts(&figures, goose);
	put_times(&figures, goose);
	put_searches(&figures, goose);
	put_sizes(&figures, table->relid);
	source_finish(&source);
	PG_RETURN_NULL();
}
