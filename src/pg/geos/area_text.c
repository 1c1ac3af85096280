/*
 * area_text.c: polygons as text: WKT, EWKT, or WKB and EWKB in hexadecimal digits, as PostGIS writes
 * geometries.
 *
 * GEOS reads them and says whether they are valid. It allocates memory of its own, so what it holds
 * is freed whatever happens.
 */
#include "postgres.h"

#include <geos_c.h>

#include "miscadmin.h"

#include "pg/base/text_begin.h"
#include "pg/port/port.h"
#include "pg/geos/area_text.h"
#include "pg/geos/geometry_text.h"
#include "pg/geos/geos.h"

/* Whether a text is a geometry, and no name. */
bool
area_text_is(const char *text)
{
	return geometry_text(text) != NO_GEOMETRY;
}

/* `what` names the argument. */
pg_noreturn static void
refuse(const char *what, const char *detail, const char *hint)
{
	CHECK_FOR_INTERRUPTS();		/* which also stop GEOS */
	ereport(ERROR,
			(errcode(ERRCODE_INVALID_PARAMETER_VALUE),
			 errmsg("%s is not a polygon that can be used", what),
			 errdetail_internal("%s", detail),
			 errhint("%s", hint)));
}

static void
require_valid(Geos *geos, const char *what, GEOSGeometry *geometry)
{
	int			magnitude = geos_magnitude(geos, geometry);
	bool		is_scaled = abs(magnitude) > GEOS_MAGNITUDE;

	if (is_scaled)
		geometry = geos_times(geos, geometry, -magnitude);
	if (GEOSisValid_r(geos->handle, geometry) != 1)
	{
		char	   *reason = GEOSisValidReason_r(geos->handle, geometry);
		char	   *detail = reason == NULL ? geos_message(geos) : pstrdup(reason);

		GEOSFree_r(geos->handle, reason);
		if (is_scaled && strchr(detail, '[') != NULL)
			*strchr(detail, '[') = '\0';	/* a place at another scale */
		refuse(what, detail, "Make it valid with ST_MakeValid.");
	}
}

static void
add_ring(Geos *geos, const GEOSGeometry *ring, AreaText *area, size_t *at)
{
	const GEOSCoordSequence *points = GEOSGeom_getCoordSeq_r(geos->handle, ring);
	unsigned	count = 0;

	geos_require(geos, points != NULL && GEOSCoordSeq_getSize_r(geos->handle, points, &count) == 1);
	if (count == 0)
		return;
	geos_require(geos, GEOSCoordSeq_copyToBuffer_r(geos->handle, points, area->points + 2 * *at, 0, 0) == 1);
	area->sizes[area->rings++] = count;
	*at += count;
}

/* Copies all rings. */
static void
take_rings(Geos *geos, const GEOSGeometry *geometry, AreaText *area)
{
	int			parts = GEOSGetNumGeometries_r(geos->handle, geometry);
	int			points = GEOSGetNumCoordinates_r(geos->handle, geometry);
	size_t		rings = 0,
				at = 0;

	geos_require(geos, parts >= 0 && points >= 0);
	for (int i = 0; i < parts; i++)
		rings += 1 + GEOSGetNumInteriorRings_r(geos->handle, GEOSGetGeometryN_r(geos->handle, geometry, i));
	area->rings = 0;
	area->sizes = palloc((rings + 1) * sizeof(size_t));
	area->points = MemoryContextAllocHuge(CurrentMemoryContext, ((size_t) points + 1) * 2 * sizeof(double));
	for (int i = 0; i < parts; i++)
	{
		const GEOSGeometry *part = GEOSGetGeometryN_r(geos->handle, geometry, i);
		int			holes = GEOSGetNumInteriorRings_r(geos->handle, part);

		if (GEOSisEmpty_r(geos->handle, part) == 1)
			continue;
		add_ring(geos, GEOSGetExteriorRing_r(geos->handle, part), area, &at);
		for (int k = 0; k < holes; k++)
			add_ring(geos, GEOSGetInteriorRingN_r(geos->handle, part, k), area, &at);
	}
}

/* The geometry of a text for which area_text_is() holds; an error, which names `what`, if it cannot be read. */
GEOSGeometry *
area_text_geometry(Geos *geos, const char *what, const char *text)
{
	const char *whole = text;
	const char *other = geometry_text_other(whole);
	const char *excess;
	int32		srid;
	GEOSGeometry *geometry;

	if (other != NULL)
		refuse(what, psprintf("It is a %s.", other), strstr(other, "Curve") != NULL
			   ? "Make it a polygon with ST_CurveToLine."
			   : "Give the name of a region, a Polygon or a MultiPolygon.");
	text = geometry_text_behind_srid(whole, &srid);
	if (geometry_text(whole) == GEOMETRY_WKT && (strcasestr(text, "nan") != NULL || strcasestr(text, "inf") != NULL))
		refuse(what, "A coordinate is not a finite number.", "Give finite coordinates.");
	excess = geometry_text_excess(whole);
	if (*excess != '\0')			/* which not all versions of GEOS find */
		refuse(what, psprintf("It ends before \"%s\".", text_begin(excess)), "Give several polygons as one MultiPolygon.");
	geometry = geometry_text(whole) == GEOMETRY_HEX ? geos_read_hex(geos, text) : geos_read_text(geos, text);
	if (geometry == NULL)
		refuse(what, geos_message(geos), "Give the name of a region, or a polygon as WKT, EWKT or hexadecimal EWKB.");
	if (srid != 0)
		GEOSSetSRID_r(geos->handle, geometry, srid);
	return geometry;
}

/* A text for which area_text_is() holds; an error unless it is a valid polygon. */
AreaText
area_text_read(const char *what, const char *text)
{
	AreaText	area = {0};
	Geos		geos;

	geos_begin(&geos);
	PG_TRY();
	{
		GEOSGeometry *geometry = area_text_geometry(&geos, what, text);

		area.srid = GEOSGetSRID_r(geos.handle, geometry);
		require_valid(&geos, what, geometry);
		take_rings(&geos, geometry, &area);
	}
	PG_FINALLY();
	{
		geos_end(&geos);
	}
	PG_END_TRY();
	return area;
}
