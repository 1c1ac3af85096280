/*
 * analyze.c: ANALYZE of a published mesh. It reads all rows and keeps some at random.
 */
#include "postgres.h"

#include "access/htup_details.h"
#include "commands/vacuum.h"
#include "miscadmin.h"
#include "utils/memutils.h"
#include "utils/sampling.h"

#include "pg/fdw/estimate.h"
#include "pg/fdw/mesh_rows.h"
#include "pg/fdw/wrapper.h"

/* All columns. */
static Bitmapset *
all_columns(const Published *published)
{
	Bitmapset  *all = NULL;

	for (int i = 0; i < published->count; i++)
		if (published->columns[i].holds != HOLDS_NOTHING)
			all = bms_add_member(all, i);
	return all;
}

/* Keeps `target` of all rows, each with the same probability. */
static int
acquire_sample(Relation table, int level, HeapTuple *sample, int target, double *all,
			   double *dead)
{
	const Bounds whole = {0};
	TupleDesc	type = RelationGetDescr(table);
	Published  *published = published_read(table);
	MeshRows   *rows = mesh_rows_open(table, published, all_columns(published), GetUserId(),
									  CurrentMemoryContext);
	Datum	   *values = palloc(type->natts * sizeof(Datum));
	bool	   *isnull = palloc(type->natts * sizeof(bool));
	MemoryContext memory = AllocSetContextCreate(CurrentMemoryContext, "Abacus sample",
												 ALLOCSET_DEFAULT_SIZES);
	ReservoirStateData reservoir;
	double		seen = 0;
	double		to_skip = -1;
	int			count = 0;

	reservoir_init_selection_state(&reservoir, target);
	mesh_rows_begin(rows, &whole);
	for (;; seen++)
	{
		MemoryContext old = MemoryContextSwitchTo(memory);
		bool		is_row = mesh_rows_next(rows, values, isnull);
		int			place = count;

		MemoryContextSwitchTo(old);
		if (!is_row)
			break;
		if (count == target && to_skip < 0)
			to_skip = reservoir_get_next_S(&reservoir, seen, target);
		if (count < target)
			count++;
		else if (to_skip-- > 0)
			place = -1;
		else
		{
			place = (int) (target * sampler_random_fract(&reservoir.randstate));
			heap_freetuple(sample[place]);
		}
		if (place >= 0)
			sample[place] = heap_form_tuple(type, values, isnull);
		MemoryContextReset(memory);
	}
	mesh_rows_close(rows);
	MemoryContextDelete(memory);
	*all = seen;
	*dead = 0;
	return count;
}

/* Whether the mesh still has everything that the table shows, and the user may read it. */
static bool
has_all(const Published *published, Oid user)
{
	Numbering  *numbering = palloc(sizeof(Numbering));
	Reader	   *reader = published_open_mesh(published, user, CurrentMemoryContext, numbering);
	bool		has = true;

	for (int i = 0; i < published->count; i++)
		has = has && published_has(&published->columns[i], numbering) &&
			(published->columns[i].holds != HOLDS_REGION || reader->header.facts.census.regions == 0 ||
			 region_names_may_read(published->mesh, user));
	host_destroy(reader->host);
	pfree(numbering);
	return has;
}

static bool
analyze_table(Relation table, AcquireSampleRowsFunc *acquire, BlockNumber *pages)
{
	Oid			owner = table->rd_rel->relowner;
	Published  *published;
	MeshSize	size;

	/*
	 * A warning skips a table without its mesh, or whose owner may not read it or its regions. It also skips a
	 * table that shows a dropped attribute: an error would end the ANALYZE of a whole database.
	 */
	if (!OidIsValid(published_mesh(table)))
		return false;
	published = published_read(table);
	estimate_mesh(published, owner, &size);
	if (!size.is_known || !has_all(published, owner))
		return false;
	*acquire = acquire_sample;
	*pages = (BlockNumber) size.pages;
	return true;
}

void
wrapper_set_analyze(FdwRoutine *routine)
{
	routine->AnalyzeForeignTable = analyze_table;
}
