/*
 * fn_volume.c: abacus_volume, areas and volumes over a base or between two meshes.
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
require_plane(const Reader *reader)
{
	if (reader->header.facts.form.dimension != 2)
		ereport(ERROR,
				(errcode(ERRCODE_INVALID_PARAMETER_VALUE),
				 errmsg("mesh \"%s\" has dimension %u, not 2",
						get_rel_name(mesh_pages(reader->host)->mesh), reader->header.facts.form.dimension),
				 errhint("In space, give abacus_volume() a base, the value that divides one mesh.")));
}

static Datum
volume_between(FunctionCallInfo fcinfo, Oid other)
{
	abacus_surface surface = {0};
	abacus_volume volume;
	Reader	   *first = reader_open(PG_GETARG_OID(OF_MESH), CurrentMemoryContext);
	Reader	   *second = reader_open(other, CurrentMemoryContext);
	uint32		other_attribute;
	int			other_name = PG_ARGISNULL(OF_OTHER_ATTRIBUTE) ? OF_ATTRIBUTE : OF_OTHER_ATTRIBUTE;

	require_plane(first);
	require_plane(second);
	surface_arguments(fcinfo, first, &surface);
	units_tell_volumes(&first->header.facts.form);
	other_attribute = attribute(fcinfo, other_name, abacus_names_of(&second->header));
	progress_begin(&first->host->progress, PG_GETARG_OID(OF_MESH));
	host_check_both(first->host, second->host,
					abacus_volume_between(&first->host->table, &first->header.facts, &surface,
										  &second->host->table, &second->header.facts,
										  other_attribute, setting_cache_bytes(), &volume,
										  &first->host->failure));
	progress_end(&first->host->progress);
	host_release(first->host);
	host_release(second->host);
	host_destroy(first->host);
	host_destroy(second->host);
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
