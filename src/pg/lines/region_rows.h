/*
 * region_rows.h: the rows of a query that gives regions, read as rows with a name (named_rows.h).
 */
#ifndef ABACUS_REGION_ROWS_H
#define ABACUS_REGION_ROWS_H

#include "pg/input/source.h"
#include "pg/lines/named_rows.h"

/* The columns of the rows: line is NULL for seeds, x and y for outlines. */
#define REGION_ROWS "abacus_regions_given"

extern NamedRows *region_rows_read(Source *source);

#endif
