/*
 * row_packer.c: packs rows from the executor into the core's records of points, or of simplices.
 *
 * A DestReceiver that deforms each slot in place. It packs id, coordinates and attributes, or the
 * ids of a simplex's vertices and its labels, into eight-byte words. Columns go by position, as in
 * every function with a source query. Instead of the coordinates there may be a point of PostGIS.
 * This is the hot path of staging: it takes a few tens of nanoseconds a row, besides the scan
 * itself.
 */
#include "postgres.h"

#include <math.h>

#include "catalog/pg_type.h"
#include "executor/tuptable.h"
#include "utils/builtins.h"
#include "utils/lsyscache.h"
#include "utils/memutils.h"

#include "pg/input/row_errors.h"
#include "pg/postgis/geometry_read.h"

static const RowOrigin query_of_points = {
	"the source query", "the source query", "Cast the column in the query.",
	"Give its coordinates", "Leave such points out with a WHERE clause.", true,
	"mesh", "id", "An id", NULL, false, true, true
};
static const RowOrigin query_of_simplices = {
	"the source query", "the source query", "Cast the column in the query.",
	NULL, "Leave such simplices out with a WHERE clause.", true,
	"mesh", "id", "An id", NULL, false, false, false
};
static const RowOrigin query_of_labels = {
	"the source query", "the source query", "Cast the column in the query.",
	NULL, "Leave such rows out with a WHERE clause.", true,
	"mesh", "code", "A code or an id", NULL, true, false, false
};
static const RowOrigin query_of_lines = {
	"the query of lines", "the query of lines", "Cast the column in the query.",
	NULL, "Leave such rows out with a WHERE clause.", false,
	"mesh", "line", "A line or an id", NULL, true, false, false
};
static const RowOrigin query_of_values = {
	"the source query", "the source query", "Cast the column in the query.",
	NULL, "Leave such rows out with a WHERE clause.", true,
	"step", "id", "An id", NULL, false, false, false
};
static const RowOrigin tracked_table = {
	"the tracked table", "the statement", "Track other columns, generated ones for instance.",
	"Track generated columns", "Set a coordinate to NULL in rows without a point.", false,
	"mesh", "id", "An id", NULL, false, true, false, true
};
#define QUERY_OF_OCTANTS(geometry_hint) \
	"the source query", "the source query", "Cast the column in the query.", \
	geometry_hint, "Leave such rows out with a WHERE clause.", true, "octree"
static const RowOrigin queries_of_octants[] = {
	[OCTANT_LEAVES] = {QUERY_OF_OCTANTS(NULL), "code", "A code", "level", true, false, false},
	[OCTANT_VALUES] = {QUERY_OF_OCTANTS(NULL), "code", "A code", NULL, true, false, false},
	[OCTANT_PLACES] = {QUERY_OF_OCTANTS("Give its coordinates"), "level", "A level", NULL, true,
	false, false},
	[OCTANT_POINTS] = {QUERY_OF_OCTANTS("Give its coordinates"), "id", "An id", NULL, false, true, true}
};

/* Whether rows have a geometry instead of coordinates. */
bool
row_packer_takes_geometry(TupleDesc desc)
{
	return desc->natts > GEOMETRY_COLUMN &&
		geometry_is_type(TupleDescAttr(desc, GEOMETRY_COLUMN)->atttypid);
}

static PackKind
pack_kind(const RowPacker *packer, int column, TupleDesc desc)
{
	Form_pg_attribute attribute = TupleDescAttr(desc, column);
	bool		is_id = column < packer->ids;

	if (row_has_geometry(packer) && column == GEOMETRY_COLUMN)
		return PACK_GEOMETRY;
	if (packer->origin->takes_z && row_has_geometry(packer) && !is_id &&
		attribute->atttypid == packer->geometry.type)
		return PACK_Z;
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
			if (packer->origin->bare_nulls && !is_id &&
				row_word(packer, column) > packer->coordinates)
				return PACK_NULL;
			break;
	}
	row_refuse_type(packer, column, desc);
	return PACK_INT8;			/* not reached */
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
		case PACK_GEOMETRY:
		case PACK_Z:
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

/* A column of an unreadable type may hold only NULLs. */
static void
check_nulls(const RowPacker *packer, const TupleTableSlot *slot)
{
	for (int i = 0; i < packer->inputs; i++)
		if (packer->kinds[i] == PACK_NULL && !slot->tts_isnull[i])
			row_refuse_type(packer, i, slot->tts_tupleDescriptor);
}

/* Packs the coordinates of a row with a geometry; returns its z, NaN if it has none. */
static double
pack_geometry(RowPacker *packer, const TupleTableSlot *slot, uint64 *record)
{
	const char *what = psprintf("geometry of point " INT64_FORMAT, (int64) record[0]);
	uint32		dimension = packer->names.facts->form.dimension;
	GeometryPoint point;

	if (slot->tts_isnull[GEOMETRY_COLUMN])
		row_refuse_value(packer, record, GEOMETRY_COLUMN, true);
	geometry_point(&packer->geometry, slot->tts_values[GEOMETRY_COLUMN], what, &point);
	if (point.is_empty)
		ereport(ERROR,
				(errcode(ERRCODE_INVALID_PARAMETER_VALUE),
				 errmsg("%s is empty", what), errhint("%s", packer->origin->value_hint)));
	if (dimension > 2 && !point.has_z)
		ereport(ERROR,
				(errcode(ERRCODE_INVALID_PARAMETER_VALUE),
				 errmsg("%s has no z, but the %s has dimension %u", what, packer->origin->whole,
						dimension),
				 errhint("Add one with ST_Force3DZ(geometry, z).")));
	if (packer->srid < 0)
		packer->srid = point.srid;
	if (point.srid != packer->srid)
		row_refuse_srid(packer, what, point.srid);
	for (uint32 i = 0; i < dimension; i++)
	{
		if (unlikely(!isfinite(point.at[i])))
			row_refuse_value(packer, record, GEOMETRY_COLUMN, false);
		record[1 + i] = bits(point.at[i]);
	}
	return point.has_z ? point.at[2] : NAN;
}

static bool
receive_row(TupleTableSlot *slot, DestReceiver *self)
{
	RowPacker  *packer = (RowPacker *) self;
	uint64	   *point = packer->points + packer->count * packer->columns;
	uint64	   *words = point + (packer->columns - packer->inputs); /* of columns after a geometry */
	int			coordinates_end = 1 + packer->coordinates;
	int			first = packer->ids;
	MemoryContext old = NULL;
	double		z = NAN;

	packer->row++;
	slot_getsomeattrs(slot, packer->inputs);
	if (unlikely(packer->any_null))
		check_nulls(packer, slot);
	if (unlikely(packer->converts))
		old = MemoryContextSwitchTo(packer->scratch);

	for (int i = 0; i < packer->ids; i++)
	{
		if (unlikely(slot->tts_isnull[i]))
			row_refuse_value(packer, point, i, true);
		point[i] = (uint64) to_id(packer->kinds[i], slot->tts_values[i]);
	}
	if (row_has_geometry(packer))
	{
		z = pack_geometry(packer, slot, point);
		first = GEOMETRY_COLUMN + 1;
		coordinates_end = first;
	}
	for (int i = first; i < packer->inputs; i++)
	{
		bool		isnull = slot->tts_isnull[i];
		double		value = packer->kinds[i] == PACK_Z ? z : isnull ? NAN
			: to_double(packer->kinds[i], slot->tts_values[i]);

		if (unlikely(i < coordinates_end && !isfinite(value)))
			row_refuse_value(packer, point, i, isnull);
		words[i] = bits(value);
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

/*
 * A packer for records of this many columns: ids, coordinates, then attributes. `more`: rows may
 * have further columns; `takes_srid`: a mesh without SRID takes the geometries' SRID.
 */
static RowPacker *
create(TupleDesc desc, abacus_names names, const RowOrigin *origin, int ids,
	   int coordinates, int attributes, bool more, bool takes_srid, size_t batch)
{
	int			columns = ids + coordinates + attributes;
	RowPacker  *packer = palloc0(sizeof(RowPacker));

	packer->origin = origin;
	packer->names = names;
	packer->ids = ids;
	packer->coordinates = coordinates;
	packer->columns = packer->inputs = columns;
	packer->takes_srid = takes_srid;
	packer->srid = takes_srid && names.facts->form.srid == 0 ? -1 : (int32) names.facts->form.srid;
	if (origin->takes_geometry && row_packer_takes_geometry(desc))
	{
		geometry_open(&packer->geometry, TupleDescAttr(desc, GEOMETRY_COLUMN)->atttypid,
					  CurrentMemoryContext);
		packer->inputs -= coordinates - 1;
		packer->converts = true;
	}
	if (desc->natts != packer->inputs && !(more && desc->natts > packer->inputs))
		row_refuse_count(packer, desc);
	packer->receiver.receiveSlot = receive_row;
	packer->receiver.rStartup = start_up;
	packer->receiver.rShutdown = shut_down;
	packer->receiver.rDestroy = shut_down;
	packer->receiver.mydest = DestNone;
	packer->kinds = palloc(packer->inputs * sizeof(PackKind));
	for (int i = 0; i < packer->inputs; i++)
	{
		packer->kinds[i] = pack_kind(packer, i, desc);
		packer->converts |= packer->kinds[i] == PACK_NUMERIC;
		packer->any_null |= packer->kinds[i] == PACK_NULL;
	}
	if (origin != &tracked_table)
		row_tell_order(packer, desc);
	if (takes_srid && attributes == 0 && !more && origin == &query_of_points)
		row_tell_z(packer, desc);
	packer->points = palloc(batch * columns * sizeof(uint64));
	packer->scratch = AllocSetContextCreate(CurrentMemoryContext, "Abacus row conversion",
											ALLOCSET_DEFAULT_SIZES);
	return packer;
}

/*
 * A packer for rows of a query that are points of the mesh, in the current memory context.
 * `takes_srid`: a mesh without SRID takes the geometries' SRID.
 */
RowPacker *
row_packer_create(TupleDesc desc, abacus_names names, bool takes_srid, size_t batch)
{
	return create(desc, names, &query_of_points, 1, names.facts->form.dimension,
				  names.facts->columns.attributes, false, takes_srid, batch);
}

/* The same for rows of a query that are places: id and coordinates; other columns are ignored. */
RowPacker *
row_packer_create_places(TupleDesc desc, abacus_names names, size_t batch)
{
	return create(desc, names, &query_of_points, 1, names.facts->form.dimension, 0, true, false, batch);
}

/* The same for rows of a table that the mesh follows. */
RowPacker *
row_packer_create_tracked(TupleDesc desc, abacus_names names, size_t batch)
{
	return create(desc, names, &tracked_table, 1, names.facts->form.dimension,
				  names.facts->columns.attributes, false, true, batch);
}

/* The same for rows of a query that are simplices: the ids of their vertices, and their labels. */
RowPacker *
row_packer_create_simplices(TupleDesc desc, abacus_names names, size_t batch)
{
	return create(desc, names, &query_of_simplices, names.facts->form.dimension + 1, 0,
				  names.facts->columns.labels, false, false, batch);
}

/* The same for rows of a query that label simplices, with a code before the ids. */
RowPacker *
row_packer_create_labels(TupleDesc desc, abacus_names names, size_t batch)
{
	return create(desc, names, &query_of_labels, names.facts->form.dimension + 2, 0,
				  names.facts->columns.labels, false, false, batch);
}

/* A packer for rows with this many ids and a marker. */
static RowPacker *
create_marking(TupleDesc desc, abacus_names names, const RowOrigin *origin, int ids,
			   size_t batch)
{
	static const char marker[1][ABACUS_NAME_BYTES] = {"marker"};
	abacus_facts *facts = palloc(sizeof(abacus_facts));

	*facts = *names.facts;
	facts->columns.attributes = 0;
	facts->columns.labels = 1;
	return create(desc, (abacus_names) {facts, marker}, origin, ids, 0, 1, false, false, batch);
}

/* The same for rows of a query that mark facets, each by a simplex and a corner's number. */
RowPacker *
row_packer_create_facets(TupleDesc desc, abacus_names names, size_t batch)
{
	return create_marking(desc, names, &query_of_labels, names.facts->form.dimension + 3, batch);
}

/* The same for facets of simplices that are loaded, by the ids of their vertices. */
RowPacker *
row_packer_create_loaded_facets(TupleDesc desc, abacus_names names, size_t batch)
{
	return create_marking(desc, names, &query_of_simplices, names.facts->form.dimension, batch);
}

/* The same for edges of simplices that are loaded, by a line and the ids of two vertices. */
RowPacker *
row_packer_create_loaded_lines(TupleDesc desc, abacus_names names, size_t batch)
{
	return create(desc, names, &query_of_lines, 3, 0, 0, false, false, batch);
}

/* The same for rows of a query that are values of vertices: an id, and as many as there are columns. */
RowPacker *
row_packer_create_values(TupleDesc desc, size_t batch)
{
	abacus_facts *facts = palloc0(sizeof(abacus_facts));
	char		(*names)[ABACUS_NAME_BYTES] = palloc0(Max(desc->natts, 1) * sizeof(*names));

	facts->columns.attributes = (uint32) Max(desc->natts - 1, 0);
	for (int i = 1; i < desc->natts; i++)
		strlcpy(names[i - 1], NameStr(TupleDescAttr(desc, i)->attname), ABACUS_NAME_BYTES);
	return create(desc, (abacus_names) {facts, names}, &query_of_values, 1, 0,
				  (int) facts->columns.attributes, false, false, batch);
}

/* The same for rows of a query for an octree; `takes_srid` as above. */
RowPacker *
row_packer_create_octants(TupleDesc desc, abacus_names names, OctantRows rows,
						  bool takes_srid, size_t batch)
{
	bool		has_attributes = rows == OCTANT_LEAVES || rows == OCTANT_VALUES;
	int			coordinates = rows == OCTANT_LEAVES ? 1
		: rows == OCTANT_VALUES ? 0 : (int) names.facts->form.dimension;

	return create(desc, names, &queries_of_octants[rows], 1, coordinates,
				  has_attributes ? names.facts->columns.attributes : 0, rows == OCTANT_POINTS,
				  takes_srid, batch);
}

void
row_packer_reset(RowPacker *packer)
{
	packer->count = 0;
	if (packer->converts)
		MemoryContextReset(packer->scratch);
}
