/*
 * plan.c: how a query on a published mesh is planned.
 *
 * There is one path without parameters, and one for each set of other tables that give conditions
 * on places: a join may then look up places for each row of these tables.
 */
#include "postgres.h"

#include "access/sysattr.h"
#include "access/table.h"
#include "catalog/pg_class.h"
#include "miscadmin.h"
#include "optimizer/cost.h"
#include "optimizer/optimizer.h"
#include "optimizer/pathnode.h"
#include "optimizer/paths.h"
#include "optimizer/planmain.h"
#include "optimizer/restrictinfo.h"
#include "parser/parsetree.h"
#include "utils/lsyscache.h"

#include "pg/fdw/estimate.h"
#include "pg/fdw/order.h"
#include "pg/fdw/wrapper.h"
#include "pg/port/port.h"

/* The cost of finding one more of the nearest vertices, in rows. */
#define ROWS_PER_NEAREST 20.0
/* More of these are found together only on demand. */
#define MOST_AT_FIRST 1000

/* Each simplex checked in a page costs this many operators. */
#define OPERATORS_PER_ROW 2.0

/* What planning keeps of a table: fdw_private of its RelOptInfo. */
typedef struct Planned
{
	Shown		shown;
	MeshSize	size;
	List	   *conditions;		/* of the query on this table alone */
	Share		share;
} Planned;

static void
get_rel_size(PlannerInfo *root, RelOptInfo *rel, Oid relid)
{
	Planned    *planned = palloc0(sizeof(Planned));
	Relation	table = table_open(relid, NoLock);
	List	   *others = NIL;
	ListCell   *cell;

	planned->shown.root = root;
	planned->shown.relation = rel->relid;
	planned->shown.published = published_read(table);
	table_close(table, NoLock);
	estimate_mesh(planned->shown.published, OidIsValid(rel->userid) ? rel->userid : GetUserId(),
				  &planned->size);
	planned->conditions = conditions_of_clauses(&planned->shown, rel->baserestrictinfo);
	estimate_share(&planned->shown, &planned->size, planned->conditions, &planned->share);
	rel->fdw_private = planned;

	rel->tuples = planned->size.rows;
	rel->pages = (BlockNumber) planned->size.pages;
	set_baserel_size_estimates(root, rel);	/* width, and the cost of conditions */
	foreach(cell, rel->baserestrictinfo)
	{
		RestrictInfo *clause = lfirst_node(RestrictInfo, cell);
		Condition	condition;

		if (!condition_of_clause(&planned->shown, clause->clause, &condition) ||
			condition.column.holds == HOLDS_ATTRIBUTE)
			others = lappend(others, clause);
	}
	rel->rows = clamp_row_est(rel->tuples * planned->share.rows *
							  clauselist_selectivity(root, others, 0, JOIN_INNER, NULL));
}

/* Adds a path that some tables, or none, parameterize. */
static void
add_scan(PlannerInfo *root, RelOptInfo *rel, const Share *share, Relids outer, double rows)
{
	Planned    *planned = rel->fdw_private;
	double		pages = planned->size.pages * share->pages;
	double		looked_at = rel->tuples * share->pages;
	Cost		startup = rel->baserestrictcost.startup + rel->reltarget->cost.startup;
	Cost		run;

	/* a window begins with a walk to it */
	if (!share->is_whole)
		pages = Max(1, pages) + 2;
	run = pages * (share->is_whole ? seq_page_cost : random_page_cost) +
		looked_at * OPERATORS_PER_ROW * cpu_operator_cost +
		rel->tuples * share->rows * (cpu_tuple_cost + rel->baserestrictcost.per_tuple) +
		rows * rel->reltarget->cost.per_tuple;
	add_path(rel, (Path *) port_create_foreignscan_path(root, rel, rows, startup, startup + run, NIL,
														outer, NIL));
}

/* Adds a path that returns the nearest points first, for a query with a limit that wants them. */
static void
add_nearest(PlannerInfo *root, RelOptInfo *rel)
{
	Planned    *planned = rel->fdw_private;
	Expr	   *place = planned->size.is_known && planned->size.dimension == 2 && root->limit_tuples > 0
		? order_place(&planned->shown, rel) : NULL;
	double		per_row = cpu_tuple_cost * ROWS_PER_NEAREST + rel->baserestrictcost.per_tuple;
	Cost		startup = rel->baserestrictcost.startup + rel->reltarget->cost.startup +
		random_page_cost * Min(10, planned->size.pages);
	Cost		total = startup + rel->tuples * per_row + rel->rows * rel->reltarget->cost.per_tuple;

	if (place != NULL && bms_is_empty(rel->lateral_relids))
		add_path(rel, (Path *) port_create_foreignscan_path(root, rel, rel->rows, startup, total,
															list_make1(linitial(root->query_pathkeys)),
															NULL, list_make1(place)));
}

/* Whether a clause from a join is a condition that shows which pages are needed. */
static bool
places_rows(RelOptInfo *rel, RestrictInfo *clause)
{
	Planned    *planned = rel->fdw_private;
	Condition	condition;

	return condition_of_clause(&planned->shown, clause->clause, &condition);
}

static bool
is_place(PlannerInfo *root, RelOptInfo *rel, EquivalenceClass *ec, EquivalenceMember *member,
			  void *context)
{
	const Planned *planned = rel->fdw_private;
	Column		column = condition_column(&planned->shown, (Node *) member->em_expr);

	return column.holds == HOLDS_COORDINATE || column.holds == HOLDS_CODE;
}

/* Sets of other tables that give such conditions. */
static List *
outer_sets(PlannerInfo *root, RelOptInfo *rel)
{
	List	   *clauses = list_copy(rel->joininfo);
	List	   *sets = NIL;
	ListCell   *cell;

	if (rel->has_eclass_joins)
		clauses = list_concat(clauses,
							  generate_implied_equalities_for_column(root, rel, is_place, NULL,
																	 rel->lateral_referencers));
	foreach(cell, clauses)
	{
		RestrictInfo *clause = lfirst_node(RestrictInfo, cell);
		Relids		outer;
		ListCell   *known;

		if (!join_clause_is_movable_to(clause, rel) || !places_rows(rel, clause))
			continue;
		outer = bms_del_member(bms_union(clause->clause_relids, rel->lateral_relids), rel->relid);
		foreach(known, sets)
			if (bms_equal(lfirst(known), outer))
				break;
		if (!bms_is_empty(outer) && known == NULL)
			sets = lappend(sets, outer);
	}
	return sets;
}

static void
get_paths(PlannerInfo *root, RelOptInfo *rel, Oid relid)
{
	Planned    *planned = rel->fdw_private;
	ListCell   *cell;

	add_scan(root, rel, &planned->share, rel->lateral_relids, rel->rows);
	add_nearest(root, rel);
	foreach(cell, outer_sets(root, rel))
	{
		Relids		outer = lfirst(cell);
		ParamPathInfo *info = get_baserel_parampathinfo(root, rel, outer);
		List	   *clauses = list_concat_copy(info->ppi_clauses, rel->baserestrictinfo);
		Share		share;

		estimate_share(&planned->shown, &planned->size,
					   conditions_of_clauses(&planned->shown, clauses), &share);
		add_scan(root, rel, &share, outer, info->ppi_rows);
	}
}

/* Numbers of the columns that a query needs, from 0. */
static List *
wanted_columns(const RelOptInfo *rel, int count)
{
	Bitmapset  *used = NULL;
	List	   *wanted = NIL;
	ListCell   *cell;

	pull_varattnos((Node *) rel->reltarget->exprs, rel->relid, &used);
	foreach(cell, rel->baserestrictinfo)
		pull_varattnos((Node *) lfirst_node(RestrictInfo, cell)->clause, rel->relid, &used);
	foreach(cell, rel->joininfo)
		pull_varattnos((Node *) lfirst_node(RestrictInfo, cell)->clause, rel->relid, &used);
	for (int i = 0; i < count; i++)
		if (bms_is_member(0 - FirstLowInvalidHeapAttributeNumber, used) ||
			bms_is_member(i + 1 - FirstLowInvalidHeapAttributeNumber, used))
			wanted = lappend_int(wanted, i);
	return wanted;
}

static ForeignScan *
get_plan(PlannerInfo *root, RelOptInfo *rel, Oid relid, ForeignPath *path, List *targets,
		 List *clauses, Plan *outer_plan)
{
	Planned    *planned = rel->fdw_private;
	List	   *expressions;
	List	   *packed = conditions_pack(conditions_of_clauses(&planned->shown, clauses),
										 &expressions);
	List	   *nearest = NIL;

	if (path->fdw_private != NIL)
	{
		nearest = list_make1_int((int) Min(root->limit_tuples, MOST_AT_FIRST));
		expressions = list_concat(expressions, path->fdw_private);
	}
	return make_foreignscan(targets, extract_actual_clauses(clauses, false), rel->relid,
							expressions,
							list_make3(wanted_columns(rel, planned->shown.published->count),
									   packed, nearest),
							NIL, NIL, outer_plan);
}

/* Rejects changes of rows before the executor does so without a hint. */
static List *
plan_modify(PlannerInfo *root, ModifyTable *plan, Index target, int subplan)
{
	Oid			relid = planner_rt_fetch(target, root)->relid;
	Relation	table = table_open(relid, NoLock);
	Oid			mesh = published_mesh(table);

	table_close(table, NoLock);
	ereport(ERROR,
			(errcode(ERRCODE_FEATURE_NOT_SUPPORTED),
			 errmsg("cannot change foreign table \"%s\": it shows a mesh", get_rel_name(relid)),
			 OidIsValid(mesh)
			 ? errhint("Change the mesh \"%s\" with abacus_insert() and abacus_delete(), or the "
					   "table that it follows.", get_rel_name(mesh)) : 0));
	return NIL;					/* not reached */
}

/* Workers cannot read a temporary mesh. */
static bool
is_parallel_safe(PlannerInfo *root, RelOptInfo *rel, RangeTblEntry *entry)
{
	Relation	table = table_open(entry->relid, NoLock);
	Oid			mesh = published_mesh(table);

	table_close(table, NoLock);
	return OidIsValid(mesh) && get_rel_persistence(mesh) != RELPERSISTENCE_TEMP;
}

void
wrapper_set_planner(FdwRoutine *routine)
{
	routine->GetForeignRelSize = get_rel_size;
	routine->GetForeignPaths = get_paths;
	routine->GetForeignPlan = get_plan;
	routine->PlanForeignModify = plan_modify;
	routine->IsForeignScanParallelSafe = is_parallel_safe;
}
