/*
 * changed_row.h: rows of simplices that a change has created or removed.
 */
#ifndef ABACUS_CHANGED_ROW_H
#define ABACUS_CHANGED_ROW_H

#include "pg/sql/rows/simplex_row.h"

/* Columns: those of abacus_simplex between two others */
enum
{
	CHANGED_CREATED,
	CHANGED_SIMPLEX,
	CHANGED_CORNERS = CHANGED_SIMPLEX + SIMPLEX_COLUMNS,
	CHANGED_COLUMNS
};

extern void changed_columns(const abacus_simplex *simplex, uint32 dimension, bool created, Datum *values,
							bool *isnull);

#endif
