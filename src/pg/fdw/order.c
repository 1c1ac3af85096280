/*
 * order.c: an order of rows by their distance from a place: geom <-> place of PostGIS, or
 * PostgreSQL's own point(x, y) <-> place.
 */
#include "postgres.h"

#include <math.h>

#include "catalog/pg_type.h"
#include "nodes/nodeFuncs.h"
#include "optimizer/paths.h"
#include "utils/fmgroids.h"
#include "utils/geo_decls.h"
#include "utils/lsyscache.h"

#include "pg/fdw/order.h"
#include "pg/port/port.h"
#include "pg/postgis/geometry_box.h"

#define POSTGIS_DISTANCE "geometry_distance_centroid"

/* Whether an expression is this column. */
static bool
is_column(const Shown *shown, Node *expression, Holds holds, int number)
{
	Column		column = condition_column(shown, expression);

	return column.holds == holds && (holds == HOLDS_GEOMETRY || column.number == number);
}

/* Whether an expression is the place of the row itself. */
static bool
is_own_place(const Shown *shown, Node *expression)
{
	FuncExpr   *point = (FuncExpr *) expression;

	if (is_column(shown, expression, HOLDS_GEOMETRY, 0))
		return true;
	return IsA(expression, FuncExpr) && point->funcid == F_POINT_FLOAT8_FLOAT8 &&
		is_column(shown, linitial(point->args), HOLDS_COORDINATE, 0) &&
		is_column(shown, lsecond(point->args), HOLDS_COORDINATE, 1);
}

/* Whether an expression is a constant place. */
static bool
is_place(Node *expression)
{
	const Const *constant = (Const *) expression;
	double		place[2];

	return IsA(expression, Const) && !constant->constisnull &&
		order_read_place(constant->consttype, constant->constvalue, place);
}

/* The place whose distance an expression is; NULL if it is not a distance. */
static Expr *
place_of_distance(const Shown *shown, Node *expression)
{
	OpExpr	   *operator = (OpExpr *) expression;
	Oid			function;
	Node	   *left;
	Node	   *right;

	if (!IsA(expression, OpExpr) || list_length(operator->args) != 2)
		return NULL;
	function = get_opcode(operator->opno);
	if (function != F_POINT_DISTANCE && !(postgis_owns_function(function) &&
										  strcmp(get_func_name(function), POSTGIS_DISTANCE) == 0))
		return NULL;
	left = linitial(operator->args);
	right = lsecond(operator->args);
	if (is_own_place(shown, left) && is_place(right))
		return (Expr *) right;
	return is_own_place(shown, right) && is_place(left) ? (Expr *) left : NULL;
}

/* The place, if a query wants the rows nearest to it first, or NULL. */
Expr *
order_place(const Shown *shown, RelOptInfo *rel)
{
	PathKey    *key;
	ListCell   *cell;

	if (shown->root->query_pathkeys == NIL || shown->published->content != CONTENT_POINTS)
		return NULL;
	key = linitial(shown->root->query_pathkeys);
	if (!port_pathkey_ascends(key) || key->pk_nulls_first || key->pk_eclass->ec_has_volatile)
		return NULL;
	foreach(cell, key->pk_eclass->ec_members)
	{
		EquivalenceMember *member = lfirst(cell);
		Expr	   *place = bms_equal(member->em_relids, rel->relids)
			? place_of_distance(shown, (Node *) member->em_expr) : NULL;

		if (place != NULL)
			return place;
	}
	return NULL;
}

/* Reads a place of PostGIS or of PostgreSQL; false if it is not a finite point of the plane. */
bool
order_read_place(Oid type, Datum value, double *place)
{
	double		upper[2];
	int32		srid;

	if (type == POINTOID)
	{
		place[0] = DatumGetPointP(value)->x;
		place[1] = DatumGetPointP(value)->y;
	}
	else if (!geometry_is_type(type) ||
			 geometry_box(geometry_type(type), value, place, upper, &srid) != GEOMETRY_IN_BOX ||
			 place[0] != upper[0] || place[1] != upper[1])
		return false;
	return isfinite(place[0]) && isfinite(place[1]);
}
