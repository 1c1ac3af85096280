/*
 * fn_drape.c: abacus_drape of the extension abacus_postgis, which lays lines and polygons over a
 * terrain; and the parts of a triangle for abacus_clip, laid over this triangle.
 *
 * The bytes of a geometry are read and written again, with a z after the coordinates of each place:
 * the attribute, which is linear in each triangle. Between two places of a line the surface bends
 * where the line crosses an edge, so with `densify` there is a place at each crossing, as in a
 * profile. If there is no value, z is NaN, which is how PostGIS stores an unknown z.
 *
 * Where PostGIS cuts a triangle, it rounds, so a place of a part may lie beside the triangle, even
 * beside the mesh. Its z is that of the triangle's plane, and within the values of the corners.
 */
#include "postgres.h"

#include <math.h>

#include "miscadmin.h"

#include "abacus/lines.h"
#include "abacus/values.h"
#include "pg/base/sql_function.h"
#include "pg/host/guard.h"
#include "pg/mesh/mesh_cache.h"
#include "pg/postgis/geometry_errors.h"
#include "pg/postgis/geometry_write.h"
#include "pg/sql/arguments/extent_arguments.h"
#include "pg/sql/arguments/interpolation.h"
#include "pg/sql/arguments/word.h"
#include "pg/sql/postgis/geometry_place.h"

SQL_FUNCTION(abacus_sql_drape);
SQL_FUNCTION(abacus_sql_cell_part);

/* Arguments */
enum
{
	DRAPE_MESH,
	DRAPE_GEOMETRY,
	DRAPE_ATTRIBUTE,
	DRAPE_DENSIFY,
	DRAPE_OUTSIDE,
	DRAPE_MAX_EDGE,
	DRAPE_WITHIN
};

/* A place: x, y, z, m */
typedef struct Place
{
	double		at[GEOMETRY_COORDINATES];
} Place;

typedef struct Drape
{
	CachedMesh *mesh;			/* the surface; if it is NULL, the triangle below is */
	const double *corners;
	double		values[3];
	abacus_interpolation how;
	bool		densifies;
	GeometryBytes in;
	StringInfoData out;
	bool		has_m;			/* of the geometry being read */
	size_t		places;			/* written so far, of one line */
	Place		from;			/* the ends of a piece of the line */
	Place		to;
	bool		has_last;		/* a place between them waits to be written */
	Place		last;
} Drape;

static Place
read_place(Drape *drape, const GeometryHead *head)
{
	Place		place;

	geometry_coordinates(&drape->in, head, place.at);
	place.at[2] = NAN;
	return place;
}

/* Sets z over a mesh. */
static void
lift_over_mesh(const Drape *drape, Place *place)
{
	CachedMesh *mesh = drape->mesh;
	double		value = NAN;

	if (!isfinite(place->at[0]) || !isfinite(place->at[1]))
		geometry_refuse_coordinate("the geometry");
	if (host_run(mesh->host, abacus_mesh_interpolate, mesh->mesh, &drape->how, place->at, &value) == ABACUS_END)
		value = NAN;
	host_release(mesh->host);
	place->at[2] = value;
}

/* Sets z over a triangle. */
static void
lift_over_triangle(const Drape *drape, Place *place)
{
	const double *a = drape->corners;
	const double *values = drape->values;
	double		b[2] = {a[2] - a[0], a[3] - a[1]};
	double		c[2] = {a[4] - a[0], a[5] - a[1]};
	double		p[2] = {place->at[0] - a[0], place->at[1] - a[1]};
	double		area = b[0] * c[1] - c[0] * b[1];
	double		least = fmin(values[0], fmin(values[1], values[2]));
	double		greatest = fmax(values[0], fmax(values[1], values[2]));
	double		value;

	for (int i = 0; i < 3; i++)
		if (place->at[0] == a[2 * i] && place->at[1] == a[2 * i + 1])
		{
			place->at[2] = values[i];
			return;
		}
	value = values[0] + (p[0] * c[1] - c[0] * p[1]) / area * (values[1] - values[0]) +
		(b[0] * p[1] - p[0] * b[1]) / area * (values[2] - values[0]);
	place->at[2] = fmin(fmax(value, least), greatest);	/* never NaN, however flat the triangle is */
}

/* Sets z. */
static void
lift(const Drape *drape, Place *place)
{
	CHECK_FOR_INTERRUPTS();
	if (drape->mesh != NULL)
		lift_over_mesh(drape, place);
	else
		lift_over_triangle(drape, place);
}

static void
put_place(Drape *drape, const Place *place)
{
	geometry_put_numbers(&drape->out, place->at, 3 + drape->has_m);
	drape->places++;
}

static bool
same_place(const double *a, const double *b)
{
	return a[0] == b[0] && a[1] == b[1];
}

static void
put_last(Drape *drape)
{
	if (drape->has_last)
		put_place(drape, &drape->last);
	drape->has_last = false;
}

/* A distance as a share of the way from one end of the piece to the other. */
static double
share_of(const Drape *drape, double distance)
{
	double		length = hypot(drape->to.at[0] - drape->from.at[0], drape->to.at[1] - drape->from.at[1]);

	return length > 0 ? Min(distance / length, 1) : 0;
}

/*
 * Adds a place where a piece of a line crosses an edge; called by the core. If the line leaves the
 * mesh or comes back, there are two, one of them without a value.
 */
static abacus_host_status
cross(void *context, double distance, const double *at, double value)
{
	Drape	   *drape = context;

	if (same_place(at, drape->from.at) || same_place(at, drape->to.at))
		return ABACUS_HOST_OK;
	GUARD_BEGIN();
	if (drape->has_last && same_place(at, drape->last.at))
	{
		if (isnan(drape->last.at[2]))
			drape->last.at[2] = value;
	}
	else
	{
		put_last(drape);
		drape->has_last = true;
		drape->last = (Place) {{at[0], at[1], value,
			drape->from.at[3] + (drape->to.at[3] - drape->from.at[3]) * share_of(drape, distance)}};
	}
	GUARD_END(drape->mesh->host);
	return ABACUS_HOST_OK;
}

/* Adds the places between the two ends. */
static void
put_crossings(Drape *drape)
{
	CachedMesh *mesh = drape->mesh;
	double		path[] = {drape->from.at[0], drape->from.at[1], drape->to.at[0], drape->to.at[1]};

	if (same_place(path, path + 2))
		return;
	drape->has_last = false;
	host_run(mesh->host, abacus_mesh_profile, mesh->mesh, drape->how.attribute[0],
			 &drape->how.extent, path, 2, cross, drape);
	host_release(mesh->host);
	put_last(drape);
}

/* A line or a ring: the number of its places, and the places. */
static void
drape_line(Drape *drape, const GeometryHead *head)
{
	uint32		count = geometry_count(&drape->in);
	int			at = drape->out.len;
	uint32		written;

	geometry_put_count(&drape->out, 0);
	drape->places = 0;
	for (uint32 i = 0; i < count; i++)
	{
		drape->to = read_place(drape, head);
		lift(drape, &drape->to);
		if (drape->densifies && i > 0)
			put_crossings(drape);
		put_place(drape, &drape->to);
		drape->from = drape->to;
	}
	written = (uint32) drape->places;
	memcpy(drape->out.data + at, &written, sizeof(written));
}

static void
drape_point(Drape *drape, const GeometryHead *head)
{
	Place		place = read_place(drape, head);

	if (!geometry_is_nowhere(place.at))
		lift(drape, &place);
	put_place(drape, &place);
}

/* A geometry with everything inside it. */
static void
drape_geometry(Drape *drape, bool inside)
{
	GeometryHead head = geometry_head(&drape->in);
	GeometryHead lifted = head;
	uint32		count;

	check_stack_depth();
	if (head.kind < GEOMETRY_POINT || head.kind > GEOMETRY_COLLECTION)
		geometry_refuse_kind("the geometry", head.kind, "made of points, lines or polygons");
	if (!inside && drape->mesh != NULL)
		geometry_check_srid(&drape->mesh->header.facts.form, head.srid);
	lifted.has_z = true;
	drape->has_m = head.has_m;
	geometry_put_head(&drape->out, &lifted);
	if (head.kind == GEOMETRY_POINT)
		drape_point(drape, &head);
	else if (head.kind == GEOMETRY_LINE)
		drape_line(drape, &head);
	else
	{
		count = geometry_count(&drape->in);
		geometry_put_count(&drape->out, count);
		for (uint32 i = 0; i < count; i++)
			if (head.kind == GEOMETRY_POLYGON)
				drape_line(drape, &head);
			else
				drape_geometry(drape, true);
	}
}

/*
 * abacus_drape(mesh regclass, geometry geometry, attribute text, densify boolean, outside text,
 *              max_edge float8, within text)
 *     -> geometry
 */
Datum
abacus_sql_drape(PG_FUNCTION_ARGS)
{
	static const char *const outsides[] = {"null", "nearest", NULL};
	const GeometryType *type = geometry_argument_type(fcinfo, DRAPE_GEOMETRY);
	Drape		drape = {.how = {.method = ABACUS_LINEAR}};

	if (interpolation_of_null(fcinfo, DRAPE_GEOMETRY))
		PG_RETURN_NULL();
	drape.mesh = mesh_cache_get(PG_GETARG_OID(DRAPE_MESH));
	header_require_dimension(&drape.mesh->header.facts.form, 2,
							 "Use a terrain: a mesh in the plane with the height as an attribute.");
	interpolation_attribute(fcinfo, DRAPE_ATTRIBUTE, abacus_names_of(&drape.mesh->header), &drape.how);
	drape.how.outside = word_argument(fcinfo, DRAPE_OUTSIDE, outsides, "outside",
									  "Use null, or nearest for the value of the nearest vertex.");
	extent_arguments(fcinfo, DRAPE_MAX_EDGE, DRAPE_WITHIN, PG_GETARG_OID(DRAPE_MESH), &drape.mesh->header, NULL,
					 &drape.how.extent);
	drape.densifies = !PG_ARGISNULL(DRAPE_DENSIFY) && PG_GETARG_BOOL(DRAPE_DENSIFY);
	drape.in = geometry_bytes(type, PG_GETARG_DATUM(DRAPE_GEOMETRY));
	initStringInfo(&drape.out);
	drape_geometry(&drape, false);
	PG_RETURN_DATUM(geometry_made(type, &drape.out));
}

/* _abacus_part(part geometry, corners float8[], values float8[], attribute int) -> geometry */
Datum
abacus_sql_cell_part(PG_FUNCTION_ARGS)
{
	const GeometryType *type = geometry_argument_type(fcinfo, 0);
	Drape		drape = {.mesh = NULL};
	size_t		count;

	drape.corners = geometry_numbers(PG_GETARG_ARRAYTYPE_P(1), 6, &count);
	if (!geometry_corner_values(PG_GETARG_ARRAYTYPE_P(2), PG_GETARG_INT32(3), drape.values))
		PG_RETURN_NULL();
	drape.in = geometry_bytes(type, PG_GETARG_DATUM(0));
	initStringInfo(&drape.out);
	drape_geometry(&drape, false);
	PG_RETURN_DATUM(geometry_made(type, &drape.out));
}
