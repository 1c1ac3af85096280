/*
 * region_rows.c: reads the rows of a query that gives regions: region and line, or region, x and y.
 */
#include "postgres.h"

#include <math.h>

#include "catalog/pg_type.h"
#include "parser/parse_coerce.h"
#include "utils/builtins.h"
#include "utils/lsyscache.h"
#include "utils/memutils.h"

#include "pg/base/text_begin.h"
#include "pg/geos/area_text.h"
#include "pg/lines/line_values.h"
#include "pg/lines/region_rows.h"

#define ROWS_A_FETCH 1024

enum
{
	REGION_ROW_REGION,
	REGION_ROW_LINE,
	REGION_ROW_X,
	REGION_ROW_Y,
	REGION_ROW_COLUMNS
};

/* The columns of the query, in their order. */
static const char *const outline_columns[] = {"the region", "the line"};
static const char *const seed_columns[] = {"the region", "x", "y"};

typedef struct RegionReader
{
	NamedRows  *rows;
	TupleDesc	desc;			/* of the query */
	Oid			types[3];		/* of its columns, without domains */
	bool		are_seeds;
	Oid			text_output;	/* of the first column */
	uint64		row;			/* for messages */
} RegionReader;

static const char *
column_name(const RegionReader *reader, int column)
{
	return reader->are_seeds ? seed_columns[column] : outline_columns[column];
}

static void
check_columns(RegionReader *reader)
{
	int			columns = reader->desc->natts;
	bool		varies;

	if (columns != lengthof(outline_columns) && columns != lengthof(seed_columns))
		ereport(ERROR,
				(errcode(ERRCODE_DATATYPE_MISMATCH),
				 errmsg_plural("the query of regions returns %d column", "the query of regions returns %d columns",
							   (unsigned long) columns, columns),
				 errdetail("Rows of regions have two or three columns."),
				 errhint("Return region and line for outlines, or region, x and y for seeds.")));
	reader->are_seeds = columns == lengthof(seed_columns);
	for (int i = 0; i < columns; i++)
	{
		Oid			type = getBaseType(TupleDescAttr(reader->desc, i)->atttypid);

		reader->types[i] = type;
		if (i == 0 ? TypeCategory(type) == TYPCATEGORY_STRING
			: reader->are_seeds ? line_value_is_number(type) : line_value_is_integer(type))
			continue;
		ereport(ERROR,
				(errcode(ERRCODE_DATATYPE_MISMATCH),
				 errmsg("column %d of the query of regions has type %s", i + 1,
						format_type_be(TupleDescAttr(reader->desc, i)->atttypid)),
				 errdetail("It is %s, which is %s.", column_name(reader, i),
						   i == 0 ? "text" : reader->are_seeds ? "a number" : "an integer"),
				 errhint("Cast the column in the query.")));
	}
	getTypeOutputInfo(reader->types[0], &reader->text_output, &varies);
}

static void
refuse_null(const RegionReader *reader, int column)
{
	ereport(ERROR,
			(errcode(ERRCODE_NULL_VALUE_NOT_ALLOWED),
			 errmsg("%s of row " UINT64_FORMAT " is NULL", column_name(reader, column), reader->row),
			 errhint("Leave such rows out with a WHERE clause.")));
}

static Datum
coordinate(const RegionReader *reader, int column, Datum value)
{
	double		number = line_value_number(reader->types[column], value);

	if (!isfinite(number))
		ereport(ERROR,
				(errcode(ERRCODE_INVALID_PARAMETER_VALUE),
				 errmsg("%s of row " UINT64_FORMAT " is %s", column_name(reader, column), reader->row,
						isnan(number) ? "NaN" : "infinite"),
				 errhint("Leave such rows out with a WHERE clause.")));
	return Float8GetDatum(number + 0.0);	/* no negative zero */
}

static void
read_row(RegionReader *reader, HeapTuple tuple)
{
	Datum		given[lengthof(seed_columns)];
	Datum		values[REGION_ROW_COLUMNS];
	bool		isnull[REGION_ROW_COLUMNS];
	char	   *region;

	reader->row++;
	for (int i = 0; i < reader->desc->natts; i++)
	{
		bool		none;

		given[i] = SPI_getbinval(tuple, reader->desc, i + 1, &none);
		if (none)
			refuse_null(reader, i);
	}
	memset(isnull, true, sizeof(isnull));
	region = OidOutputFunctionCall(reader->text_output, given[0]);
	if (region[0] == '\0')
		ereport(ERROR,
				(errcode(ERRCODE_INVALID_PARAMETER_VALUE),
				 errmsg("the region of row " UINT64_FORMAT " has an empty name", reader->row),
				 errhint("Name each region.")));
	if (area_text_is(region))
		ereport(ERROR,
				(errcode(ERRCODE_INVALID_PARAMETER_VALUE),
				 errmsg("the region of row " UINT64_FORMAT " is named like a geometry", reader->row),
				 errdetail("Questions within \"%s\" would be about that polygon.", text_begin(region)),
				 errhint("Put a word before the name.")));
	values[REGION_ROW_REGION] = CStringGetTextDatum(region);
	isnull[REGION_ROW_REGION] = false;
	if (reader->are_seeds)
	{
		values[REGION_ROW_X] = coordinate(reader, 1, given[1]);
		values[REGION_ROW_Y] = coordinate(reader, 2, given[2]);
		isnull[REGION_ROW_X] = isnull[REGION_ROW_Y] = false;
	}
	else
	{
		values[REGION_ROW_LINE] = Int64GetDatum(line_value_integer(reader->types[1], given[1]));
		isnull[REGION_ROW_LINE] = false;
	}
	named_rows_put(reader->rows, values, isnull);
}

/* Reads the rows of a prepared query that gives regions. */
NamedRows *
region_rows_read(Source *source)
{
	static const NamedColumn columns[] = {
		{"region", TEXTOID}, {"line", INT8OID}, {"x", FLOAT8OID}, {"y", FLOAT8OID}
	};
	RegionReader reader = {0};
	MemoryContext row = AllocSetContextCreate(CurrentMemoryContext, "Abacus region row",
											  ALLOCSET_DEFAULT_SIZES);

	source->portal = SPI_cursor_open(NULL, source->plan, NULL, NULL, true);
	reader.desc = source->portal->tupDesc;
	check_columns(&reader);
	reader.rows = named_rows_create(REGION_ROWS, columns, lengthof(columns));
	for (;;)
	{
		SPI_cursor_fetch(source->portal, true, ROWS_A_FETCH);
		if (SPI_processed == 0)
			break;
		for (uint64 i = 0; i < SPI_processed; i++)
		{
			MemoryContext old = MemoryContextSwitchTo(row);

			read_row(&reader, SPI_tuptable->vals[i]);
			MemoryContextSwitchTo(old);
			MemoryContextReset(row);
		}
		SPI_freetuptable(SPI_tuptable);
	}
	source_close(source);
	MemoryContextDelete(row);
	return reader.rows;
}
