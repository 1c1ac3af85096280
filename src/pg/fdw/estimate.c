/*
 * estimate.c: how many rows and pages of a published mesh a query needs.
 *
 * The header says how many simplices and vertices there are, and in which box. It is read only if
 * the user has the right to read it. The estimate assumes that points are spread evenly over the
 * box. A cell that meets a window may reach beyond it, so for cells windows count as larger by a
 * cell, and for pages as larger by a page.
 */
#include "postgres.h"

#include <math.h>

#include "access/relation.h"
#include "optimizer/optimizer.h"
#include "storage/bufmgr.h"
#include "utils/acl.h"
#include "utils/rls.h"
#include "utils/selfuncs.h"
#include "utils/snapmgr.h"

#include "pg/fdw/estimate.h"
#include "pg/mesh/mesh.h"
#include "pg/port/port.h"

/* For a mesh that the user may not read. */
#define UNKNOWN_ROWS 100000.0
#define UNKNOWN_PAGES 100.0
/* For a window or a geometry that is known only when the query runs. */
#define UNKNOWN_SHARE 0.001

#define SIMPLICES_OF_PAGE 600.0

/* The number of codes. */
#define CODES_IN_THE_PLANE 0x1p62
#define CODES_IN_SPACE 0x1p63

static bool
may_read(Oid mesh, Oid user)
{
	return ActiveSnapshotSet() && (mesh_of_table(mesh) == mesh || mesh_is_sharded(mesh)) &&
		pg_class_aclcheck(mesh, user, ACL_SELECT) == ACLCHECK_OK &&
		check_enable_rls(mesh, user, true) != RLS_ENABLED;
}

/* Those of a mesh over several servers are not here to be counted. */
static double
pages_of(Oid mesh, const abacus_census *census)
{
	Relation	table;
	double		pages;

	if (mesh_is_sharded(mesh))
		return Max(1, (double) census->simplices / SIMPLICES_OF_PAGE);
	table = relation_open(mesh, AccessShareLock);
	pages = RelationGetNumberOfBlocks(table);
	relation_close(table, NoLock);
	return Max(1, pages);
}

/* Reads the size of a mesh, with the rights of the query's user, so that errors are the same. */
void
estimate_mesh(const Published *published, Oid user, MeshSize *size)
{
	Reader	   *reader;

	MemSet(size, 0, sizeof(*size));
	size->rows = UNKNOWN_ROWS;
	size->pages = UNKNOWN_PAGES;
	if (!may_read(published->mesh, user))
		return;
	reader = published_open_mesh(published, user, CurrentMemoryContext, NULL);
	size->is_known = true;
	size->dimension = reader->header.facts.form.dimension;
	size->rows = (double) (published->content == CONTENT_CELLS ? reader->header.facts.census.simplices
						   : reader->header.facts.census.vertices);
	memcpy(size->lower, reader->header.facts.form.lower, sizeof(size->lower));
	memcpy(size->upper, reader->header.facts.form.upper, sizeof(size->upper));
	size->pages = pages_of(published->mesh, &reader->header.facts.census);
	host_destroy(reader->host);
}

/* The share of the domain in a window that is enlarged by 1/`parts` of the domain on each axis. */
static double
part_in_window(const MeshSize *size, const abacus_window *window, double parts, int only_axis)
{
	double		part = 1;

	for (uint32 i = 0; i < size->dimension; i++)
	{
		double		extent = size->upper[i] - size->lower[i];
		double		more = parts > 0 ? extent / parts : 0;
		double		lower = Max(window->lower[i] - more / 2, size->lower[i]);
		double		upper = Min(window->upper[i] + more / 2, size->upper[i]);

		if (only_axis >= 0 && only_axis != i)
			continue;
		if (extent > 0)
			part *= Max(0, Min(1, (upper - lower) / extent));
	}
	return part;
}

static int
thinnest_axis(const MeshSize *size, const abacus_window *window)
{
	int			axis = 0;

	for (uint32 i = 1; i < size->dimension; i++)
		if (window->upper[i] / 2 - window->lower[i] / 2 <
			window->upper[axis] / 2 - window->lower[axis] / 2)
			axis = (int) i;
	return axis;
}

typedef struct PlannedValues
{
	PlannerInfo *root;
	List	   *conditions;
} PlannedValues;

/* The value of a condition, if it is known while planning. */
static bool
planned_value(void *context, int number, bool distance, Datum *value, bool *isnull)
{
	const PlannedValues *values = context;
	const Condition *condition = list_nth(values->conditions, number);
	Node	   *node = estimate_expression_value(values->root,
												 (Node *) (distance ? condition->distance
														   : condition->value));

	if (!IsA(node, Const))
		return false;
	*value = ((Const *) node)->constvalue;
	*isnull = ((Const *) node)->constisnull;
	return true;
}

/* Whether a condition on places has a value that is known only when the query runs. */
static bool
has_unknown(PlannedValues *values)
{
	ListCell   *cell;

	foreach(cell, values->conditions)
	{
		const Condition *condition = lfirst(cell);
		Datum		value;
		bool		isnull;

		if (condition->column.holds != HOLDS_ATTRIBUTE &&
			!planned_value(values, foreach_current_index(cell), false, &value, &isnull))
			return true;
	}
	return false;
}

/* The share of the mesh that the conditions leave, judged by the places of the rows. */
void
estimate_share(const Shown *shown, const MeshSize *size, List *conditions, Share *share)
{
	PlannedValues values = {shown->root, conditions};
	const Published *published = shown->published;
	double		per_axis = 1.0 / Max(2, size->dimension);
	Bounds		bounds;

	conditions_bounds(conditions, published->content, size->is_known ? size->dimension : 2,
					  SRID_UNKNOWN, planned_value, &values, &bounds);
	share->rows = share->pages = 1;
	if (bounds.nothing)
		share->rows = share->pages = 0;
	else if (bounds.window.kind != ABACUS_NO_WINDOW && size->is_known)
	{
		bool		is_slab = bounds.window.kind == ABACUS_BOUNDS_WINDOW;

		share->rows = part_in_window(size, &bounds.window, published->content == CONTENT_CELLS
									 ? pow(Max(1, size->rows), per_axis) : 0, -1);
		share->pages = part_in_window(size, &bounds.window, pow(size->pages, per_axis),
									  is_slab ? thinnest_axis(size, &bounds.window) : -1);
	}
	if (bounds.has_codes)
	{
		share->rows = ((double) bounds.greatest_code - (double) bounds.least_code + 1) /
			(size->dimension == 3 ? CODES_IN_SPACE : CODES_IN_THE_PLANE);
		share->rows = Min(1, Max(share->rows, 1 / Max(1, size->rows)));
		share->pages = Min(1, share->rows + 1 / size->pages);
	}
	if (has_unknown(&values))
	{
		share->rows = Min(share->rows, UNKNOWN_SHARE);
		share->pages = Min(share->pages, sqrt(UNKNOWN_SHARE));
	}
	/* the same rule as in RangeScan of the core */
	share->is_whole = share->pages > 0.25;
	if (share->is_whole)
		share->pages = 1;
}
