/*
 * conditions.h: the conditions of a query that show which pages of a mesh are needed.
 */
#ifndef ABACUS_CONDITIONS_H
#define ABACUS_CONDITIONS_H

#include "nodes/pathnodes.h"

#include "abacus/windows.h"
#include "pg/fdw/published.h"

typedef enum ConditionKind
{
	CONDITION_LEAST,			/* the column is not less than the value */
	CONDITION_GREATEST,
	CONDITION_EQUAL,
	CONDITION_BOX,				/* its box meets the value's box, rounded as in PostGIS */
	CONDITION_TOUCH,			/* it meets the value itself */
	CONDITION_NEAR				/* it is no further from the value than a distance */
} ConditionKind;

/* A condition on a column. */
typedef struct Condition
{
	ConditionKind kind;
	Column		column;
	Expr	   *value;			/* does not depend on the row */
	Expr	   *distance;		/* of CONDITION_NEAR, otherwise NULL */
} Condition;

/* A published mesh in a query. */
typedef struct Shown
{
	PlannerInfo *root;
	Index		relation;
	const Published *published;
} Shown;

/* No SRID that geometries must have is known. */
#define SRID_UNKNOWN (-1)

/* The limits of a scan. */
typedef struct Bounds
{
	bool		nothing;		/* no row can meet the conditions */
	abacus_window window;
	bool		has_range;		/* of an attribute; of points only */
	abacus_range range;			/* the attribute by its permanent number */
	bool		has_codes;		/* of cells: a stretch of the curve instead of the window */
	uint64		least_code;
	uint64		greatest_code;
} Bounds;

/* The value of a condition, or its distance; false if unknown, as while planning. */
typedef bool (*ConditionValue) (void *context, int condition, bool distance, Datum *value,
								bool *isnull);

extern Column condition_column(const Shown *shown, Node *expression);
extern bool condition_of_clause(const Shown *shown, Expr *clause, Condition *condition);
extern List *conditions_of_clauses(const Shown *shown, List *clauses);
extern List *conditions_pack(List *conditions, List **expressions);
extern List *conditions_unpack(List *packed, List *expressions);
extern void conditions_bounds(List *conditions, Content content, uint32 dimension, int32 srid,
							  ConditionValue value, void *context, Bounds *bounds);

#endif
