/*
 * fn_stats.c: abacus_stats, the figures of a mesh.
 *
 * Counts and counters come from the header, sizes from the files, and, if the
 * session has the mesh in its cache, the counters of its own reading.
 */
#include "postgres.h"

#include "access/table.h"
#include "funcapi.h"
#include "utils/fmgrprotos.h"
#include "utils/lsyscache.h"

#include "abacus/build.h"
#include "abacus/check.h"
#include "abacus/load.h"
#include "abacus/locate.h"
#include "abacus/octree.h"
#include "pg/base/sql_function.h"
#include "pg/host/progress.h"
#include "pg/levels/levels_table.h"
#include "pg/mesh/mesh_cache.h"
#include "pg/mesh/reader.h"
#include "pg/shards/shard_check.h"
#include "pg/remote/shard_read.h"
#include "pg/sql/rows/result.h"

SQL_FUNCTION(abacus_sql_stats);

/* One row for each counter of chapter 5; for a session's reading only the counters that change. */
static void
put_counters(Figures *figures, const abacus_counters *counters, uint32 type, bool reading)
{
	const char *records = type == ABACUS_OCTREE ? "leaves" : "simplices";
	const char *a_record = type == ABACUS_OCTREE ? "leaf" : "simplex";
	const struct
	{
		const char *name;
		uint64		value;
		bool		moves_when_reading;
		const char *description;
	}			rows[] = {
		{"insertions", counters->insertions, false, "vertices added"},
		{"removals", counters->removals, false, "vertices removed"},
		{"steps", counters->steps, true, "links followed between simplices"},
		{"misses", counters->misses, true, "links that led out of the cache"},
		{"link_probes", counters->link_probes, true, "page searches by a stored neighbour key"},
		{"quick_probes", counters->quick_probes, true, "quick probes for an unknown neighbour"},
		{"ray_probes", counters->ray_probes, true, "ray-casting probes for an unknown neighbour"},
		{"concentric_probes", counters->concentric_probes, true,
		"concentric probes for an unknown neighbour"},
		{"incircle_tests", counters->incircle_tests, false,
		"insertions that asked the last created simplices where to start"},
		{"incircle_hits", counters->incircle_hits, false, "insertions that those answered"},
		{"walks", counters->walks, true, "point locations by walking"},
		{"created", counters->created, false, psprintf("%s created", records)},
		{"deleted", counters->deleted, false, psprintf("%s deleted", records)},
		{"loads", counters->loads, true, "pages read into the cache"},
		{"stores", counters->stores, false, "pages written from the cache"},
		{"rewrites", counters->rewrites, false, "pages written in place of an older version"},
		{"splits", counters->splits, false, psprintf("%s blocks split", a_record)},
		{"merges", counters->merges, false, psprintf("%s blocks merged into their neighbours", a_record)},
		{"evictions", counters->evictions, true, psprintf("%s blocks dropped from the cache", a_record)},
		{"eviction_batches", counters->eviction_batches, true, "batches of evictions"},
		{"bytes_read", counters->bytes_read, true, "bytes of the pages read"},
		{"bytes_written", counters->bytes_written, false, "bytes of the pages written"},
		{"translation_ns", counters->translation_ns, true,
		"nanoseconds spent between pages and memory, reading and writing included"},
		{"total_ns", counters->total_ns, true, "nanoseconds spent in the core"},
		{"peak_bytes", counters->peak_bytes, true, "largest amount of memory the cache held"},
		{"passes", counters->passes, false, "passes of several threads over points"},
		{"put_off", counters->put_off, false, "points that such a pass left to the next one"},
		{"waited_ns", counters->waited_ns, false,
		"nanoseconds that threads waited for the session's, of all together"},
	};

	for (int i = 0; i < lengthof(rows); i++)
		if (!reading || rows[i].moves_when_reading)
			put_figure(figures, rows[i].name, (double) rows[i].value, rows[i].description);
	if (counters->steps > 0)
		put_figure(figures, "hit_ratio", 1.0 - (double) counters->misses / counters->steps,
				   "share of the followed links that stayed in the cache");
}

static void
put_sizes(Figures *figures, const Reader *reader, Oid vertices)
{
	Oid			mesh = mesh_pages(reader->host)->mesh;
	double		table = bytes_of(pg_table_size, mesh);
	double		index = bytes_of(pg_indexes_size, mesh);

	put_figure(figures, "simplex_table_bytes", table, "size of the simplex table");
	put_figure(figures, "simplex_index_bytes", index, "size of its page index");
	put_figure(figures, "vertex_table_bytes", bytes_of(pg_table_size, vertices),
			   "size of the table of points that wait or are repeated");
	put_figure(figures, "vertex_index_bytes", bytes_of(pg_indexes_size, vertices),
			   "size of its index");
	if (reader->header.facts.census.simplices > 0)
		put_figure(figures, "bytes_per_simplex", (table + index) / reader->header.facts.census.simplices,
				   "simplex table and index, per simplex");
}

/* The kind of a mesh: of one that is not Abacus' own, as abacus_load() found it. */
static void
put_delaunay(Figures *figures, abacus_delaunay delaunay)
{
	bool		is_delaunay = abacus_is_delaunay(delaunay);

	put_figure(figures, "delaunay", is_delaunay || delaunay == ABACUS_WEAKLY_DELAUNAY ? 1 : 0,
			   is_delaunay ? "1: a Delaunay triangulation; 0: none" :
			   psprintf("1: a Delaunay triangulation; 0: none. %s",
						abacus_delaunay_reason(delaunay)));
	if (delaunay == ABACUS_CONSTRAINED)
		put_figure(figures, "constrained", 1,
				   "1: Delaunay but for the edges of its lines, which are fixed");
	put_figure(figures, "changeable", abacus_is_editable(delaunay) ? 1 : 0,
			   "1: the Delaunay triangulation that Abacus makes, which can be changed; 0: loaded, "
			   "and another one");
}

static void
put_srid(Figures *figures, const abacus_form *form)
{
	if (form->srid != 0)
		put_figure(figures, "srid", form->srid,
				   "spatial reference system of the coordinates, as PostGIS numbers it");
}

/* Rows for features that only some meshes have. */
static void
put_labels(Figures *figures, const abacus_facts *facts)
{
	if (facts->columns.labels > 0)
	{
		put_figure(figures, "labels", facts->columns.labels, "labels that a simplex may have");
		put_figure(figures, "labelled", (double) facts->census.labelled, "simplices that have labels");
		put_figure(figures, "labels_inherited", facts->columns.inherits,
				   "1: new simplices get the labels of the one that their centroid lay in; 0: none");
	}
	if (facts->census.marked > 0)
		put_figure(figures, "marked", (double) facts->census.marked,
				   "simplices beside a facet with a marker");
}

static void
put_octree_counts(Figures *figures, const abacus_facts *facts)
{
	put_figure(figures, "dimension", facts->form.dimension, "2 for a quadtree, 3 for an octree");
	put_figure(figures, "attributes", facts->columns.attributes, "attributes of a leaf");
	put_figure(figures, "levels", facts->form.levels, "the finest level that a leaf may have");
	put_figure(figures, "leaves", (double) facts->census.leaves, "leaves of the octree");
	put_srid(figures, &facts->form);
}

/* An octree's table has octants where a mesh's has simplices. */
static void
put_octree_sizes(Figures *figures, const Reader *reader)
{
	Oid			octree = mesh_pages(reader->host)->mesh;
	double		table = bytes_of(pg_table_size, octree);
	double		index = bytes_of(pg_indexes_size, octree);

	put_figure(figures, "octant_table_bytes", table, "size of the table of octants");
	put_figure(figures, "octant_index_bytes", index, "size of its page index");
	put_figure(figures, "bytes_per_leaf", (table + index) / reader->header.facts.census.leaves,
			   "table of octants and index, per leaf");
}

static void
put_counts(Figures *figures, const abacus_facts *facts)
{
	double		inserted = (double) facts->census.vertices + (double) facts->census.duplicates;
	double		waiting = (double) (facts->census.staged - facts->census.inserted);

	put_figure(figures, "dimension", facts->form.dimension, "2 for triangles, 3 for tetrahedra");
	put_figure(figures, "attributes", facts->columns.attributes, "attributes of a vertex");
	put_figure(figures, "points", inserted + waiting, "all points");
	put_figure(figures, "inserted", inserted, "points in the triangulation");
	put_figure(figures, "waiting", waiting, "points that wait to be inserted");
	put_figure(figures, "vertices", (double) facts->census.vertices,
			   "distinct points in the triangulation; 0 while they span no simplex");
	put_figure(figures, "duplicates", (double) facts->census.duplicates,
			   "points in the triangulation that equal an earlier one");
	put_figure(figures, "simplices", (double) facts->census.simplices, "simplices of the mesh");
	put_figure(figures, "hull_facets", (double) facts->census.ghosts,
			   abacus_is_convex(facts->standing) ? "facets of its convex hull"
			   : "facets of its boundary");
	put_figure(figures, "outside", (double) facts->census.outside,
			   "points that the domain does not fit, since it was last chosen");
	put_delaunay(figures, facts->standing);
	if (facts->census.split > 0)
		put_figure(figures, "split_nodes", (double) facts->census.split,
				   "vertices that share their place with another one");
	put_labels(figures, facts);
	put_srid(figures, &facts->form);
}

/* Of the levels that the user may read. */
static void
put_levels(Figures *figures, Oid mesh, uint64 stamp)
{
	Level	   *levels;
	int			count = levels_read_if_allowed(mesh, &levels);
	int			lost;

	if (!levels_may_read(mesh))
		return;
	lost = levels_count_lost(mesh, levels, count);
	if (count + lost == 0)
		return;
	put_figure(figures, "levels", count, "coarser meshes beside it, see abacus_levels()");
	put_figure(figures, "levels_old", levels_count_old(levels, count, stamp),
			   "levels made before the last change of the mesh: abacus_levels_refresh() makes them anew");
	put_figure(figures, "levels_lost", lost,
			   "levels that were dropped, or that the table of levels does not name: abacus_levels_drop() and abacus_levels() make all anew");
}

/*
 * A notice if the domain of a mesh does not fit its points and abacus_build() would choose another
 * one. A mesh that cannot be changed gets none.
 */
static void
report_domain(Reader *reader)
{
	Host	   *host = reader->host;
	const abacus_facts *facts = &reader->header.facts;
	int			fits;

	if (!abacus_is_editable(facts->standing))
		return;
	host_run(host, abacus_domain_fits, &host->table, facts, &fits);
	if (!fits)
		ereport(NOTICE,
				(errmsg("the domain of mesh \"%s\" does not fit its points",
						get_rel_name(mesh_pages(host)->mesh)),
				 errdetail("Finding pages takes longer than necessary."),
				 errhint("CALL abacus_build for the mesh to give it a new domain and its pages new "
						 "keys. This takes as long as building the mesh.")));
}

/* How well threads were used, which differs from machine to machine, so no mesh stores it. */
static void
put_busy(Figures *figures)
{
	ProcessorTime used;

	if (!progress_last_with_threads(&used))
		return;
	put_figure(figures, "session_busy_all", (double) used.all / used.elapsed,
			   "processors that this session's last work with several threads kept busy, of any mesh");
	put_figure(figures, "session_busy_own", (double) used.session / used.elapsed,
			   "what the session's own thread took of one processor meanwhile");
}

/* abacus_stats(mesh regclass) -> name, value, description */
Datum
abacus_sql_stats(PG_FUNCTION_ARGS)
{
	Oid			mesh = PG_GETARG_OID(0);
	Figures		figures = {(ReturnSetInfo *) fcinfo->resultinfo, ""};
	Reader	   *reader;
	bool		is_octree;
	Oid			vertices;
	const CachedMesh *cached;

	if (is_over_shards(fcinfo))
		return shard_stats(fcinfo);
	reader = reader_open_of(mesh, ANY_TYPE, CurrentMemoryContext);
	is_octree = reader->header.facts.form.type == ABACUS_OCTREE;
	vertices = mesh_pages_vertex_table(mesh_pages(reader->host));
	cached = mesh_cache_peek(mesh);
	if (!is_octree)
		report_domain(reader);
	host_release(reader->host);
	InitMaterializedSRF(fcinfo, 0);
	if (is_octree)
	{
		put_octree_counts(&figures, &reader->header.facts);
		put_octree_sizes(&figures, reader);
	}
	else
	{
		put_counts(&figures, &reader->header.facts);
		put_levels(&figures, mesh, reader->header.stamp);
		put_sizes(&figures, reader, vertices);
	}
	put_counters(&figures, &reader->header.counters, reader->header.facts.form.type, false);
	if (cached != NULL)
	{
		abacus_counters counters;

		if (cached->octree != NULL)
			abacus_octree_counters(cached->octree, &counters);
		else
			abacus_mesh_counters(cached->mesh, &counters);
		figures.prefix = "session_";
		put_counters(&figures, &counters, reader->header.facts.form.type, true);
	}
	figures.prefix = "";
	put_busy(&figures);
	host_destroy(reader->host);
	PG_RETURN_NULL();
}
