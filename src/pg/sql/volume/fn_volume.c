/*
 * fn_volume.c: abacus_volume, areas and volumes over a base or between two meshes, and
 * abacus_compare, how two meshes differ.
 */
#include "postgres.h"

#include <math.h>

#include "access/htup_details.h"
#include "funcapi.h"
#include "utils/builtins.h"
#include "utils/float.h"
#include "utils/lsyscache.h"

#include "abacus/volume.h"
#include "pg/base/settings.h"
#include "pg/base/sql_function.h"
#include "pg/mesh/reader.h"
#include "pg/sql/arguments/extent_arguments.h"
#include "pg/sql/arguments/interpolation.h"
#include "pg/sql/arguments/units.h"
#include "pg/sql/arguments/window.h"
#include "pg/sql/rows/result.h"

SQL_FUNCTION(abacus_sql_volume);
SQL_FUNCTION(abacus_sql_volume_between);
SQL_FUNCTION(abacus_sql_volume_between_named);
SQL_FUNCTION(abacus_sql_compare);

/* Arguments: the mesh, the base or the other mesh, then these */
enum
{
	OF_MESH,
	OF_OTHER,
	OF_ATTRIBUTE,
	OF_LOWER,
	OF_UPPER,
	OF_MAX_EDGE,
	OF_OTHER_ATTRIBUTE			/* if there is another mesh; within is the last one */
};

/* Columns of the result */
enum
{
	VOLUME_AREA,
	VOLUME_SURFACE,
	VOLUME_CUT,
	VOLUME_FILL,
	VOLUME_NET,
	VOLUME_COLUMNS
};

/* Columns of a comparison */
enum
{
	COMPARISON_GREATEST,
	COMPARISON_PLACE,
	COMPARISON_MEAN = COMPARISON_PLACE + ABACUS_MAX_DIMENSION,
	COMPARISON_MEAN_ABSOLUTE,
	COMPARISON_RMS,
	COMPARISON_COLUMNS
};

static uint32
attribute(FunctionCallInfo fcinfo, int argument, abacus_names names)
{
	abacus_interpolation which;

	interpolation_attribute(fcinfo, argument, names, &which);
	return which.attribute[0];
}

static void
surface_arguments(FunctionCallInfo fcinfo, const Reader *reader, abacus_surface *surface)
{
	abacus_names names = abacus_names_of(&reader->header);

	window_arguments(fcinfo, OF_LOWER, WINDOW_BOX, &names.facts->form, &surface->window);
	extent_arguments(fcinfo, OF_MAX_EDGE, PG_NARGS() - 1, PG_GETARG_OID(OF_MESH), &reader->header, reader->host,
					 &surface->extent);
	surface->attribute = attribute(fcinfo, OF_ATTRIBUTE, names);
}

static Datum
volume_row(FunctionCallInfo fcinfo, const abacus_volume *volume)
{
	Datum		values[VOLUME_COLUMNS];
	bool		isnull[VOLUME_COLUMNS] = {false};

	if (!isfinite(volume->area) || !isfinite(volume->surface) || !isfinite(volume->cut) ||
		!isfinite(volume->fill))
		float_overflow_error();
	values[VOLUME_AREA] = Float8GetDatum(volume->area);
	values[VOLUME_SURFACE] = Float8GetDatum(volume->surface);
	values[VOLUME_CUT] = Float8GetDatum(volume->cut);
	values[VOLUME_FILL] = Float8GetDatum(volume->fill);
	values[VOLUME_NET] = Float8GetDatum(volume->cut - volume->fill);
	return HeapTupleGetDatum(heap_form_tuple(result_row_type(fcinfo), values, isnull));
}

static Datum
volume_above(FunctionCallInfo fcinfo, double base)
{
	abacus_surface surface = {0};
	abacus_volume volume;
	Reader	   *reader;
	Host	   *host;

	if (!isfinite(base))
		ereport(ERROR,
				(errcode(ERRCODE_INVALID_PARAMETER_VALUE), errmsg("base must be finite"),
				 errhint("Give the height above which volumes are cut, and below which they are fill.")));
	reader = reader_open(PG_GETARG_OID(OF_MESH), CurrentMemoryContext);
	host = reader->host;
	surface_arguments(fcinfo, reader, &surface);
	units_tell_volumes(&reader->header.facts.form);
	progress_begin(&host->progress, PG_GETARG_OID(OF_MESH));
	host_run(host, abacus_volume_above, &host->table, &reader->header.facts, &surface, base, &volume);
	progress_end(&host->progress);
	host_release(host);
	host_destroy(host);
	return volume_row(fcinfo, &volume);
}

/*
 * abacus_volume(mesh regclass, base float8, attribute text, lower float8[],
 *               upper float8[], max_edge float8, within text) -> area, surface, cut, fill, net
 */
Datum
abacus_sql_volume(PG_FUNCTION_ARGS)
{
	if (PG_ARGISNULL(OF_MESH) || PG_ARGISNULL(OF_OTHER))
		PG_RETURN_NULL();
	PG_RETURN_DATUM(volume_above(fcinfo, PG_GETARG_FLOAT8(OF_OTHER)));
}

static void
require_dimension(const Reader *reader, uint32 dimension, const char *hint)
{
	if (reader->header.facts.form.dimension != dimension)
		ereport(ERROR,
				(errcode(ERRCODE_INVALID_PARAMETER_VALUE),
				 errmsg("mesh \"%s\" has dimension %u, not %u",
						get_rel_name(mesh_pages(reader->host)->mesh), reader->header.facts.form.dimension, dimension),
				 errhint("%s", hint)));
}

/* Two meshes, the part of the first that counts, and the attribute of the other. */
typedef struct Between
{
	Reader	   *first;
	Reader	   *second;
	abacus_surface surface;
	uint32		other_attribute;
} Between;

/* Opens two meshes of the same dimension, or of dimension 2 if `is_plane`; `hint` says what to do with others. */
static void
between_open(FunctionCallInfo fcinfo, Oid other, bool is_plane, const char *hint, Between *between)
{
	int			other_name = PG_ARGISNULL(OF_OTHER_ATTRIBUTE) ? OF_ATTRIBUTE : OF_OTHER_ATTRIBUTE;

	memset(between, 0, sizeof(*between));
	between->first = reader_open(PG_GETARG_OID(OF_MESH), CurrentMemoryContext);
	between->second = reader_open(other, CurrentMemoryContext);
	if (is_plane)
		require_dimension(between->first, 2, hint);
	require_dimension(between->second, between->first->header.facts.form.dimension, hint);
	surface_arguments(fcinfo, between->first, &between->surface);
	between->other_attribute = attribute(fcinfo, other_name, abacus_names_of(&between->second->header));
	progress_begin(&between->first->host->progress, PG_GETARG_OID(OF_MESH));
}

static void
between_close(Between *between)
{
	progress_end(&between->first->host->progress);
	host_release(between->first->host);
	host_release(between->second->host);
	host_destroy(between->first->host);
	host_destroy(between->second->host);
}

/* A call of the core about two meshes: abacus_volume_between() or abacus_compare(). */
#define between_run(between, function, result) \
	host_check_both((between)->first->host, (between)->second->host, \
					function(&(between)->first->host->table, &(between)->first->header.facts, \
							 &(between)->surface, &(between)->second->host->table, \
							 &(between)->second->header.facts, (between)->other_attribute, \
							 setting_cache_bytes(), result, &(between)->first->host->failure))

static Datum
volume_between(FunctionCallInfo fcinfo, Oid other)
{
	abacus_volume volume;
	Between		between;

	between_open(fcinfo, other, true,
				 "In space, give abacus_volume() a base, the value that divides one mesh.", &between);
	units_tell_volumes(&between.first->header.facts.form);
	between_run(&between, abacus_volume_between, &volume);
	between_close(&between);
	return volume_row(fcinfo, &volume);
}

/*
 * abacus_volume(mesh regclass, other regclass, attribute text, lower float8[],
 *               upper float8[], max_edge float8, other_attribute text,
 *               within text)
 *     -> area, surface, cut, fill, net
 */
Datum
abacus_sql_volume_between(PG_FUNCTION_ARGS)
{
	if (PG_ARGISNULL(OF_MESH) || PG_ARGISNULL(OF_OTHER))
		PG_RETURN_NULL();
	PG_RETURN_DATUM(volume_between(fcinfo, PG_GETARG_OID(OF_OTHER)));
}

/* Whether a text is a number. No name without double quotes begins like one. */
static bool
is_number(const char *text, double *number)
{
	char	   *end;

	text += strspn(text, " \t\n\r\f\v");
	if (*text == '\0' || strchr("0123456789+-.", *text) == NULL)
		return false;
	errno = 0;
	*number = strtod(text, &end);
	return errno == 0 && end != text && end[strspn(end, " \t\n\r\f\v")] == '\0';
}

/*
 * The same with the other mesh's name as text: PostgreSQL takes every quoted argument for that, so
 * it may also be a base.
 */
Datum
abacus_sql_volume_between_named(PG_FUNCTION_ARGS)
{
	char	   *given;
	double		base;
	Datum		other;

	if (PG_ARGISNULL(OF_MESH) || PG_ARGISNULL(OF_OTHER))
		PG_RETURN_NULL();
	given = text_to_cstring(PG_GETARG_TEXT_PP(OF_OTHER));
	if (is_number(given, &base))
	{
		if (!PG_ARGISNULL(OF_OTHER_ATTRIBUTE))
			ereport(ERROR,
					(errcode(ERRCODE_INVALID_PARAMETER_VALUE),
					 errmsg("other_attribute needs another mesh, but %s is a base", given),
					 errhint("Name another mesh, or leave other_attribute out.")));
		PG_RETURN_DATUM(volume_above(fcinfo, base));
	}
	other = DirectFunctionCall1(regclassin, CStringGetDatum(given));
	PG_RETURN_DATUM(volume_between(fcinfo, DatumGetObjectId(other)));
}

static Datum
comparison_row(FunctionCallInfo fcinfo, const abacus_comparison *comparison, uint32 dimension)
{
	Datum		values[COMPARISON_COLUMNS];
	bool		isnull[COMPARISON_COLUMNS] = {false};

	if (!isfinite(comparison->greatest))
		ereport(ERROR,
				(errcode(ERRCODE_NUMERIC_VALUE_OUT_OF_RANGE),
				 errmsg("a difference is out of range for type double precision"),
				 errhint("Give the attributes smaller values, as in other units.")));
	/* means lie between differences, unless the sizes of their parts have no double */
	if (!isfinite(comparison->mean) || !isfinite(comparison->mean_absolute) || !isfinite(comparison->rms))
		ereport(ERROR,
				(errcode(ERRCODE_NUMERIC_VALUE_OUT_OF_RANGE),
				 errmsg("simplices of the two meshes differ too much in size for type double precision"),
				 errhint("Compare meshes, or a window of them, whose simplices are of more similar size.")));
	values[COMPARISON_GREATEST] = Float8GetDatum(comparison->greatest);
	for (uint32 axis = 0; axis < ABACUS_MAX_DIMENSION; axis++)
	{
		values[COMPARISON_PLACE + axis] = Float8GetDatum(comparison->place[axis]);
		isnull[COMPARISON_PLACE + axis] = axis >= dimension;
	}
	values[COMPARISON_MEAN] = Float8GetDatum(comparison->mean);
	values[COMPARISON_MEAN_ABSOLUTE] = Float8GetDatum(comparison->mean_absolute);
	values[COMPARISON_RMS] = Float8GetDatum(comparison->rms);
	if (!comparison->is_any)
		memset(isnull, true, sizeof(isnull));
	return HeapTupleGetDatum(heap_form_tuple(result_row_type(fcinfo), values, isnull));
}

/*
 * abacus_compare(mesh regclass, other regclass, attribute text, lower float8[], upper float8[],
 *                max_edge float8, other_attribute text, within text)
 *     -> greatest, x, y, z, mean, mean_absolute, rms
 */
Datum
abacus_sql_compare(PG_FUNCTION_ARGS)
{
	abacus_comparison comparison;
	Between		between;
	uint32		dimension;

	if (PG_ARGISNULL(OF_MESH) || PG_ARGISNULL(OF_OTHER))
		PG_RETURN_NULL();
	between_open(fcinfo, PG_GETARG_OID(OF_OTHER), false, "Compare two meshes in the plane, or two in space.", &between);
	dimension = between.first->header.facts.form.dimension;
	between_run(&between, abacus_compare, &comparison);
	between_close(&between);
	PG_RETURN_DATUM(comparison_row(fcinfo, &comparison, dimension));
}
