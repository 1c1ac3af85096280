/*
 * goose_row.c: a simplex with its box as a row, and back.
 *
 * A ghost is a row without its last corner, whose columns are NULL. Rows that are read are not
 * trusted: anyone may have written anything there meanwhile.
 */
#include "postgres.h"

#include <math.h>

#include "catalog/pg_type.h"

#include "pg/base/extension_type.h"
#include "pg/base/location.h"
#include "pg/goose/goose_row.h"
#include "pg/port/port.h"

/* The type of boxes: PostgreSQL's own in the plane, that of an extension in space. */
Oid
goose_box_type(int dimension)
{
	Oid			type = dimension == 2 ? BOXOID : extension_type("cube", "cube");

	if (!OidIsValid(type))
		ereport(ERROR,
				(errcode(ERRCODE_UNDEFINED_OBJECT),
				 errmsg("type \"cube\" does not exist"),
				 errdetail("In three dimensions abacus_goose() finds simplices by boxes of this type."),
				 errhint("Install it with CREATE EXTENSION cube.")));
	return type;
}

/* A box as a Datum, in memory of the caller. */
Datum
goose_box(int dimension, const double *lower, const double *upper, GooseBox *room)
{
	NDBOX	   *cube = (NDBOX *) room->cube;

	if (dimension == 2)
	{
		room->box.low.x = lower[0];
		room->box.low.y = lower[1];
		room->box.high.x = upper[0];
		room->box.high.y = upper[1];
		return BoxPGetDatum(&room->box);
	}
	SET_VARSIZE(cube, CUBE_SIZE(dimension));
	cube->header = 0;
	SET_DIM(cube, dimension);
	memcpy(cube->x, lower, dimension * sizeof(double));
	memcpy(cube->x + dimension, upper, dimension * sizeof(double));
	return PointerGetDatum(cube);
}

static bool
read_box(int dimension, Datum datum, double *lower, double *upper)
{
	if (dimension == 2)
	{
		const BOX  *box = DatumGetBoxP(datum);

		lower[0] = box->low.x;
		lower[1] = box->low.y;
		upper[0] = box->high.x;
		upper[1] = box->high.y;
	}
	else
	{
		const NDBOX *cube = DatumGetNDBOXP(datum);

		if (DIM(cube) != dimension)
			return false;
		for (int k = 0; k < dimension; k++)
		{
			lower[k] = LL_COORD(cube, k);
			upper[k] = UR_COORD(cube, k);
		}
		if ((Pointer) cube != DatumGetPointer(datum))
			pfree(unconstify(NDBOX *, cube));
	}
	return true;
}

/* The columns of a row; its box is in memory of the caller. */
void
goose_row_encode(int dimension, const abacus_boxed_simplex *row, Datum *values, bool *isnull,
				 GooseBox *room)
{
	int			box = GOOSE_BOX_COLUMN(dimension);
	int			corners = GOOSE_CORNERS(dimension) - row->simplex.ghost;

	memset(values, 0, (box + 1) * sizeof(Datum));
	memset(isnull, true, (box + 1) * sizeof(bool));
	for (int i = 0; i < corners; i++)
	{
		values[i] = Int64GetDatum(row->simplex.id[i]);
		isnull[i] = false;
		for (int k = 0; k < dimension; k++)
		{
			int			column = GOOSE_FIRST_COORDINATE(dimension) + i * dimension + k;

			values[column] = Float8GetDatum(row->simplex.corner[i][k]);
			isnull[column] = false;
		}
	}
	values[box] = goose_box(dimension, row->lower, row->upper, room);
	isnull[box] = false;
}

/* Decodes a row; false if goose_row_encode() cannot have made it. */
bool
goose_row_decode(int dimension, TupleTableSlot *slot, abacus_boxed_simplex *row)
{
	int			box = GOOSE_BOX_COLUMN(dimension);
	int			corners;

	slot_getallattrs(slot);
	MemSet(row, 0, sizeof(*row));
	row->simplex.ghost = slot->tts_isnull[dimension];
	corners = GOOSE_CORNERS(dimension) - row->simplex.ghost;
	for (int i = 0; i < corners; i++)
	{
		if (slot->tts_isnull[i])
			return false;
		row->simplex.id[i] = DatumGetInt64(slot->tts_values[i]);
		for (int k = 0; k < dimension; k++)
		{
			int			column = GOOSE_FIRST_COORDINATE(dimension) + i * dimension + k;

			if (slot->tts_isnull[column])
				return false;
			row->simplex.corner[i][k] = DatumGetFloat8(slot->tts_values[column]);
			if (!isfinite(row->simplex.corner[i][k]))
				return false;
		}
	}
	row->location = pack_location(&slot->tts_tid);
	return !slot->tts_isnull[box] &&
		read_box(dimension, slot->tts_values[box], row->lower, row->upper);
}
