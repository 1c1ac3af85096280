/*
 * fn_raster.c: abacus_raster, an attribute as the rows of a raster.
 */
#include "postgres.h"

#include <math.h>

#include "access/htup_details.h"
#include "funcapi.h"
#include "utils/memutils.h"

#include "abacus/raster.h"
#include "pg/base/settings.h"
#include "pg/base/sql_function.h"
#include "pg/sql/arguments/extent_arguments.h"
#include "pg/sql/arguments/interpolation.h"
#include "pg/sql/arguments/line.h"
#include "pg/sql/arguments/units.h"
#include "pg/sql/rows/result.h"
#include "pg/sql/rows/set.h"

SQL_FUNCTION(abacus_sql_raster);

/* Arguments */
enum
{
	RASTER_MESH,
	RASTER_LOWER,
	RASTER_UPPER,
	RASTER_WIDTH,
	RASTER_HEIGHT,
	RASTER_ATTRIBUTE,
	RASTER_METHOD,
	RASTER_OUTSIDE,
	RASTER_MAX_EDGE,
	RASTER_WITHIN
};

/* Columns */
enum
{
	ROW_NUMBER,
	ROW_VALUES,
	ROW_COLUMNS
};

/* The most values of an array: PostgreSQL makes it from as many datums, with a head. */
#define MOST_VALUES ((int) (MaxAllocSize / sizeof(Datum)) - 16)

typedef struct Rows
{
	Reader	   *reader;
	int			width;
	int			next;
} Rows;

/* The number of pixels on an axis. */
static uint32
pixels_argument(FunctionCallInfo fcinfo, int argument, const char *name, int most)
{
	int32		count = PG_GETARG_INT32(argument);

	if (count < 1)
		ereport(ERROR,
				(errcode(ERRCODE_INVALID_PARAMETER_VALUE),
				 errmsg("%s must be at least 1, not %d", name, count),
				 errhint("Give the number of pixels.")));
	if (count > most)
		ereport(ERROR,
				(errcode(ERRCODE_PROGRAM_LIMIT_EXCEEDED),
				 errmsg("%s must be at most %d", name, most),
				 errhint("Ask for parts of the window one after the other.")));
	return (uint32) count;
}

static void
raster_arguments(FunctionCallInfo fcinfo, uint32 dimension, abacus_raster *raster)
{
	line_place(fcinfo, RASTER_LOWER, "lower", dimension, raster->lower);
	line_place(fcinfo, RASTER_UPPER, "upper", dimension, raster->upper);
	for (int i = 0; i < 2; i++)
		if (!(raster->lower[i] < raster->upper[i]))
			ereport(ERROR,
					(errcode(ERRCODE_INVALID_PARAMETER_VALUE),
					 errmsg("lower must be less than upper on axis %c", "xy"[i]),
					 errhint("lower is the corner of the window with the least coordinates.")));
	if (dimension == 3 && raster->lower[2] != raster->upper[2])
		ereport(ERROR,
				(errcode(ERRCODE_INVALID_PARAMETER_VALUE),
				 errmsg("lower and upper must have the same z"),
				 errhint("The raster of a mesh in space lies in a plane of constant z.")));
	raster->width = pixels_argument(fcinfo, RASTER_WIDTH, "width", MOST_VALUES);
	raster->height = pixels_argument(fcinfo, RASTER_HEIGHT, "height", PG_INT32_MAX);
}

static bool
has_null_argument(FunctionCallInfo fcinfo)
{
	for (int i = RASTER_MESH; i <= RASTER_HEIGHT; i++)
		if (PG_ARGISNULL(i))
			return true;
	return false;
}

static void
begin(FunctionCallInfo fcinfo, FuncCallContext *set)
{
	Reader	   *reader = set_begin(fcinfo, set, result_row_type);
	Host	   *host = reader->host;
	Rows	   *rows = MemoryContextAlloc(set->multi_call_memory_ctx, sizeof(Rows));
	abacus_raster raster = {{0}};
	abacus_interpolation how;
	abacus_raster_scan *scan = NULL;

	interpolation_attribute(fcinfo, RASTER_ATTRIBUTE, abacus_names_of(&reader->header), &how);
	interpolation_how(fcinfo, RASTER_METHOD, &how);
	extent_arguments(fcinfo, RASTER_MAX_EDGE, RASTER_WITHIN, PG_GETARG_OID(RASTER_MESH), &reader->header, reader->host,
					 &how.extent);
	raster_arguments(fcinfo, reader->header.facts.form.dimension, &raster);
	units_tell_window(&reader->header.facts.form, raster.lower, raster.upper);
	rows->reader = reader;
	rows->width = (int) raster.width;
	rows->next = 0;
	set->user_fctx = rows;
	host_run(host, abacus_raster_open, &host->table, &reader->header.facts, &raster, &how,
			 setting_query_sort_bytes(), setting_cache_bytes(), &scan);
	host_own(host, scan, (void (*) (void *)) abacus_raster_close);
}

/*
 * abacus_raster(mesh regclass, lower float8[], upper float8[], width integer, height integer,
 *               attribute text, method text, outside text, max_edge float8, within text)
 *     -> row, values
 */
Datum
abacus_sql_raster(PG_FUNCTION_ARGS)
{
	FuncCallContext *set;
	Rows	   *rows;
	Host	   *host;
	const double *numbers;
	abacus_status status;
	Datum		values[ROW_COLUMNS];
	bool		isnull[ROW_COLUMNS] = {false};

	if (SRF_IS_FIRSTCALL())
	{
		set = SRF_FIRSTCALL_INIT();
		if (has_null_argument(fcinfo))
			SRF_RETURN_DONE(set);
		begin(fcinfo, set);
	}
	set = SRF_PERCALL_SETUP();
	rows = set->user_fctx;
	host = rows->reader->host;
	status = host_run(host, abacus_raster_next, host->handle, &numbers);
	host_release(host);
	if (status == ABACUS_END)
		SRF_RETURN_DONE(set);
	values[ROW_NUMBER] = Int32GetDatum(rows->next++);
	values[ROW_VALUES] = attribute_array(numbers, rows->width);
	SRF_RETURN_NEXT(set, HeapTupleGetDatum(heap_form_tuple(set->tuple_desc, values, isnull)));
}
