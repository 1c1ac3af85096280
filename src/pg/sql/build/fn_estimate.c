/*
 * fn_estimate.c: support functions that give the planner the number of rows of functions that read
 * a mesh.
 *
 * As for any table of PostgreSQL, the estimate reads the size of the file, which costs a system
 * call. The last VACUUM or ANALYZE shows how full the file is: a page of it holds 0 to 1 page of a
 * mesh, since old versions lie beside the new ones. The number of simplices in a page is assumed to
 * be constant. The header has the exact number, but it is a row, with privileges and a snapshot of
 * its own, and the user who plans a query may lack the right to run it.
 *
 * A relation that is not a mesh, or is not known yet, gets the estimate of CREATE FUNCTION.
 * The function reports such errors when it runs.
 */
#include "postgres.h"

#include <math.h>

#include "access/relation.h"
#include "access/xlog.h"
#include "nodes/nodeFuncs.h"
#include "nodes/supportnodes.h"
#include "optimizer/optimizer.h"
#include "storage/bufmgr.h"
#include "utils/array.h"
#include "utils/selfuncs.h"

#include "pg/base/sql_function.h"
#include "pg/mesh/mesh.h"

SQL_FUNCTION(abacus_sql_simplices_rows);
SQL_FUNCTION(abacus_sql_vertices_rows);
SQL_FUNCTION(abacus_sql_nearest_rows);
SQL_FUNCTION(abacus_sql_window_rows);
SQL_FUNCTION(abacus_sql_octant_rows);
SQL_FUNCTION(abacus_sql_range_rows);
SQL_FUNCTION(abacus_sql_surface_rows);
SQL_FUNCTION(abacus_sql_line_rows);
SQL_FUNCTION(abacus_sql_raster_rows);
SQL_FUNCTION(abacus_sql_contours_rows);

/* For fresh builds of uniform points, in the plane and in space (docs/benchmarks.md). */
#define BYTES_PER_SIMPLEX 12.0
/* For octrees without attributes. */
#define BYTES_PER_LEAF 0.5
/* In the plane, by Euler's relation; in space it is about 6.7. */
#define SIMPLICES_PER_VERTEX 2.0
/* For a point that waits to be inserted, without attributes. */
#define BYTES_PER_WAITING_POINT 32.0
/* For an unknown mesh. */
#define POINTS_OF_A_MESH 100000
/* abacus_contours: the argument fixed_levels, */
#define CONTOURS_FIXED_LEVELS 3
/*
 * ... levels of a mesh without it, and lines of a level, times the root of the number of triangles.
 */
#define LEVELS_OF_A_MAP 20
#define LINES_OF_A_LEVEL 0.1
/* A plane cuts this times n^(2/3) of n tetrahedra. */
#define CUT_BY_A_PLANE 2.0

/*
 * Whether a table has a readable file here. An unlogged table has none on a standby. The pages of
 * another session's temporary table may never have reached its file.
 */
static bool
has_readable_file(Relation rel)
{
	if (RELATION_IS_OTHER_TEMP(rel))
		return false;
	return RelationIsPermanent(rel) || !RecoveryInProgress();
}

/*
 * Bytes of a table's live pages; negative if the table no longer exists or cannot be read. As in
 * pg_relation_size(), it does not stay locked: users who may not read the table should not hold up
 * others.
 */
static double
live_bytes(Oid relid)
{
	Relation	rel = OidIsValid(relid) ? try_relation_open(relid, AccessShareLock) : NULL;
	double		bytes = -1;

	if (rel == NULL)
		return -1;
	if (has_readable_file(rel))
	{
		bytes = (double) RelationGetNumberOfBlocks(rel) * BLCKSZ;
		if (rel->rd_rel->relpages > 0 && rel->rd_rel->reltuples >= 0)
			bytes *= Min(1.0, (double) rel->rd_rel->reltuples / rel->rd_rel->relpages);
	}
	relation_close(rel, AccessShareLock);
	return bytes;
}

/*
 * The mesh of a call: InvalidOid if it is unknown before the call runs, or not a mesh. *none
 * becomes true if it is NULL, since the functions then return no rows.
 */
static Oid
mesh_of_call(const SupportRequestRows *request, bool *none)
{
	Node	   *mesh;
	Oid			relid;

	*none = false;
	if (!is_funcclause(request->node))
		return InvalidOid;
	mesh = estimate_expression_value(request->root,
									 (Node *) linitial(((FuncExpr *) request->node)->args));
	if (!IsA(mesh, Const))
		return InvalidOid;
	*none = ((Const *) mesh)->constisnull;
	if (*none)
		return InvalidOid;
	relid = DatumGetObjectId(((Const *) mesh)->constvalue);
	return mesh_of_table(relid) == relid ? relid : InvalidOid;
}

/* Answers a request for the number of rows; NULL if there is no answer. */
static Datum
estimate(FunctionCallInfo fcinfo, double rows_per_simplex, bool waiting)
{
	SupportRequestRows *request = (SupportRequestRows *) PG_GETARG_POINTER(0);
	double		bytes;
	bool		none;
	Oid			mesh;

	if (!IsA(request, SupportRequestRows))
		PG_RETURN_POINTER(NULL);
	mesh = mesh_of_call(request, &none);
	request->rows = 0;
	if (none)
		PG_RETURN_POINTER(request);
	bytes = live_bytes(mesh);
	if (bytes < 0)
		PG_RETURN_POINTER(NULL);
	request->rows = bytes / BYTES_PER_SIMPLEX * rows_per_simplex;
	if (waiting)
		request->rows += Max(0, live_bytes(mesh_find_vertex_table(mesh))) / BYTES_PER_WAITING_POINT;
	PG_RETURN_POINTER(request);
}

/* abacus_simplices_rows(internal) -> internal, for abacus_simplices */
Datum
abacus_sql_simplices_rows(PG_FUNCTION_ARGS)
{
	return estimate(fcinfo, 1, false);
}

/* abacus_vertices_rows(internal) -> internal, for all vertices */
Datum
abacus_sql_vertices_rows(PG_FUNCTION_ARGS)
{
	return estimate(fcinfo, 1 / SIMPLICES_PER_VERTEX, true);
}

/* Whether an argument of a call is known to be NULL. */
static bool
is_null_argument(const SupportRequestRows *request, int argument)
{
	Node	   *value = estimate_expression_value(request->root,
												  (Node *) list_nth(((FuncExpr *) request->node)->args,
																	argument));

	return IsA(value, Const) && ((Const *) value)->constisnull;
}

/*
 * abacus_window_rows(internal) -> internal, for simplices of a window: arguments 1 and 2. Only the
 * header and the pages show how much of the mesh a window has, so PostgreSQL's own guess for a
 * range is used; it is used again if they must have a label, argument 4.
 */
Datum
abacus_sql_window_rows(PG_FUNCTION_ARGS)
{
	SupportRequestRows *request = (SupportRequestRows *) PG_GETARG_POINTER(0);
	double		share = 1;

	if (!IsA(request, SupportRequestRows) || !is_funcclause(request->node))
		PG_RETURN_POINTER(NULL);
	if (!is_null_argument(request, 1) || !is_null_argument(request, 2))
		share = DEFAULT_RANGE_INEQ_SEL;
	if (list_length(((FuncExpr *) request->node)->args) > 4 && !is_null_argument(request, 4))
		share *= DEFAULT_RANGE_INEQ_SEL;
	return estimate(fcinfo, share, false);
}

/*
 * abacus_octant_rows(internal) -> internal, for the leaves of an octree, all or in a window, and
 * for its nodes and elements.
 */
Datum
abacus_sql_octant_rows(PG_FUNCTION_ARGS)
{
	SupportRequestRows *request = (SupportRequestRows *) PG_GETARG_POINTER(0);
	bool		is_whole;

	if (!IsA(request, SupportRequestRows) || !is_funcclause(request->node))
		PG_RETURN_POINTER(NULL);
	is_whole = list_length(((FuncExpr *) request->node)->args) < 3 ||
		(is_null_argument(request, 1) && is_null_argument(request, 2));
	return estimate(fcinfo, (is_whole ? 1 : DEFAULT_RANGE_INEQ_SEL) *
					BYTES_PER_SIMPLEX / BYTES_PER_LEAF, false);
}

/*
 * abacus_range_rows(internal) -> internal, for abacus_vertices: all points, or the vertices of a
 * window, arguments 1 and 2, or with an attribute in a range, argument 3.
 */
Datum
abacus_sql_range_rows(PG_FUNCTION_ARGS)
{
	SupportRequestRows *request = (SupportRequestRows *) PG_GETARG_POINTER(0);
	double		share = 1;
	Datum		answer;

	if (!IsA(request, SupportRequestRows) || !is_funcclause(request->node))
		PG_RETURN_POINTER(NULL);
	if (!is_null_argument(request, 1) || !is_null_argument(request, 2))
		share = DEFAULT_RANGE_INEQ_SEL;
	if (list_length(((FuncExpr *) request->node)->args) > 3 && !is_null_argument(request, 3))
		share *= DEFAULT_RANGE_INEQ_SEL;
	answer = estimate(fcinfo, share / SIMPLICES_PER_VERTEX, share == 1);
	if (DatumGetPointer(answer) != NULL || share < 1)
		return answer;
	request->rows = POINTS_OF_A_MESH;
	PG_RETURN_POINTER(request);
}

/*
 * abacus_surface_rows(internal) -> internal, for surfaces through a mesh in space: they cut as many
 * tetrahedra as a plane through the middle of evenly spread points does.
 */
Datum
abacus_sql_surface_rows(PG_FUNCTION_ARGS)
{
	SupportRequestRows *request = (SupportRequestRows *) PG_GETARG_POINTER(0);
	Datum		answer = estimate(fcinfo, 1, false);

	if (DatumGetPointer(answer) != NULL)
		request->rows = CUT_BY_A_PLANE * pow(request->rows, 2.0 / 3);
	return answer;
}

/*
 * abacus_line_rows(internal) -> internal, for functions that follow a line. A line through a whole
 * mesh in the plane crosses about twice as many simplices as the root of their number; in space it
 * crosses fewer.
 */
Datum
abacus_sql_line_rows(PG_FUNCTION_ARGS)
{
	SupportRequestRows *request = (SupportRequestRows *) PG_GETARG_POINTER(0);
	bool		is_estimated = DatumGetPointer(estimate(fcinfo, 1, false)) != NULL;

	if (is_estimated && request->rows > 0)
		request->rows = Max(1, 2 * sqrt(request->rows));
	PG_RETURN_POINTER(is_estimated ? request : NULL);
}

/* At how many levels contours are drawn; if that is not given, as many as a map has. */
static double
levels_of_call(const SupportRequestRows *request)
{
	Node	   *levels = estimate_expression_value(request->root,
												   (Node *) list_nth(((FuncExpr *) request->node)->args,
																	 CONTOURS_FIXED_LEVELS));
	int			count = 0;

	if (IsA(levels, Const) && !((Const *) levels)->constisnull)
	{
		ArrayType  *array = DatumGetArrayTypeP(((Const *) levels)->constvalue);

		count = ArrayGetNItems(ARR_NDIM(array), ARR_DIMS(array));
	}
	return count > 0 ? count : LEVELS_OF_A_MAP;
}

/*
 * abacus_contours_rows(internal) -> internal, for abacus_contours. The number of lines at a level
 * depends on the values alone. On a terrain, small hills and hollows add lines, so there are more
 * in a larger mesh.
 */
Datum
abacus_sql_contours_rows(PG_FUNCTION_ARGS)
{
	SupportRequestRows *request = (SupportRequestRows *) PG_GETARG_POINTER(0);
	bool		is_estimated = DatumGetPointer(estimate(fcinfo, 1, false)) != NULL;

	if (is_estimated && request->rows > 0)
		request->rows = Max(1, levels_of_call(request) * LINES_OF_A_LEVEL * sqrt(request->rows));
	PG_RETURN_POINTER(is_estimated ? request : NULL);
}

/*
 * Answers a request for the number of rows if an argument gives it; NULL if its value is unknown.
 */
static Datum
estimate_by_argument(FunctionCallInfo fcinfo, int argument)
{
	SupportRequestRows *request = (SupportRequestRows *) PG_GETARG_POINTER(0);
	List	   *arguments;
	Node	   *count;

	if (!IsA(request, SupportRequestRows) || !is_funcclause(request->node))
		PG_RETURN_POINTER(NULL);
	arguments = ((FuncExpr *) request->node)->args;
	count = estimate_expression_value(request->root,
									  (Node *) (argument < 0 ? llast(arguments)
												: list_nth(arguments, argument)));
	if (!IsA(count, Const))
		PG_RETURN_POINTER(NULL);
	request->rows = ((Const *) count)->constisnull ? 0
		: Max(1, DatumGetInt32(((Const *) count)->constvalue));
	PG_RETURN_POINTER(request);
}

/* abacus_raster_rows(internal) -> internal, for abacus_raster: its height */
Datum
abacus_sql_raster_rows(PG_FUNCTION_ARGS)
{
	return estimate_by_argument(fcinfo, 4);
}

/* abacus_nearest_rows(internal) -> internal, for abacus_nearest: k, its last argument */
Datum
abacus_sql_nearest_rows(PG_FUNCTION_ARGS)
{
	return estimate_by_argument(fcinfo, -1);
}
