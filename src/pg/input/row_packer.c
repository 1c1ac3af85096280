/*
 * row_packer.c: rows from the executor into the core's records of points, or
 * of simplices.
 *
 * A DestReceiver that deforms each slot in place. It packs id, coordinates and attributes, or the
 * ids of a simplex's vertices, into eight-byte words. Columns go by position, as in every function
 * that takes a source query. This is the hot path of staging: it takes a few tens of nanoseconds a
 * row, besides the scan itself.
 */
#include "postgres.h"

#include <math.h>

#include "access/htup_details.h"
#include "catalog/pg_type.h"
#include "executor/tuptable.h"
#include "lib/stringinfo.h"
#include "utils/builtins.h"
#include "utils/lsyscache.h"
#include "utils/memutils.h"
#include "utils/syscache.h"

#include "pg/input/row_packer.h"

static const char *const coordinate_names[ABACUS_MAX_DIMENSION] = {"x", "y", "z"};
static const char *const corner_names[ABACUS_MAX_DIMENSION + 1] = {"v0", "v1", "v2", "v3"};

static const RowOrigin query_of_points = {
	"the source query", "the source query", "Cast the column in the query.",
	"Give its coordinates", "Leave such points out with a WHERE clause.", true,
	"mesh", "id", "An id", NULL, false
};
static const RowOrigin query_of_simplices = {
	"the source query", "the source query", "Cast the column in the query.",
	NULL, "Leave such simplices out with a WHERE clause.", false,
	"mesh", "id", "An id", NULL, false
};
static const RowOrigin tracked_table = {
	"the tracked table", "the statement", "Track other columns, generated ones for instance.",
	"Track generated columns", "A row without a point has NULL for a coordinate.", false,
	"mesh", "id", "An id", NULL, false
};
#define QUERY_OF_OCTANTS "the source query", "the source query", "Cast the column in the query.", \
	"Give its coordinates", "Leave such rows out with a WHERE clause.", true, "octree"
static const RowOrigin queries_of_octants[] = {
	[OCTANT_LEAVES] = {QUERY_OF_OCTANTS, "code", "A code", "level", true},
	[OCTANT_VALUES] = {QUERY_OF_OCTANTS, "code", "A code", NULL, true},
	[OCTANT_PLACES] = {QUERY_OF_OCTANTS, "level", "A level", NULL, true},
	[OCTANT_POINTS] = {QUERY_OF_OCTANTS, "id", "An id", NULL, false}
};

/* What a column is called in messages, and in tables by default. */
const char *
row_packer_column(const abacus_header *header, int column)
{
	if (column == 0)
		return "id";
	if (column <= (int) header->dimension)
		return coordinate_names[column - 1];
	return header->names[column - 1 - header->dimension];
}

static const char *
column_name(const RowPacker *packer, int column)
{
	if (packer->ids > 1)
		return corner_names[column];
	if (column == 0)
		return packer->origin->id;
	if (column == 1 && packer->origin->level != NULL)
		return packer->origin->level;
	return row_packer_column(packer->header, column);
}

/* "id, x, y, height" */
static char *
expected_columns(const RowPacker *packer)
{
	StringInfoData names;

	initStringInfo(&names);
	for (int i = 0; i < packer->columns; i++)
		appendStringInfo(&names, "%s%s", i > 0 ? ", " : "", column_name(packer, i));
	return names.data;
}

/* A geometry has its coordinates in one value; where they are to be found, or NULL. */
static char *
geometry_hint(const RowPacker *packer, const char *column, Oid type)
{
	HeapTuple	tuple = SearchSysCache1(TYPEOID, ObjectIdGetDatum(type));
	bool		is_geometry = false;

	if (HeapTupleIsValid(tuple))
	{
		const char *name = NameStr(((Form_pg_type) GETSTRUCT(tuple))->typname);

		is_geometry = strcmp(name, "geometry") == 0 || strcmp(name, "geography") == 0;
		ReleaseSysCache(tuple);
	}
	if (!is_geometry || packer->origin->geometry_hint == NULL)
		return NULL;
	return psprintf(packer->header->dimension == 2
					? "%2$s, ST_X(%1$s) and ST_Y(%1$s), or use the functions of the extension "
					"abacus_postgis."
					: "%2$s, ST_X(%1$s), ST_Y(%1$s) and ST_Z(%1$s), or use the functions of the "
					"extension abacus_postgis.",
					quote_identifier(column), packer->origin->geometry_hint);
}

static void
refuse_type(const RowPacker *packer, int column, Form_pg_attribute attribute)
{
	bool		is_id = column < packer->ids;
	char	   *hint = geometry_hint(packer, NameStr(attribute->attname), attribute->atttypid);

	ereport(ERROR,
			(errcode(ERRCODE_DATATYPE_MISMATCH),
			 errmsg("column %d (%s) of %s has type %s", column + 1, column_name(packer, column),
					packer->origin->columns_of, format_type_be(attribute->atttypid)),
			 is_id ? errdetail("%s is smallint, integer or bigint.", packer->origin->an_id)
			 : errdetail("Coordinates and attributes are double precision, real, numeric or integers."),
			 errhint("%s", hint != NULL ? hint : packer->origin->type_hint)));
}

static void
refuse_count(const RowPacker *packer, TupleDesc desc)
{
	char	   *hint = NULL;

	for (int i = 0; hint == NULL && i < desc->natts; i++)
		hint = geometry_hint(packer, NameStr(TupleDescAttr(desc, i)->attname),
							 TupleDescAttr(desc, i)->atttypid);
	ereport(ERROR,
			(errcode(ERRCODE_DATATYPE_MISMATCH),
			 errmsg("source query returns %d columns, but the %s takes %d", desc->natts,
					packer->origin->whole, packer->columns),
			 errdetail("Columns go by position: %s.", expected_columns(packer)),
			 hint != NULL ? errhint("%s", hint) : 0));
}

static PackKind
pack_kind(const RowPacker *packer, int column, Form_pg_attribute attribute)
{
	bool		is_id = column < packer->ids;

	switch (getBaseType(attribute->atttypid))
	{
		case INT2OID:
			return PACK_INT2;
		case INT4OID:
			return PACK_INT4;
		case INT8OID:
			return PACK_INT8;
		case FLOAT4OID:
			if (!is_id)
				return PACK_FLOAT4;
			break;
		case FLOAT8OID:
			if (!is_id)
				return PACK_FLOAT8;
			break;
		case NUMERICOID:
			if (!is_id)
				return PACK_NUMERIC;
			break;
		case TEXTOID:
			/* a bare NULL of a query is of this type */
			if (packer->origin->bare_nulls && column > (int) packer->header->dimension)
				return PACK_NULL;
			break;
	}
	refuse_type(packer, column, attribute);
	return PACK_INT8;			/* not reached */
}

/* A NULL, and what is not a number, has no place; the error says which point it was. */
static void
refuse_value(const RowPacker *packer, const uint64 *point, int column, bool isnull)
{
	const char *name = column_name(packer, column);
	const char *hint = packer->origin->value_hint;

	if (packer->origin->by_number || (isnull && column < packer->ids))
		ereport(ERROR,
				(errcode(isnull ? ERRCODE_NULL_VALUE_NOT_ALLOWED : ERRCODE_INVALID_PARAMETER_VALUE),
				 errmsg("%s is %s in row " UINT64_FORMAT " of %s", name,
						isnull ? "NULL" : "not finite", packer->row, packer->origin->rows_of),
				 errhint("%s", hint)));
	ereport(ERROR,
			(errcode(isnull ? ERRCODE_NULL_VALUE_NOT_ALLOWED : ERRCODE_INVALID_PARAMETER_VALUE),
			 errmsg("%s of point " INT64_FORMAT " is %s", name, (int64) point[0],
					isnull ? "NULL" : "not finite"),
			 errhint("%s", hint)));
}

static double
to_double(PackKind kind, Datum value)
{
	switch (kind)
	{
		case PACK_FLOAT8:
			return DatumGetFloat8(value);
		case PACK_FLOAT4:
			return DatumGetFloat4(value);
		case PACK_INT2:
			return DatumGetInt16(value);
		case PACK_INT4:
			return DatumGetInt32(value);
		case PACK_INT8:
			return (double) DatumGetInt64(value);
		case PACK_NUMERIC:
			return DatumGetFloat8(DirectFunctionCall1(numeric_float8_no_overflow, value));
		case PACK_NULL:
			break;
	}
	pg_unreachable();
}

static int64
to_id(PackKind kind, Datum value)
{
	return kind == PACK_INT8 ? DatumGetInt64(value)
		: kind == PACK_INT4 ? DatumGetInt32(value) : DatumGetInt16(value);
}

static inline uint64
bits(double value)
{
	uint64		word;

	memcpy(&word, &value, sizeof(word));
	return word;
}

/* A column of a type that cannot be read may only hold NULLs. */
static void
check_nulls(const RowPacker *packer, const TupleTableSlot *slot)
{
	for (int i = 0; i < packer->columns; i++)
		if (packer->kinds[i] == PACK_NULL && !slot->tts_isnull[i])
			refuse_type(packer, i, TupleDescAttr(slot->tts_tupleDescriptor, i));
}

static bool
receive_row(TupleTableSlot *slot, DestReceiver *self)
{
	RowPacker  *packer = (RowPacker *) self;
	uint64	   *point = packer->points + packer->count * packer->columns;
	int			coordinates_end = 1 + packer->header->dimension;
	MemoryContext old = NULL;

	packer->row++;
	slot_getsomeattrs(slot, packer->columns);
	if (unlikely(packer->any_null))
		check_nulls(packer, slot);
	if (unlikely(packer->any_numeric))
		old = MemoryContextSwitchTo(packer->scratch);

	for (int i = 0; i < packer->ids; i++)
	{
		if (unlikely(slot->tts_isnull[i]))
			refuse_value(packer, point, i, true);
		point[i] = (uint64) to_id(packer->kinds[i], slot->tts_values[i]);
	}
	for (int i = packer->ids; i < packer->columns; i++)
	{
		bool		isnull = slot->tts_isnull[i];
		double		value = isnull ? NAN : to_double(packer->kinds[i], slot->tts_values[i]);

		if (unlikely(i < coordinates_end && !isfinite(value)))
			refuse_value(packer, point, i, isnull);
		point[i] = bits(value);
	}
	packer->count++;
	if (unlikely(old != NULL))
		MemoryContextSwitchTo(old);
	return true;
}

static void
start_up(DestReceiver *self, int operation, TupleDesc desc)
{
}

static void
shut_down(DestReceiver *self)
{
}

/* A packer for the first columns; `more`: others may follow them. */
static RowPacker *
create(TupleDesc desc, const abacus_header *header, const RowOrigin *origin, int ids, int columns,
	   bool more, size_t batch)
{
	RowPacker  *packer = palloc0(sizeof(RowPacker));

	packer->origin = origin;
	packer->header = header;
	packer->ids = ids;
	packer->columns = columns;
	if (desc->natts != columns && !(more && desc->natts > columns))
		refuse_count(packer, desc);
	packer->receiver.receiveSlot = receive_row;
	packer->receiver.rStartup = start_up;
	packer->receiver.rShutdown = shut_down;
	packer->receiver.rDestroy = shut_down;
	packer->receiver.mydest = DestNone;
	packer->kinds = palloc(columns * sizeof(PackKind));
	for (int i = 0; i < columns; i++)
	{
		packer->kinds[i] = pack_kind(packer, i, TupleDescAttr(desc, i));
		packer->any_numeric |= packer->kinds[i] == PACK_NUMERIC;
		packer->any_null |= packer->kinds[i] == PACK_NULL;
	}
	packer->points = palloc(batch * columns * sizeof(uint64));
	packer->scratch = AllocSetContextCreate(CurrentMemoryContext, "Abacus row conversion",
											ALLOCSET_DEFAULT_SIZES);
	return packer;
}

/* A packer for rows of a query that are points of the mesh, in the current memory context. */
RowPacker *
row_packer_create(TupleDesc desc, const abacus_header *header, size_t batch)
{
	return create(desc, header, &query_of_points, 1, 1 + header->dimension + header->attributes,
				  false, batch);
}

/* The same for rows of a query that are places: id and coordinates, whatever else the rows have. */
RowPacker *
row_packer_create_places(TupleDesc desc, const abacus_header *header, size_t batch)
{
	return create(desc, header, &query_of_points, 1, 1 + header->dimension, true, batch);
}

/* The same for rows of a table that the mesh follows. */
RowPacker *
row_packer_create_tracked(TupleDesc desc, const abacus_header *header, size_t batch)
{
	return create(desc, header, &tracked_table, 1, 1 + header->dimension + header->attributes,
				  false, batch);
}

/* The same for rows of a query that are simplices: ids of their vertices. */
RowPacker *
row_packer_create_simplices(TupleDesc desc, const abacus_header *header, size_t batch)
{
	return create(desc, header, &query_of_simplices, header->dimension + 1, header->dimension + 1,
				  false, batch);
}

/*
 * The same for rows of a query that are for an octree. Of leaves and values `header` says nothing
 * but what attributes there are.
 */
RowPacker *
row_packer_create_octants(TupleDesc desc, const abacus_header *header, OctantRows rows, size_t batch)
{
	bool		has_attributes = rows == OCTANT_LEAVES || rows == OCTANT_VALUES;

	return create(desc, header, &queries_of_octants[rows], 1,
				  1 + header->dimension + (has_attributes ? header->attributes : 0),
				  rows == OCTANT_POINTS, batch);
}

void
row_packer_reset(RowPacker *packer)
{
	packer->count = 0;
	if (packer->any_numeric)
		MemoryContextReset(packer->scratch);
}
