/*
 * octant_row.h: rows of octants.
 */
#ifndef ABACUS_OCTANT_ROW_H
#define ABACUS_OCTANT_ROW_H

#include "access/tupdesc.h"
#include "fmgr.h"

#include "abacus/octree.h"

/* Columns of the composite type abacus_octant */
enum
{
	OCTANT_CODE,
	OCTANT_LEVEL,
	OCTANT_LOWER,
	OCTANT_UPPER,
	OCTANT_ATTRIBUTES,
	OCTANT_COLUMNS
};

extern TupleDesc octant_row_type(FunctionCallInfo fcinfo);
extern void octant_columns(const abacus_octant *octant, const abacus_facts *facts, Datum *values);
extern Datum octant_row(TupleDesc row_type, const abacus_octant *octant,
						const abacus_facts *facts);

#endif
