/*
 * fn_goose.c: abacus_goose, the dissertation's chapter 2: a triangulation as a
 * table of rows, grown by searches of an R-tree, and what that cost.
 */
#include "postgres.h"

#include "funcapi.h"
#include "miscadmin.h"
#include "utils/builtins.h"

#include "pg/build.h"
#include "pg/goose_table.h"
#include "pg/settings.h"
#include "pg/sql_function.h"

SQL_FUNCTION(abacus_sql_goose);

static void
put_figure(ReturnSetInfo *set, const char *name, double value, const char *description)
{
	Datum		values[3];
	bool		isnull[3] = {false};

	values[0] = CStringGetTextDatum(name);
	values[1] = Float8GetDatum(value);
	values[2] = CStringGetTextDatum(description);
	tuplestore_putvalues(set->setResult, set->setDesc, values, isnull);
}

static double
share(uint64 part, uint64 whole)
{
	return whole == 0 ? 0 : (double) part / (double) whole;
}

/* Counts of the mesh, and of what was made for it. */
static void
put_counts(ReturnSetInfo *set, const abacus_goose_figures *figures)
{
	put_figure(set, "vertices", (double) figures->vertices,
			   "distinct points; 0 while they span no simplex");
	put_figure(set, "duplicates", (double) figures->duplicates, "points that equal an earlier one");
	put_figure(set, "simplices", (double) figures->simplices, "simplices, a row each");
	put_figure(set, "hull_facets", (double) figures->ghosts,
			   "facets of the convex hull, rows until the end");
	put_figure(set, "created", (double) figures->created, "rows inserted, hull facets included");
	put_figure(set, "deleted", (double) figures->deleted, "rows deleted again");
	put_figure(set, "deleted_percent", 100 * share(figures->deleted, figures->created),
			   "share of the rows that were deleted again");
}

/* Section 2.3.2: how many boxes a search looks at for what it finds. */
static void
put_searches(ReturnSetInfo *set, const abacus_goose_figures *figures)
{
	put_figure(set, "boxes_per_search", share(figures->search_boxes, figures->searches),
			   "boxes of the index that the search for a point looks at");
	put_figure(set, "found_per_search", share(figures->found, figures->searches),
			   "simplices whose box contains the point");
	put_figure(set, "hits_per_search", share(figures->deleted, figures->searches),
			   "simplices in conflict with the point");
	put_figure(set, "search_efficiency_percent",
			   100 * share(figures->found, figures->search_boxes),
			   "simplices found, of the boxes looked at");
	put_figure(set, "boxes_per_deletion", share(figures->unlink_boxes, figures->deleted),
			   "boxes that the search for a row to be deleted looks at");
	put_figure(set, "box_unit", figures->unit, "coordinates are multiplied by this in boxes");
}

/* Figure 2.9: where the time of an insertion goes. */
static void
put_times(ReturnSetInfo *set, const abacus_goose_figures *figures)
{
	uint64		delete_ns = figures->unlink_ns + figures->erase_ns;
	uint64		other_ns = figures->total_ns - figures->search_ns - figures->test_ns - delete_ns -
		figures->insert_ns;

	put_figure(set, "insertion_seconds", 1e-9 * (double) figures->total_ns,
			   "time of all insertions, without reading and sorting the points");
	put_figure(set, "search_percent", 100 * share(figures->search_ns, figures->total_ns),
			   "searching the R-tree, rows included");
	put_figure(set, "incircle_percent", 100 * share(figures->test_ns, figures->total_ns),
			   "in-circle or in-sphere tests");
	put_figure(set, "delete_percent", 100 * share(delete_ns, figures->total_ns),
			   "deleting from the R-tree");
	put_figure(set, "insert_percent", 100 * share(figures->insert_ns, figures->total_ns),
			   "inserting into the R-tree");
	put_figure(set, "other_percent", 100 * share(other_ns, figures->total_ns),
			   "other operations: cavities, boxes");
	put_figure(set, "delete_search_percent", 100 * share(figures->unlink_ns, delete_ns),
			   "share of searching in the time of deleting");
}

static double
bytes_of(PGFunction function, Oid relid)
{
	return (double) DatumGetInt64(DirectFunctionCall1(function, ObjectIdGetDatum(relid)));
}

static void
put_sizes(ReturnSetInfo *set, Oid relid)
{
	put_figure(set, "table_bytes", bytes_of(pg_table_size, relid),
			   "size of the table, with deleted rows until VACUUM");
	put_figure(set, "index_bytes", bytes_of(pg_indexes_size, relid), "size of its index");
}

/* Reads the points of the query into a stage and triangulates them into the table. */
static void
triangulate(GooseTable *table, Source *source, abacus_header *header,
			abacus_goose_figures *figures)
{
	Host	   *host = host_create(CurrentMemoryContext, table->relid, MESH_WRITE);
	abacus_stage *stage = NULL;
	const uint64 *points;
	size_t		count;

	goose_table_own(table, host);
	progress_begin(&host->progress, table->relid);
	host_run(host, abacus_stage_open(&host->table, header, setting_sort_bytes(),
									 &stage, &host->failure));
	host_own(host, stage, (void (*) (void *)) abacus_stage_close);
	source_open(source, header);
	while ((count = source_fetch(source, &points)) > 0)
		host_run(host, abacus_stage_add(stage, points, count, &host->failure));
	source_close(source);
	host_run(host, abacus_stage_end(stage, header, &host->failure));
	host_run(host, abacus_goose_run(&host->table, &table->rtree, stage, header, figures,
									&host->failure));
	progress_end(&host->progress);
	host_destroy(host);
}

/* abacus_goose(mesh text, query text, dimension int) -> name, value, description */
Datum
abacus_sql_goose(PG_FUNCTION_ARGS)
{
	abacus_header *header = palloc0(sizeof(abacus_header));
	abacus_goose_figures *figures = palloc0(sizeof(abacus_goose_figures));
	ReturnSetInfo *set = (ReturnSetInfo *) fcinfo->resultinfo;
	Source		source;
	GooseTable *table;

	if (PG_ARGISNULL(0) || PG_ARGISNULL(1) || PG_ARGISNULL(2))
		ereport(ERROR,
				(errcode(ERRCODE_NULL_VALUE_NOT_ALLOWED),
				 errmsg("mesh, query and dimension must not be NULL")));
	PreventCommandIfReadOnly("abacus_goose()");
	PreventCommandIfParallelMode("abacus_goose()");
	InitMaterializedSRF(fcinfo, 0);
	shape_dimension(header, PG_GETARG_INT32(2));

	source_prepare(&source, text_to_cstring(PG_GETARG_TEXT_PP(1)));
	table = goose_table_create(PG_GETARG_TEXT_PP(0), header->dimension);
	triangulate(table, &source, header, figures);
	goose_table_remove_ghosts(table);
	goose_table_close(table);
	put_counts(set, figures);
	put_times(set, figures);
	put_searches(set, figures);
	put_sizes(set, table->relid);
	source_finish(&source);
	PG_RETURN_NULL();
}
