/*
 * geometry.c: geometries of PostGIS made and read as EWKB, by the functions that receive and
 * send its type.
 *
 * A column's type modifier tells its SRID. PostGIS gives it to a geometry without one that it
 * receives for the column.
 */
#include "postgres.h"

#include <float.h>
#include <math.h>

#include "lib/stringinfo.h"
#include "utils/lsyscache.h"

#include "pg/fdw/postgis.h"
#include "pg/port/port.h"

/* Kinds of geometry in WKB, and what EWKB adds to them. */
enum
{
	WKB_POINT = 1,
	WKB_LINE = 2,
	WKB_POLYGON = 3,
	WKB_MULTIPOINT = 4,
	WKB_COLLECTION = 7,
	WKB_POLYHEDRAL_SURFACE = 15,
	WKB_TIN = 16,
	WKB_TRIANGLE = 17
};
#define EWKB_Z 0x80000000U
#define EWKB_M 0x40000000U
#define EWKB_SRID 0x20000000U
#define EWKB_FLAGS (EWKB_Z | EWKB_M | EWKB_SRID)

/* ---- Writing ------------------------------------------------------------- */

/* For a column with this type modifier, in the current memory context. */
GeometryMaker *
geometry_maker(int32 modifier)
{
	GeometryMaker *maker = palloc0(sizeof(GeometryMaker));
	Oid			receive;

	getTypeBinaryInputInfo(postgis_geometry(), &receive, &maker->io_parameter);
	fmgr_info(receive, &maker->receive);
	maker->modifier = modifier;
	initStringInfo(&maker->bytes);
	return maker;
}

static void
put_number(StringInfo bytes, uint32 number)
{
	appendBinaryStringInfo(bytes, (char *) &number, sizeof(number));
}

static void
put_kind(StringInfo bytes, uint32 kind)
{
#ifdef WORDS_BIGENDIAN
	appendStringInfoChar(bytes, 0);
#else
	appendStringInfoChar(bytes, 1);
#endif
	put_number(bytes, kind);
}

static void
put_point(StringInfo bytes, const double *point, int dimension, const double *z)
{
	appendBinaryStringInfo(bytes, (char *) point, dimension * sizeof(double));
	if (z != NULL && dimension == 2)
		appendBinaryStringInfo(bytes, (char *) z, sizeof(double));
}

static Datum
receive(GeometryMaker *maker)
{
	return ReceiveFunctionCall(&maker->receive, &maker->bytes, maker->io_parameter,
							   maker->modifier);
}

/* POINT, or POINT Z; z may be NULL. */
Datum
geometry_of_point(GeometryMaker *maker, const double *point, int dimension, const double *z)
{
	resetStringInfo(&maker->bytes);
	put_kind(&maker->bytes, WKB_POINT | (dimension == 3 || z != NULL ? EWKB_Z : 0));
	put_point(&maker->bytes, point, dimension, z);
	return receive(maker);
}

/* A polygon of three corners; z may be NULL. */
static void
put_triangle(StringInfo bytes, double corners[][ABACUS_MAX_DIMENSION], const int *order,
			 int dimension, const double *z)
{
	put_kind(bytes, WKB_POLYGON | (dimension == 3 || z != NULL ? EWKB_Z : 0));
	put_number(bytes, 1);
	put_number(bytes, 4);
	for (int i = 0; i < 4; i++)
	{
		int			corner = order[i % 3];

		put_point(bytes, corners[corner], dimension, z == NULL ? NULL : &z[corner]);
	}
}

/*
 * A triangle: POLYGON, or POLYGON Z. A tetrahedron: POLYHEDRALSURFACE Z, its facets
 * counterclockwise seen from outside.
 */
Datum
geometry_of_cell(GeometryMaker *maker, double corners[][ABACUS_MAX_DIMENSION], int dimension,
				 const double *z)
{
	static const int facets[4][3] = {{0, 2, 1}, {0, 1, 3}, {1, 2, 3}, {0, 3, 2}};

	resetStringInfo(&maker->bytes);
	if (dimension == 2)
		put_triangle(&maker->bytes, corners, (int[]) {0, 1, 2}, dimension, z);
	else
	{
		put_kind(&maker->bytes, WKB_POLYHEDRAL_SURFACE | EWKB_Z);
		put_number(&maker->bytes, lengthof(facets));
		for (int i = 0; i < lengthof(facets); i++)
			put_triangle(&maker->bytes, corners, facets[i], dimension, NULL);
	}
	return receive(maker);
}

/* ---- Reading ------------------------------------------------------------- */

typedef struct Extent
{
	const unsigned char *at;
	const unsigned char *end;
	bool		swap;			/* bytes are in the other order */
	bool		is_known;
	double		lower[2];
	double		upper[2];
} Extent;

static void
take(Extent *extent, void *value, size_t size)
{
	unsigned char *bytes = value;

	memset(value, 0, size);
	if ((size_t) (extent->end - extent->at) < size)
	{
		extent->is_known = false;
		extent->at = extent->end;
		return;
	}
	for (size_t i = 0; i < size; i++)
		bytes[i] = extent->at[extent->swap ? size - 1 - i : i];
	extent->at += size;
}

static uint32
take_number(Extent *extent)
{
	uint32		number;

	take(extent, &number, sizeof(number));
	return number;
}

static void
take_points(Extent *extent, uint32 count, int ordinates)
{
	for (uint32 i = 0; i < count && extent->is_known; i++)
	{
		double		point[4];
		bool		is_empty;

		for (int k = 0; k < ordinates; k++)
			take(extent, &point[k], sizeof(double));
		is_empty = isnan(point[0]) && isnan(point[1]);
		for (int k = 0; k < 2 && !is_empty; k++)
		{
			if (isnan(point[k]))
				extent->is_known = false;
			extent->lower[k] = Min(extent->lower[k], point[k]);
			extent->upper[k] = Max(extent->upper[k], point[k]);
		}
	}
}

/* One geometry with all that is in it. */
static void
take_geometry(Extent *extent)
{
	uint8		order;
	uint32		kind;
	int			ordinates;

	check_stack_depth();
	take(extent, &order, 1);
#ifdef WORDS_BIGENDIAN
	extent->swap = order == 1;
#else
	extent->swap = order == 0;
#endif
	kind = take_number(extent);
	ordinates = 2 + ((kind & EWKB_Z) != 0) + ((kind & EWKB_M) != 0);
	if ((kind & EWKB_SRID) != 0)
		(void) take_number(extent);
	kind &= ~EWKB_FLAGS;
	if (kind == WKB_POINT)
		take_points(extent, 1, ordinates);
	else if (kind == WKB_LINE)
		take_points(extent, take_number(extent), ordinates);
	else if (kind == WKB_POLYGON || kind == WKB_TRIANGLE)
	{
		for (uint32 rings = take_number(extent); rings > 0 && extent->is_known; rings--)
			take_points(extent, take_number(extent), ordinates);
	}
	else if ((kind >= WKB_MULTIPOINT && kind <= WKB_COLLECTION) ||
			 kind == WKB_POLYHEDRAL_SURFACE || kind == WKB_TIN)
	{
		for (uint32 parts = take_number(extent); parts > 0 && extent->is_known; parts--)
			take_geometry(extent);
	}
	else
		extent->is_known = false;	/* an arc leaves the box of its points */
}

/* The box of a geometry in the plane. */
GeometryBox
geometry_box(Datum geometry, double *lower, double *upper)
{
	Extent		extent = {.is_known = true};
	Oid			send;
	bool		is_varlena;
	bytea	   *bytes;

	getTypeBinaryOutputInfo(postgis_geometry(), &send, &is_varlena);
	bytes = OidSendFunctionCall(send, geometry);
	extent.at = (unsigned char *) VARDATA_ANY(bytes);
	extent.end = extent.at + VARSIZE_ANY_EXHDR(bytes);
	for (int k = 0; k < 2; k++)
	{
		extent.lower[k] = INFINITY;
		extent.upper[k] = -INFINITY;
	}
	take_geometry(&extent);
	if (!extent.is_known)
		return GEOMETRY_ANYWHERE;
	if (!(extent.lower[0] <= extent.upper[0]))
		return GEOMETRY_NOWHERE;
	for (int k = 0; k < 2; k++)
	{
		lower[k] = Max(extent.lower[k], -DBL_MAX);
		upper[k] = Min(extent.upper[k], DBL_MAX);
	}
	return GEOMETRY_IN_BOX;
}

static double
single_beyond(double x, float direction)
{
	float		single = (float) x;

	if (isinf(single))
		single = copysignf(FLT_MAX, single);
	return Max(-DBL_MAX, Min(DBL_MAX, nextafterf(nextafterf(single, direction), direction)));
}

/*
 * Operators of PostGIS compare boxes that are rounded outward to single precision, both of
 * them. A box that meets another one then meets this one as it is.
 */
void
geometry_box_outward(double *lower, double *upper)
{
	for (int k = 0; k < 2; k++)
	{
		lower[k] = single_beyond(lower[k], -INFINITY);
		upper[k] = single_beyond(upper[k], INFINITY);
	}
}
