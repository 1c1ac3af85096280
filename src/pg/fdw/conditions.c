/*
 * conditions.c: the conditions of a query that show which pages of a mesh are needed.
 *
 * On points: comparisons of a coordinate or an attribute with a value. On cells: comparisons of the
 * code. On all geometries: the operators and functions of PostGIS that are true only if the
 * geometries, or their boxes, meet. The value may be a constant, a parameter or anything else that
 * does not depend on the row.
 *
 * The pages contain all rows that meet these conditions, and others. So PostgreSQL checks each row
 * again, with every condition.
 */
#include "postgres.h"

#include "access/stratnum.h"
#include "catalog/pg_type.h"
#include "nodes/nodeFuncs.h"
#include "optimizer/clauses.h"
#include "optimizer/optimizer.h"
#include "utils/lsyscache.h"
#include "utils/typcache.h"

#include "pg/fdw/conditions.h"
#include "pg/port/port.h"
#include "pg/postgis/catalogue.h"

/*
 * What must hold for a PostGIS function, or one behind an operator, to be true; false if that is
 * unknown.
 */
static bool
kind_of_postgis(const char *name, ConditionKind *kind)
{
	static const struct
	{
		const char *name;
		ConditionKind kind;
	}			functions[] = {
		{"geometry_overlaps", CONDITION_BOX},	/* && */
		{"geometry_within", CONDITION_BOX}, /* @ */
		{"geometry_contains", CONDITION_BOX},	/* ~ */
		{"geometry_same", CONDITION_BOX},	/* ~= */
		{"geometry_overlaps_nd", CONDITION_BOX},	/* &&& */
		{"st_intersects", CONDITION_TOUCH},
		{"st_within", CONDITION_TOUCH},
		{"st_contains", CONDITION_TOUCH},
		{"st_containsproperly", CONDITION_TOUCH},
		{"st_coveredby", CONDITION_TOUCH},
		{"st_covers", CONDITION_TOUCH},
		{"st_crosses", CONDITION_TOUCH},
		{"st_overlaps", CONDITION_TOUCH},
		{"st_touches", CONDITION_TOUCH},
		{"st_equals", CONDITION_TOUCH},
		{"st_dwithin", CONDITION_NEAR},
	};

	for (int i = 0; i < lengthof(functions); i++)
		if (strcmp(name, functions[i].name) == 0)
		{
			*kind = functions[i].kind;
			return true;
		}
	return false;
}

/* The table column that an expression refers to; it holds nothing if it is not a column. */
Column
condition_column(const Shown *shown, Node *expression)
{
	const Column none = {HOLDS_NOTHING, 0};
	const Var  *var;

	while (IsA(expression, RelabelType))
		expression = (Node *) ((RelabelType *) expression)->arg;
	var = (Var *) expression;
	if (!IsA(expression, Var) || var->varno != shown->relation || var->varlevelsup != 0 ||
		var->varattno < 1 || var->varattno > shown->published->count)
		return none;
	return shown->published->columns[var->varattno - 1];
}

/* Whether an expression has one value for all rows of a scan. */
static bool
is_fixed(const Shown *shown, Node *expression)
{
	return !bms_is_member(shown->relation, pull_varnos(shown->root, expression)) &&
		!contain_volatile_functions(expression) && !contain_subplans(expression);
}

/*
 * A comparison of a column of this type with a number: the condition on the column, its left side.
 */
static bool
kind_of_comparison(Oid operator, Oid type, ConditionKind *kind)
{
	Oid			family = lookup_type_cache(type, TYPECACHE_BTREE_OPFAMILY)->btree_opf;
	int			strategy;
	Oid			left;
	Oid			right;

	if (!op_in_opfamily(operator, family))
		return false;
	get_op_opfamily_properties(operator, family, false, &strategy, &left, &right);
	if (left != type || (type == FLOAT8OID && right != FLOAT8OID))
		return false;
	*kind = strategy == BTEqualStrategyNumber ? CONDITION_EQUAL
		: strategy == BTLessStrategyNumber || strategy == BTLessEqualStrategyNumber
		? CONDITION_GREATEST : CONDITION_LEAST;
	return true;
}

/* A condition that compares a column with a value. */
static bool
set(const Shown *shown, Node *column, Node *value, Node *distance, ConditionKind kind,
	Condition *condition)
{
	condition->column = condition_column(shown, column);
	condition->kind = kind;
	condition->value = (Expr *) value;
	condition->distance = (Expr *) distance;
	return condition->column.holds != HOLDS_NOTHING && is_fixed(shown, value) &&
		(distance == NULL || is_fixed(shown, distance));
}

static bool
of_comparison(const Shown *shown, OpExpr *clause, Condition *condition)
{
	bool		of_points = shown->published->content == CONTENT_POINTS;
	Oid			type = of_points ? FLOAT8OID : INT8OID;
	ConditionKind kind;
	Oid			commuted = get_commutator(clause->opno);

	if (list_length(clause->args) != 2)
		return false;
	if ((kind_of_comparison(clause->opno, type, &kind) &&
		 set(shown, linitial(clause->args), lsecond(clause->args), NULL, kind, condition)) ||
		(OidIsValid(commuted) && kind_of_comparison(commuted, type, &kind) &&
		 set(shown, lsecond(clause->args), linitial(clause->args), NULL, kind, condition)))
		return condition->column.holds == HOLDS_CODE || (of_points &&
														 (condition->column.holds == HOLDS_COORDINATE ||
														  condition->column.holds == HOLDS_ATTRIBUTE));
	return false;
}

/* Geometries meet in either order. */
static bool
of_geometries(const Shown *shown, Oid function, List *arguments, Condition *condition)
{
	ConditionKind kind;
	Node	   *distance = NULL;
	Oid			geometry = postgis_geometry();
	const char *name = get_func_name(function);

	if (name == NULL || !kind_of_postgis(name, &kind) || !postgis_owns_function(function) ||
		list_length(arguments) != (kind == CONDITION_NEAR ? 3 : 2) ||
		exprType(linitial(arguments)) != geometry || exprType(lsecond(arguments)) != geometry)
		return false;
	if (kind == CONDITION_NEAR)
		distance = lthird(arguments);
	return (set(shown, linitial(arguments), lsecond(arguments), distance, kind, condition) ||
			set(shown, lsecond(arguments), linitial(arguments), distance, kind, condition)) &&
		condition->column.holds == HOLDS_GEOMETRY;
}

/* Whether a clause is a condition that shows which pages are needed. */
bool
condition_of_clause(const Shown *shown, Expr *clause, Condition *condition)
{
	if (IsA(clause, OpExpr))
	{
		OpExpr	   *operator = (OpExpr *) clause;

		return of_comparison(shown, operator, condition) ||
			of_geometries(shown, get_opcode(operator->opno), operator->args, condition);
	}
	if (IsA(clause, FuncExpr))
		return of_geometries(shown, ((FuncExpr *) clause)->funcid, ((FuncExpr *) clause)->args,
							 condition);
	return false;
}

/* The conditions among the planner's clauses. */
List *
conditions_of_clauses(const Shown *shown, List *clauses)
{
	List	   *conditions = NIL;
	ListCell   *cell;

	foreach(cell, clauses)
	{
		Condition  *condition = palloc0(sizeof(Condition));

		if (condition_of_clause(shown, lfirst_node(RestrictInfo, cell)->clause, condition))
			conditions = lappend(conditions, condition);
	}
	return conditions;
}

/* Conditions as a plan stores them: numbers, and the expressions in order. */
List *
conditions_pack(List *conditions, List **expressions)
{
	List	   *packed = NIL;
	ListCell   *cell;

	*expressions = NIL;
	foreach(cell, conditions)
	{
		Condition  *condition = lfirst(cell);

		packed = lappend(packed, list_make3_int(condition->kind, condition->column.holds,
												condition->column.number));
		*expressions = lappend(*expressions, condition->value);
		if (condition->distance != NULL)
			*expressions = lappend(*expressions, condition->distance);
	}
	return packed;
}

List *
conditions_unpack(List *packed, List *expressions)
{
	List	   *conditions = NIL;
	ListCell   *cell;
	int			at = 0;

	foreach(cell, packed)
	{
		List	   *numbers = lfirst(cell);
		Condition  *condition = palloc0(sizeof(Condition));

		condition->kind = linitial_int(numbers);
		condition->column.holds = lsecond_int(numbers);
		condition->column.number = lthird_int(numbers);
		condition->value = list_nth(expressions, at++);
		if (condition->kind == CONDITION_NEAR)
			condition->distance = list_nth(expressions, at++);
		conditions = lappend(conditions, condition);
	}
	return conditions;
}
