/*
 * row_errors.c: names of the columns of source rows, and errors about them.
 */
#include "postgres.h"

#include "lib/stringinfo.h"
#include "utils/builtins.h"

#include "pg/input/row_errors.h"
#include "pg/postgis/geometry_errors.h"

static const char *const coordinate_names[ABACUS_MAX_DIMENSION] = {"x", "y", "z"};
static const char *const corner_names[ABACUS_MAX_DIMENSION + 1] = {"v0", "v1", "v2", "v3"};

/* The name of a column in messages, and in tables by default. */
const char *
row_packer_column(abacus_names names, int column)
{
	if (column == 0)
		return "id";
	if (column <= (int) names.facts->form.dimension)
		return coordinate_names[column - 1];
	return names.of[column - 1 - names.facts->form.dimension];
}

/* The word of a record that a column of a row becomes. */
int
row_word(const RowPacker *packer, int column)
{
	return row_has_geometry(packer) && column > GEOMETRY_COLUMN
		? column + packer->columns - packer->inputs : column;
}

/* The name of a column of ids, if there are several: of a simplex, of one with a facet, or of an edge. */
static const char *
simplex_column(const RowPacker *packer, int column)
{
	int			dimension = (int) packer->names.facts->form.dimension;
	int			corner = packer->origin->by_number ? column - 1 : column;

	return corner < 0 ? packer->origin->id : corner <= dimension ? corner_names[corner] : "facet";
}

/* The name of a column of a row. */
static const char *
column_name(const RowPacker *packer, int column)
{
	if (packer->ids > 1)
		return column >= packer->ids
			? packer->names.of[packer->names.facts->columns.attributes + column - packer->ids]
			: simplex_column(packer, column);
	if (row_has_geometry(packer) && column == GEOMETRY_COLUMN)
		return "geometry";
	if (column == 0)
		return packer->origin->id;
	if (column == 1 && packer->origin->level != NULL)
		return packer->origin->level;
	column = row_word(packer, column) - packer->ids;
	return column < packer->coordinates ? coordinate_names[column]
		: packer->names.of[column - packer->coordinates];
}

/* "id, x, y, height" */
static char *
expected_columns(const RowPacker *packer)
{
	StringInfoData names;

	initStringInfo(&names);
	for (int i = 0; i < packer->inputs; i++)
		appendStringInfo(&names, "%s%s", i > 0 ? ", " : "", column_name(packer, i));
	return names.data;
}

/*
 * The coordinate that a column's name stands for, 0 for x, or -1; `sure`: names that also have
 * other meanings do not count.
 */
static int
coordinate_of_name(const char *name, bool sure)
{
	static const char *const others[][6] = {
		{"lon", "lng", "long", "longitude", "easting", NULL},
		{"lat", "latitude", "northing", NULL},
	};

	for (int axis = 0; axis < ABACUS_MAX_DIMENSION; axis++)
		if (pg_strcasecmp(name, coordinate_names[axis]) == 0)
			return axis;
	for (int axis = 0; !sure && axis < (int) lengthof(others); axis++)
		for (int i = 0; others[axis][i] != NULL; i++)
			if (pg_strcasecmp(name, others[axis][i]) == 0)
				return axis;
	return -1;
}

/*
 * Whether coordinates seem to be in the wrong columns: a coordinate's column has another name, and
 * a column with its name is elsewhere.
 */
static bool
are_misplaced(const RowPacker *packer, TupleDesc desc)
{
	if (packer->ids != 1 || packer->origin->level != NULL || row_has_geometry(packer))
		return false;
	for (int axis = 0; axis < packer->coordinates && axis + 1 < desc->natts; axis++)
	{
		if (coordinate_of_name(NameStr(TupleDescAttr(desc, 1 + axis)->attname), false) == axis)
			continue;
		for (int i = 0; i < desc->natts; i++)
			if (coordinate_of_name(NameStr(TupleDescAttr(desc, i)->attname),
								   i > packer->coordinates) == axis)
				return true;
	}
	return false;
}

/* "x" is taken as id, "y" as x; of many attributes the first ones are enough */
static char *
taken_columns(const RowPacker *packer, TupleDesc desc)
{
	const int	most = 1 + packer->coordinates + 4;
	int			columns = Min(packer->inputs, desc->natts);
	StringInfoData text;

	initStringInfo(&text);
	for (int i = 0; i < Min(columns, most); i++)
		appendStringInfo(&text, "%s\"%s\" %sas %s", i > 0 ? ", " : "",
						 NameStr(TupleDescAttr(desc, i)->attname), i > 0 ? "" : "is taken ",
						 column_name(packer, i));
	if (columns > most)
		appendStringInfoString(&text, ", ...");
	return text.data;
}

/* A sentence after a detail: which column was taken for what, if that looks wrong. */
static char *
taken_sentence(const RowPacker *packer, TupleDesc desc)
{
	return are_misplaced(packer, desc) ? psprintf(" Here %s.", taken_columns(packer, desc)) : "";
}

/* Columns are taken in their order even if their names say otherwise, but with a notice. */
void
row_tell_order(const RowPacker *packer, TupleDesc desc)
{
	if (are_misplaced(packer, desc))
		ereport(NOTICE,
				(errmsg("columns are matched by position, not by name: %s", taken_columns(packer, desc)),
				 errhint("Put the columns in the order %s, %s%s.", packer->origin->id,
						 packer->names.facts->form.dimension == 2 ? "x, y" : "x, y, z",
						 packer->inputs > 1 + packer->coordinates ? ", then attributes" : "")));
}

/* The z of geometries is no attribute unless a query selects it. */
void
row_tell_z(const RowPacker *packer, TupleDesc desc)
{
	Form_pg_attribute column;

	if (!row_has_geometry(packer) || packer->names.facts->form.dimension > 2)
		return;
	column = TupleDescAttr(desc, GEOMETRY_COLUMN);
	if (geometry_typmod_has_z(column->atttypmod))
		ereport(NOTICE,
				(errmsg("the z of \"%s\" is left out", NameStr(column->attname)),
				 errhint("Make a mesh with an attribute, and select ST_Z(%s), too.",
						 quote_identifier(NameStr(column->attname)))));
}

/* A hint about a geometry that cannot be read here, or NULL. */
static char *
geometry_hint(const RowPacker *packer, const char *column, Oid type)
{
	const char *name;
	char	   *quoted = unconstify(char *, quote_identifier(column));

	if (packer->origin->geometry_hint == NULL)
		return NULL;
	if (geometry_is_type(type) && packer->origin->takes_geometry)
		return pstrdup("Put the geometry after the id, in place of all coordinates.");
	name = geometry_type_name(type);
	if (strcmp(name, "geography") == 0)
		return psprintf("Cast it to geometry: %s::geometry.", quoted);
	if (strcmp(name, "geometry") != 0)
		return NULL;
	return psprintf(packer->names.facts->form.dimension == 2 ? "%2$s, ST_X(%1$s) and ST_Y(%1$s)."
					: "%2$s, ST_X(%1$s), ST_Y(%1$s) and ST_Z(%1$s).",
					quoted, packer->origin->geometry_hint);
}

/* Whether rows of points lack an id: they begin with something else. */
static bool
lacks_id(const RowPacker *packer, TupleDesc desc)
{
	return packer->origin->makes_id &&
		(desc->natts == 0 || pg_strcasecmp(NameStr(TupleDescAttr(desc, 0)->attname), "id") != 0);
}

void
row_refuse_type(const RowPacker *packer, int column, TupleDesc desc)
{
	Form_pg_attribute attribute = TupleDescAttr(desc, column);
	bool		is_id = column < packer->ids;
	const char *hint = geometry_hint(packer, NameStr(attribute->attname), attribute->atttypid);
	const char *kinds = is_id ? psprintf("%s must be smallint, integer or bigint.", packer->origin->an_id)
		: packer->ids > 1 ? "Labels must be double precision, real, numeric or integers."
		: "Coordinates and attributes must be double precision, real, numeric or integers.";

	if (hint == NULL && is_id && lacks_id(packer, desc))
		hint = "Put the id first. If the rows have none, make one with row_number() OVER (); "
			"if this column is the id, cast it.";
	ereport(ERROR,
			(errcode(ERRCODE_DATATYPE_MISMATCH),
			 errmsg("column %d (%s) of %s has type %s", column + 1, column_name(packer, column),
					packer->origin->columns_of, format_type_be(attribute->atttypid)),
			 errdetail("%s%s", kinds, taken_sentence(packer, desc)),
			 errhint("%s", hint != NULL ? hint : packer->origin->type_hint)));
}

/* A hint about rows with too few or too many columns, or NULL. */
static char *
count_hint(const RowPacker *packer, TupleDesc desc)
{
	char	   *hint = NULL;

	for (int i = 0; hint == NULL && i < desc->natts; i++)
		hint = geometry_hint(packer, NameStr(TupleDescAttr(desc, i)->attname),
							 TupleDescAttr(desc, i)->atttypid);
	if (hint != NULL || packer->ids > 1 || packer->origin->level != NULL)
		return hint;
	if (desc->natts > packer->inputs && packer->names.facts->form.dimension == 2 && desc->natts > 3 &&
		pg_strcasecmp(NameStr(TupleDescAttr(desc, 3)->attname), "z") == 0)
		return psprintf("The %s has dimension 2. To make one in space, use dimension => 3.",
						packer->origin->whole);
	if (desc->natts < packer->inputs && lacks_id(packer, desc))
		return "Put the id first. If the rows have none, make one with row_number() OVER ().";
	return NULL;
}

void
row_refuse_count(const RowPacker *packer, TupleDesc desc)
{
	char	   *hint = count_hint(packer, desc);

	ereport(ERROR,
			(errcode(ERRCODE_DATATYPE_MISMATCH),
			 errmsg("source query returns %d columns, but the %s takes %d", desc->natts,
					packer->origin->whole, packer->inputs),
			 errdetail("Columns are matched by position: %s.%s", expected_columns(packer),
					   taken_sentence(packer, desc)),
			 hint != NULL ? errhint("%s", hint) : 0));
}

/* A NULL or NaN has no place; the error says which point it was. */
void
row_refuse_value(const RowPacker *packer, const uint64 *point, int column, bool isnull)
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

/* A geometry has another system than the mesh, or than the geometries before it. */
void
row_refuse_srid(const RowPacker *packer, const char *what, int32 srid)
{
	if (packer->names.facts->form.srid != 0 || !packer->takes_srid)
		geometry_refuse_srid(what, srid, (int32) packer->names.facts->form.srid, packer->origin->whole);
	ereport(ERROR,
			(errcode(ERRCODE_INVALID_PARAMETER_VALUE),
			 errmsg("%s has SRID %d, but earlier geometries have SRID %d", what, srid, packer->srid),
			 errhint("Transform all geometries to one system with ST_Transform.")));
}
