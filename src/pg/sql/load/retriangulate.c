/*
 * retriangulate.c: a triangulation made elsewhere becomes Abacus' own of the same vertices.
 *
 * With labels or markers, the one that was given is written first. Then it is replaced as any change
 * replaces simplices. So what is in both keeps its labels and markers, and new simplices may inherit.
 */
#include "postgres.h"

#include "executor/spi.h"
#include "lib/stringinfo.h"

#include "pg/lines/loaded_lines.h"
#include "pg/sql/load/retriangulate.h"

/* What a triangulation had that has been replaced, and what of it is in the new one. */
typedef struct Carried
{
	uint64		labelled;
	uint64		lost;
	uint64		facets;
	uint64		kept;
} Carried;

static char *
carried_in_words(const abacus_form *form, const Carried *carried)
{
	StringInfoData words;

	initStringInfo(&words);
	if (carried->labelled > 0)
		appendStringInfo(&words, " Of " UINT64_FORMAT " %s with labels the new one lacks " UINT64_FORMAT ".",
						 carried->labelled, form->dimension == 2 ? "triangles" : "tetrahedra", carried->lost);
	if (carried->facets > 0)
		appendStringInfo(&words, " Of " UINT64_FORMAT " facets with markers it lacks " UINT64_FORMAT ".",
						 carried->facets, carried->facets - carried->kept);
	return words.data;
}

/* A triangulation that is not Abacus' own, and is triangulated anew. */
static void
tell_retriangulated(const abacus_form *form, abacus_delaunay delaunay, bool inherit, const Carried *carried)
{
	ereport(NOTICE,
			(errmsg("the vertices have been triangulated anew"),
			 errdetail("About the triangulation that was given: %s%s", abacus_delaunay_reason(delaunay),
					   carried_in_words(form, carried)),
			 carried->lost == 0 ? 0
			 : inherit ? errhint("New simplices have the labels of those that their centroids lay in.")
			 : errhint("New simplices have no labels. With inherit => true they get those of the simplices that "
					   "their centroids lay in.")));
}

/* Opens a stage with the loaded vertices. */
static void
stage_vertices(Change *change)
{
	change_open_stage(change, &change->writer.header->facts);
	host_run(change->writer.host, abacus_load_stage, change->load, change->stage);
	abacus_load_close(change->load);
	change->load = NULL;
}

/* How many facets of the mesh have markers, each counted once. */
static uint64
count_facets(Change *change, const char *facets)
{
	Datum		count;
	bool		isnull;

	if (change->writer.header->facts.census.marked == 0)
		return 0;
	change_show(change);
	SPI_connect();
	query_first(psprintf("SELECT pg_catalog.count(*) FROM %s('%u'::pg_catalog.regclass)", facets,
						 RelationGetRelid(mesh_pages(change->writer.host)->simplices.heap)), &count, &isnull, 1);
	SPI_finish();
	return (uint64) DatumGetInt64(count);
}

/* Triangulates the loaded vertices. */
static void
triangulate_vertices(Change *change, NamedRows *edges)
{
	abacus_facts *facts = &change->writer.header->facts;

	/* vertices at one place are now repeated points, as in any mesh */
	facts->columns.apart = abacus_are_apart(facts->form.dimension, facts->columns.attributes);
	stage_vertices(change);
	change_insert(change);
	if (edges != NULL)
		loaded_lines_add(change, edges);
}

/*
 * Writes the triangulation as it was given, and then replaces it by Abacus' own of its vertices, in one
 * change that labels and markers follow.
 */
static void
replace_triangulation(Change *change, const Retriangulation *anew, NamedRows *edges, Carried *carried)
{
	Host	   *host = change->writer.host;
	abacus_header *header = change->writer.header;
	uint64		deleted;

	host_run(host, abacus_load_write, change->load, 1, header);
	carried->labelled = header->facts.census.labelled;
	carried->facets = count_facets(change, anew->facets);
	header->facts.standing = ABACUS_DELAUNAY;
	header->facts.census.split = 0;
	stage_vertices(change);
	change_open_build(change);
	header->facts.columns.inherits = anew->labels && anew->inherit ? 1 : 0;
	host_run(host, abacus_build_clear, change->build, header, &deleted);
	change_insert(change);
	if (edges != NULL)
		loaded_lines_add(change, edges);
	change_settle(change);
	header->facts.columns.inherits = 0;
	carried->lost = abacus_build_lost_labels(change->build);
	carried->kept = count_facets(change, anew->facets);
}

/*
 * Makes Abacus' own triangulation of the vertices of one that has been read, and says what has become of
 * that. `edges` are NULL, or those of its lines.
 */
void
retriangulate(Change *change, const Retriangulation *anew, NamedRows *edges, abacus_delaunay delaunay)
{
	Carried		carried = {0};

	if (anew->labels || anew->markers)
		replace_triangulation(change, anew, edges, &carried);
	else
		triangulate_vertices(change, edges);
	tell_retriangulated(&change->writer.header->facts.form, delaunay, anew->inherit, &carried);
}
