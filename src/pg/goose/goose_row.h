/*
 * goose_row.h: a simplex with its box as a row: ids of its corners, their
 * coordinates, the box.
 */
#ifndef ABACUS_GOOSE_ROW_H
#define ABACUS_GOOSE_ROW_H

#include "abacus/goose.h"

#include "executor/tuptable.h"
#include "extension/cube/cubedata.h"
#include "utils/geo_decls.h"

/* Columns, from 0. */
#define GOOSE_CORNERS(dimension) ((dimension) + 1)
#define GOOSE_FIRST_COORDINATE(dimension) GOOSE_CORNERS(dimension)
#define GOOSE_BOX_COLUMN(dimension) (GOOSE_CORNERS(dimension) * ((dimension) + 1))
#define GOOSE_MAX_COLUMNS (GOOSE_BOX_COLUMN(ABACUS_MAX_DIMENSION) + 1)

/* Room for a box of either type. */
typedef union GooseBox
{
	BOX			box;
	char		cube[CUBE_SIZE(ABACUS_MAX_DIMENSION)];
	double		alignment;
} GooseBox;

extern Oid	goose_box_type(int dimension);
extern Datum goose_box(int dimension, const double *lower, const double *upper, GooseBox *room);
extern void goose_row_encode(int dimension, const abacus_boxed_simplex *row, Datum *values,
							 bool *isnull, GooseBox *room);
extern bool goose_row_decode(int dimension, TupleTableSlot *slot, abacus_boxed_simplex *row);

#endif
