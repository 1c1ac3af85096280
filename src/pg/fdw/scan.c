/*
 * scan.c: how a query on a published mesh runs.
 *
 * The mesh is opened when the first row is needed, since the values in the conditions are known
 * then. A scan that begins again keeps the mesh open, and looks for its pages again.
 */
#include "postgres.h"

#include <float.h>

#include "executor/executor.h"
#include "lib/stringinfo.h"
#include "utils/builtins.h"
#include "utils/float.h"
#include "utils/lsyscache.h"
#include "utils/rel.h"

#include "pg/fdw/mesh_rows.h"
#include "pg/fdw/order.h"
#include "pg/fdw/wrapper.h"
#include "pg/port/port.h"

typedef struct MeshScan
{
	Published  *published;
	Bitmapset  *wanted;
	List	   *conditions;
	List	   *values;			/* ExprStates, as fdw_exprs */
	ExprContext *context;
	Oid			user;
	MeshRows   *rows;			/* NULL: not opened yet */
	uint64		nearest;		/* how many to look for at first; 0: in no order */
	bool		has_begun;
	Bounds		bounds;			/* once begun */
} MeshScan;

static void
begin_scan(ForeignScanState *state, int flags)
{
	ForeignScan *plan = (ForeignScan *) state->ss.ps.plan;
	MeshScan   *scan = palloc0(sizeof(MeshScan));
	ListCell   *cell;

	scan->published = published_read(state->ss.ss_currentRelation);
	foreach(cell, list_nth(plan->fdw_private, PRIVATE_COLUMNS))
		scan->wanted = bms_add_member(scan->wanted, lfirst_int(cell));
	scan->conditions = conditions_unpack(list_nth(plan->fdw_private, PRIVATE_CONDITIONS),
										 plan->fdw_exprs);
	scan->values = ExecInitExprList(plan->fdw_exprs, (PlanState *) state);
	if (list_nth(plan->fdw_private, PRIVATE_NEAREST) != NIL)
		scan->nearest = linitial_int(list_nth(plan->fdw_private, PRIVATE_NEAREST));
	scan->context = state->ss.ps.ps_ExprContext;
	scan->user = port_foreign_scan_user(state);
	state->fdw_state = scan;
}

/* The position of a condition's value, or of its distance, among the expressions. */
static int
place_of_value(const MeshScan *scan, int number, bool distance)
{
	int			place = 0;

	for (int i = 0; i < number; i++)
		place += ((Condition *) list_nth(scan->conditions, i))->distance != NULL ? 2 : 1;
	return place + (distance ? 1 : 0);
}

static bool
value_now(void *context, int number, bool distance, Datum *value, bool *isnull)
{
	const MeshScan *scan = context;
	ExprState  *state = list_nth(scan->values, place_of_value(scan, number, distance));

	*value = ExecEvalExpr(state, scan->context, isnull);
	return true;
}

/* The place for the nearest rows: the last expression, a constant. */
static void
read_place(ForeignScanState *state, double *place)
{
	const Const *constant = llast_node(Const, ((ForeignScan *) state->ss.ps.plan)->fdw_exprs);

	(void) order_read_place(constant->consttype, constant->constvalue, place);
}

static void
begin_rows(ForeignScanState *state, MeshScan *scan)
{
	double		place[2] = {0, 0};

	if (scan->rows == NULL)
		scan->rows = mesh_rows_open(state->ss.ss_currentRelation, scan->published, scan->wanted,
									scan->user, state->ss.ps.state->es_query_cxt);
	conditions_bounds(scan->conditions, scan->published->content,
					  mesh_rows_dimension(scan->rows), mesh_rows_srid(scan->rows), value_now, scan,
					  &scan->bounds);
	if (scan->nearest > 0 && !scan->bounds.nothing)
	{
		read_place(state, place);
		mesh_rows_begin_nearest(scan->rows, state->ss.ss_currentRelation, scan->user, place,
								scan->nearest);
	}
	else
		mesh_rows_begin(scan->rows, &scan->bounds);
	scan->has_begun = true;
}

/* PostgreSQL calls it in a memory context that is emptied for each row. */
static TupleTableSlot *
iterate_scan(ForeignScanState *state)
{
	MeshScan   *scan = state->fdw_state;
	TupleTableSlot *slot = state->ss.ss_ScanTupleSlot;

	if (!scan->has_begun)
		begin_rows(state, scan);
	ExecClearTuple(slot);
	if (mesh_rows_next(scan->rows, slot->tts_values, slot->tts_isnull))
		ExecStoreVirtualTuple(slot);
	return slot;
}

static void
rescan(ForeignScanState *state)
{
	MeshScan   *scan = state->fdw_state;

	scan->has_begun = false;
}

static void
end_scan(ForeignScanState *state)
{
	MeshScan   *scan = state->fdw_state;

	if (scan != NULL && scan->rows != NULL)
		mesh_rows_close(scan->rows);
}

/* ---- EXPLAIN ------------------------------------------------------------- */

/* A value of a condition that EXPLAIN knows without running the query. */
static bool
constant_value(void *context, int number, bool distance, Datum *value, bool *isnull)
{
	const MeshScan *scan = context;
	const Condition *condition = list_nth(scan->conditions, number);
	const Const *constant = (Const *) (distance ? condition->distance : condition->value);

	if (!IsA(constant, Const))
		return false;
	*value = constant->constvalue;
	*isnull = constant->constisnull;
	return true;
}

static const char *
end_of_range(double value)
{
	return float8out_internal(value);
}

static void
explain_window(const abacus_window *window, uint32 dimension, ExplainState *es)
{
	StringInfoData text;

	initStringInfo(&text);
	for (uint32 i = 0; i < dimension; i++)
		if (window->lower[i] > -DBL_MAX || window->upper[i] < DBL_MAX)
			appendStringInfo(&text, "%s%c from %s to %s", text.len > 0 ? ", " : "", "xyz"[i],
							 window->lower[i] > -DBL_MAX ? end_of_range(window->lower[i]) : "-Infinity",
							 window->upper[i] < DBL_MAX ? end_of_range(window->upper[i]) : "Infinity");
	if (text.len > 0)
		ExplainPropertyText(window->kind == ABACUS_BOUNDS_WINDOW ? "Window of Boxes" : "Window",
							text.data, es);
}

static bool
is_any_unknown(MeshScan *scan)
{
	for (int i = 0; i < list_length(scan->conditions); i++)
	{
		Datum		value;
		bool		isnull;

		if (!constant_value(scan, i, false, &value, &isnull))
			return true;
	}
	return false;
}

static void
explain_scan(ForeignScanState *state, ExplainState *es)
{
	MeshScan   *scan = state->fdw_state;
	double		place[2];
	Bounds		bounds;

	ExplainPropertyText("Mesh", get_rel_name(scan->published->mesh), es);
	if (scan->has_begun)
		bounds = scan->bounds;
	else
		conditions_bounds(scan->conditions, scan->published->content, ABACUS_MAX_DIMENSION,
						  SRID_UNKNOWN, constant_value, scan, &bounds);
	if (scan->nearest > 0)
	{
		read_place(state, place);
		ExplainPropertyText("Nearest to", psprintf("%s, %s", end_of_range(place[0]),
												   end_of_range(place[1])), es);
		return;
	}
	if (bounds.nothing)
		ExplainPropertyText("Window", "nothing", es);
	else if (!scan->has_begun && is_any_unknown(scan))
		ExplainPropertyText("Window", "at run time", es);
	else if (bounds.has_codes)
		ExplainPropertyText("Codes", psprintf("from " UINT64_FORMAT " to " UINT64_FORMAT,
											  bounds.least_code, bounds.greatest_code), es);
	else if (bounds.window.kind != ABACUS_NO_WINDOW)
		explain_window(&bounds.window, scan->has_begun ? mesh_rows_dimension(scan->rows)
					   : ABACUS_MAX_DIMENSION, es);
	if (bounds.has_range && !bounds.nothing)
		ExplainPropertyText("Range",
							psprintf("attribute %u from %s to %s", bounds.range.attribute + 1,
									 end_of_range(bounds.range.least),
									 end_of_range(bounds.range.greatest)), es);
	if (es->analyze && scan->rows != NULL)
		ExplainPropertyInteger("Mesh Pages Read", NULL, (int64) mesh_rows_pages(scan->rows), es);
}

void
wrapper_set_executor(FdwRoutine *routine)
{
	routine->BeginForeignScan = begin_scan;
	routine->IterateForeignScan = iterate_scan;
	routine->ReScanForeignScan = rescan;
	routine->EndForeignScan = end_scan;
	routine->ExplainForeignScan = explain_scan;
}
