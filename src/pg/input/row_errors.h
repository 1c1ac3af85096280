/*
 * row_errors.h: names of the columns of source rows, and errors about them.
 */
#ifndef ABACUS_ROW_ERRORS_H
#define ABACUS_ROW_ERRORS_H

#include "access/tupdesc.h"

#include "pg/input/row_packer.h"

/* The column of a row that holds the geometry instead of coordinates. */
#define GEOMETRY_COLUMN 1

static inline bool
row_has_geometry(const RowPacker *packer)
{
	return OidIsValid(packer->geometry.type);
}

extern int	row_word(const RowPacker *packer, int column);
extern void row_refuse_type(const RowPacker *packer, int column, TupleDesc desc);
extern void row_tell_z(const RowPacker *packer, TupleDesc desc);
extern void row_tell_order(const RowPacker *packer, TupleDesc desc);
extern void row_refuse_count(const RowPacker *packer, TupleDesc desc);
extern void row_refuse_value(const RowPacker *packer, const uint64 *point, int column, bool isnull);
extern void row_refuse_srid(const RowPacker *packer, const char *what, int32 srid);

#endif
