/*
 * line_rows.c: reads the rows of a query that gives lines: line, position and point id, perhaps
 * with x, y, attributes and the part; or line and geometry (line_geometries.c).
 */
#include "postgres.h"

#include <math.h>

#include "catalog/pg_type.h"
#include "utils/builtins.h"
#include "utils/lsyscache.h"
#include "utils/memutils.h"

#include "pg/base/float_array.h"
#include "pg/lines/line_geometries.h"
#include "pg/lines/line_rows.h"
#include "pg/lines/line_values.h"
#include "pg/mesh/header.h"

#define ROWS_A_FETCH 1024
#define PART_COLUMN "part"

static const char *const column_names[] = {"line", "position", "point id", "x", "y"};

/* How the columns of a query are read. */
typedef struct LineReader
{
	NamedRows  *rows;
	TupleDesc	desc;			/* of the query */
	Oid		   *types;			/* of its columns, without domains */
	int			ids;			/* so many columns are integers; the others are numbers */
	uint32	   *attributes;		/* of the columns after x and y: numbers in the mesh */
	uint32		count;			/* attributes of the mesh */
	uint64		row;			/* for messages */
	bool		any_nameless;	/* so far */
	int			part;			/* its column; -1: none */
	LineGeometries *geometries; /* NULL: rows of points */
	const char *points_of;		/* as in LineReading */
} LineReader;

/* ---- Columns --------------------------------------------------------------------- */

/* Whether the column may be a bare NULL, which has the type text. */
static bool
may_be_null(const LineReader *reader, int column)
{
	return column == LINE_ROW_POINT || column == reader->part || column > LINE_ROW_Y;
}

/* What a column must hold, for messages. */
static char *
wanted(const LineReader *reader, int column)
{
	if (column < reader->ids)
		return psprintf("the %s, which is an integer", column_names[column]);
	if (column == reader->part)
		return pstrdup("the part, which is an integer");
	if (column <= LINE_ROW_Y)
		return psprintf("%s, which is a number", column_names[column]);
	return psprintf("the attribute \"%s\", which is a number",
					NameStr(TupleDescAttr(reader->desc, column)->attname));
}

static bool
has_attributes(const LineReader *reader)
{
	return reader->desc->natts - (reader->part >= 0) > LINE_ROW_Y + 1;
}

static void
check_types(const LineReader *reader)
{
	int			columns = reader->geometries != NULL ? reader->ids : reader->desc->natts;

	for (int i = 0; i < columns; i++)
	{
		Oid			type = reader->types[i];

		if ((i < reader->ids || i == reader->part ? line_value_is_integer(type) : line_value_is_number(type)) ||
			(type == TEXTOID && may_be_null(reader, i) && reader->desc->natts > reader->ids))
			continue;
		ereport(ERROR,
				(errcode(ERRCODE_DATATYPE_MISMATCH),
				 errmsg("column %d of the query of lines has type %s", i + 1,
						format_type_be(TupleDescAttr(reader->desc, i)->atttypid)),
				 errdetail("It is %s.", wanted(reader, i)),
				 errhint("Cast the column in the query.")));
	}
}

/* The attribute with the name of a column. */
static uint32
find_attribute(abacus_names names, const char *name)
{
	for (uint32 i = 0; i < names.facts->columns.attributes; i++)
		if (strcmp(names.of[i], name) == 0)
			return i;
	ereport(ERROR,
			(errcode(ERRCODE_UNDEFINED_COLUMN),
			 errmsg("mesh has no attribute \"%s\"", name),
			 errdetail("Columns of the query of lines after x and y are attributes of the mesh, by name."),
			 errhint("Rename the column, or leave it out.")));
	return 0;					/* not reached */
}

/* Finds the column after the first ones that is named part, unless it is an attribute. */
static void
find_part(LineReader *reader, abacus_names names)
{
	int			first = reader->desc->natts == LINE_ROW_POINT + 2 ? LINE_ROW_POINT + 1 : LINE_ROW_Y + 1;

	reader->part = -1;
	for (int i = first; i < reader->desc->natts && reader->part < 0; i++)
		if (strcmp(NameStr(TupleDescAttr(reader->desc, i)->attname), PART_COLUMN) == 0)
			reader->part = i;
	if (first > LINE_ROW_Y && header_attribute(names, PART_COLUMN) >= 0)
		reader->part = -1;
}

static void
find_attributes(LineReader *reader, abacus_names names)
{
	int			first = LINE_ROW_Y + 1;

	reader->count = names.facts->columns.attributes;
	reader->attributes = palloc(reader->desc->natts * sizeof(uint32));
	for (int i = first; i < reader->desc->natts; i++)
	{
		const char *name = NameStr(TupleDescAttr(reader->desc, i)->attname);

		if (i == reader->part)
			continue;
		reader->attributes[i] = find_attribute(names, name);
		for (int j = first; j < i; j++)
			if (j != reader->part && reader->attributes[j] == reader->attributes[i])
				ereport(ERROR,
						(errcode(ERRCODE_DUPLICATE_COLUMN),
						 errmsg("the query of lines returns attribute \"%s\" twice", name)));
	}
}

static void
refuse_count(int count, const char *detail, const char *hint)
{
	ereport(ERROR,
			(errcode(ERRCODE_DATATYPE_MISMATCH),
			 errmsg_plural("the query of lines returns %d column", "the query of lines returns %d columns",
						   (unsigned long) count, count),
			 errdetail("%s", detail), errhint("%s", hint)));
}

static void
open_query(LineReader *reader, Source *source)
{
	source->portal = SPI_cursor_open(NULL, source->plan, NULL, NULL, true);
	reader->desc = source->portal->tupDesc;
	reader->types = palloc(reader->desc->natts * sizeof(Oid));
	for (int i = 0; i < reader->desc->natts; i++)
		reader->types[i] = getBaseType(TupleDescAttr(reader->desc, i)->atttypid);
}

/* ---- Values ---------------------------------------------------------------------- */

/* The table of points lacks one. */
static void
refuse_unknown(const LineReader *reader, const Datum *values)
{
	ereport(ERROR,
			(errcode(ERRCODE_INVALID_PARAMETER_VALUE),
			 errmsg("table \"%s\" has no point " INT64_FORMAT, reader->points_of,
					DatumGetInt64(values[LINE_ROW_POINT])),
			 errdetail("It is at position " INT64_FORMAT " of line " INT64_FORMAT ".",
					   DatumGetInt64(values[LINE_ROW_POSITION]), DatumGetInt64(values[LINE_ROW_LINE])),
			 errhint("Insert the point, or change the line, in the same transaction.")));
}

static void
refuse_null(const LineReader *reader, const Datum *values, int column)
{
	if (column > LINE_ROW_POINT && reader->points_of != NULL)
		refuse_unknown(reader, values);
	if (column == LINE_ROW_LINE)
		ereport(ERROR,
				(errcode(ERRCODE_NULL_VALUE_NOT_ALLOWED),
				 errmsg("line of row " UINT64_FORMAT " is NULL", reader->row),
				 errhint("Leave such rows out with a WHERE clause.")));
	if (column == LINE_ROW_POSITION)
		ereport(ERROR,
				(errcode(ERRCODE_NULL_VALUE_NOT_ALLOWED),
				 errmsg("a position in line " INT64_FORMAT " is NULL", DatumGetInt64(values[0])),
				 errhint("Number the points of each line in their order, for instance with row_number().")));
	ereport(ERROR,
			(errcode(ERRCODE_NULL_VALUE_NOT_ALLOWED),
			 errmsg("%s at position " INT64_FORMAT " of line " INT64_FORMAT " is NULL",
					column_names[column], DatumGetInt64(values[1]), DatumGetInt64(values[0])),
			 column == LINE_ROW_POINT
			 ? errhint("Give x and y after it, and the point is the vertex there, or a new one.")
			 : errhint("Leave such rows out with a WHERE clause.")));
}

static void
refuse_text(const LineReader *reader, int column)
{
	ereport(ERROR,
			(errcode(ERRCODE_DATATYPE_MISMATCH),
			 errmsg("column %d of the query of lines has type text", column + 1),
			 errhint("Cast the column in the query.")));
}

/* Reads the ids of a row; which may be NULL depends on the shape of the rows. */
static void
read_ids(LineReader *reader, HeapTuple tuple, bool has_places, Datum *values, bool *isnull)
{
	for (int i = 0; i < reader->ids; i++)
	{
		values[i] = SPI_getbinval(tuple, reader->desc, i + 1, &isnull[i]);
		if (isnull[i])
		{
			if (!has_places || i != LINE_ROW_POINT)
				refuse_null(reader, values, i);
			reader->any_nameless = true;
			continue;
		}
		if (!line_value_is_integer(reader->types[i]))
			refuse_text(reader, i);
		values[i] = Int64GetDatum(line_value_integer(reader->types[i], values[i]));
	}
}

static void
read_place(const LineReader *reader, HeapTuple tuple, Datum *values, bool *isnull)
{
	for (int i = LINE_ROW_X; i <= LINE_ROW_Y; i++)
	{
		Datum		value = SPI_getbinval(tuple, reader->desc, i + 1, &isnull[i]);
		double		number;

		if (isnull[i])
			refuse_null(reader, values, i);
		number = line_value_number(reader->types[i], value);
		if (!isfinite(number))
			ereport(ERROR,
					(errcode(ERRCODE_INVALID_PARAMETER_VALUE),
					 errmsg("%s at position " INT64_FORMAT " of line " INT64_FORMAT " is %s",
							column_names[i], DatumGetInt64(values[1]), DatumGetInt64(values[0]),
							isnan(number) ? "NaN" : "infinite"),
					 errhint("Leave such rows out with a WHERE clause.")));
		values[i] = Float8GetDatum(number + 0.0);	/* no negative zero */
	}
}

static void
read_part(const LineReader *reader, HeapTuple tuple, Datum *values, bool *isnull)
{
	Datum		value = SPI_getbinval(tuple, reader->desc, reader->part + 1, &isnull[LINE_ROW_PART]);

	if (isnull[LINE_ROW_PART])
		return;
	if (!line_value_is_integer(reader->types[reader->part]))
		refuse_text(reader, reader->part);
	values[LINE_ROW_PART] = Int64GetDatum(line_value_integer(reader->types[reader->part], value));
}

static void
read_attributes(const LineReader *reader, HeapTuple tuple, Datum *values, bool *isnull)
{
	double		numbers[ABACUS_MAX_ATTRIBUTES];

	isnull[LINE_ROW_ATTRIBUTES] = !has_attributes(reader);
	if (isnull[LINE_ROW_ATTRIBUTES])
		return;
	for (uint32 i = 0; i < reader->count; i++)
		numbers[i] = NAN;
	for (int i = LINE_ROW_Y + 1; i < reader->desc->natts; i++)
	{
		bool		none;
		Datum		value = SPI_getbinval(tuple, reader->desc, i + 1, &none);

		if (i == reader->part)
			continue;
		if (!none && !line_value_is_number(reader->types[i]))
			refuse_text(reader, i);
		if (!none)
			numbers[reader->attributes[i]] = line_value_number(reader->types[i], value);
	}
	values[LINE_ROW_ATTRIBUTES] = attribute_array(numbers, (int) reader->count);
}

/* ---- Rows ------------------------------------------------------------------------ */

/* Reads a row: a point of a line, or the id of a line and perhaps its geometry. */
static void
read_row(LineReader *reader, HeapTuple tuple, bool has_places)
{
	Datum		values[LINE_ROW_COLUMNS];
	bool		isnull[LINE_ROW_COLUMNS];

	memset(isnull, true, sizeof(isnull));
	reader->row++;
	read_ids(reader, tuple, has_places, values, isnull);
	if (reader->geometries != NULL)
	{
		bool		none;
		Datum		geometry = SPI_getbinval(tuple, reader->desc, reader->ids + 1, &none);

		line_geometries_put(reader->geometries, DatumGetInt64(values[LINE_ROW_LINE]), geometry, none);
		return;
	}
	if (has_places)
	{
		read_place(reader, tuple, values, isnull);
		read_attributes(reader, tuple, values, isnull);
	}
	if (reader->part >= 0)
		read_part(reader, tuple, values, isnull);
	named_rows_put(reader->rows, values, isnull);
}

static void
read_rows(LineReader *reader, Source *source, bool has_places)
{
	MemoryContext row = AllocSetContextCreate(CurrentMemoryContext, "Abacus line row",
											  ALLOCSET_DEFAULT_SIZES);

	for (;;)
	{
		SPI_cursor_fetch(source->portal, true, ROWS_A_FETCH);
		if (SPI_processed == 0)
			break;
		for (uint64 i = 0; i < SPI_processed; i++)
		{
			MemoryContext old = MemoryContextSwitchTo(row);

			read_row(reader, SPI_tuptable->vals[i], has_places);
			MemoryContextSwitchTo(old);
			MemoryContextReset(row);
		}
		SPI_freetuptable(SPI_tuptable);
	}
	source_close(source);
	MemoryContextDelete(row);
}

/* Reads a query of lines and geometries. */
static void
read_geometries(LineReader *reader, Source *source, const LineReading *reading, LineShape *shape)
{
	reader->ids = LINE_ROW_LINE + 1;
	reader->geometries = line_geometries_begin(reader->rows, reader->types[1], reading->names, reading->z);
	check_types(reader);
	read_rows(reader, source, true);
	line_geometries_end(reader->geometries, shape);
	if (!reading->is_quiet)
		line_geometries_tell(reader->geometries);
}

/* Reads a query of points of lines. */
static void
read_points(LineReader *reader, Source *source, abacus_names names, LineShape *shape)
{
	int			columns = reader->desc->natts;

	find_part(reader, names);
	if (columns < 3 || (columns == 4 && reader->part < 0))
		refuse_count(columns, "Rows of lines have three columns, or five and more.",
					 "Return line, position and the id of a point; x, y and attributes may follow, and "
					 "a column named part. With PostGIS, return line and a geometry.");
	shape->has_places = columns > reader->ids + 1;
	shape->has_attributes = shape->has_places && has_attributes(reader);
	shape->has_parts = reader->part >= 0;
	check_types(reader);
	if (shape->has_places)
		find_attributes(reader, names);
	read_rows(reader, source, shape->has_places);
	shape->has_nameless = reader->any_nameless;
}

/* Reads the rows of a prepared query that gives lines. */
NamedRows *
line_rows_read(Source *source, const LineReading *reading, LineShape *shape)
{
	static const NamedColumn columns[] = {
		{"line", INT8OID}, {"position", INT8OID}, {"point", INT8OID}, {"x", FLOAT8OID},
		{"y", FLOAT8OID}, {"attributes", FLOAT8ARRAYOID}, {"part", INT8OID}
	};
	LineReader	reader = {.ids = LINE_ROW_POINT + 1,.points_of = reading->points_of};

	open_query(&reader, source);
	memset(shape, 0, sizeof(*shape));
	shape->srid = -1;
	reader.rows = named_rows_create(LINE_ROWS, columns, lengthof(columns));
	if (reader.desc->natts == 2 && geometry_is_type(reader.types[1]))
		read_geometries(&reader, source, reading, shape);
	else if (reading->z != NULL)
		ereport(ERROR,
				(errcode(ERRCODE_INVALID_PARAMETER_VALUE),
				 errmsg("z is for lines given as geometries"),
				 errhint("Name a column of the query \"%s\", after x and y.", reading->z)));
	else
		read_points(&reader, source, reading->names, shape);
	return reader.rows;
}

/* Reads the rows of a prepared query that gives ids of lines. */
NamedRows *
line_ids_read(Source *source)
{
	static const NamedColumn columns[] = {{"line", INT8OID}};
	LineReader	reader = {.ids = 1, .part = -1};

	open_query(&reader, source);
	if (reader.desc->natts != 1)
		refuse_count(reader.desc->natts, "Rows have one column, the id of a line.",
					 "Return the ids alone.");
	check_types(&reader);
	reader.rows = named_rows_create(LINE_IDS, columns, lengthof(columns));
	read_rows(&reader, source, false);
	return reader.rows;
}
