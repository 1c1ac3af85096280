/*
 * clipped_rings.c: rings of areas, cut at the border of a polygon, by GEOS.
 *
 * What an odd number of the rings goes around is one side, the polygon the other. Places where
 * borders cross are rounded; points of either border keep their coordinates.
 *
 * GEOS gets coordinates too great or too small for it times a power of two, so that its results are the
 * same as at an ordinary scale.
 */
#include "postgres.h"

#include <math.h>

#include "utils/memutils.h"

#include "pg/geos/area_text.h"
#include "pg/geos/geos.h"
#include "pg/geos/clipped_rings.h"

/* ---- Sets of rings ------------------------------------------------------------------------ */

/* An empty set in the current memory. */
void
ring_set_begin(RingSet *set)
{
	memset(set, 0, sizeof(RingSet));
	set->memory = CurrentMemoryContext;
}

/* At least this many elements; `room` is how many there are. */
static void *
with_room(MemoryContext memory, void *array, size_t *room, size_t wanted, size_t size)
{
	if (wanted <= *room)
		return array;
	*room = wanted + *room / 2 + 64;
	return array == NULL ? MemoryContextAllocHuge(memory, *room * size) : repalloc_huge(array, *room * size);
}

/* Adds a ring of so many points, and returns their place. */
double *
ring_set_add(RingSet *set, size_t points)
{
	double	   *added;

	set->sizes = with_room(set->memory, set->sizes, &set->ring_room, set->rings + 1, sizeof(size_t));
	set->places = with_room(set->memory, set->places, &set->point_room, set->points + points, 2 * sizeof(double));
	added = set->places + 2 * set->points;
	set->sizes[set->rings++] = points;
	set->points += points;
	return added;
}

void
ring_set_clear(RingSet *set)
{
	set->rings = set->points = 0;
}

void
ring_set_swap(RingSet *a, RingSet *b)
{
	RingSet		swapped = *a;

	*a = *b;
	*b = swapped;
}

void
ring_set_end(RingSet *set)
{
	if (set->sizes != NULL)
		pfree(set->sizes);
	if (set->places != NULL)
		pfree(set->places);
	ring_set_begin(set);
}

/* ---- Cutting them ------------------------------------------------------------------------- */

static GEOSGeometry *
line_of(Geos *geos, const double *places, size_t points)
{
	GEOSCoordSequence *sequence = GEOSCoordSeq_copyFromBuffer_r(geos->handle, places, (unsigned) points, 0, 0);

	geos_require(geos, sequence != NULL);
	return GEOSGeom_createLineString_r(geos->handle, sequence);
}

/* The area that an odd number of rings goes around, times a power of two. */
static GEOSGeometry *
area_of(Geos *geos, const RingSet *set, int exponent)
{
	GEOSGeometry **lines = MemoryContextAllocHuge(CurrentMemoryContext, (set->rings + 1) * sizeof(GEOSGeometry *));
	const double *places = set->places;
	size_t		made = 0;
	GEOSGeometry *all;

	for (; made < set->rings; made++)
	{
		lines[made] = line_of(geos, places, set->sizes[made]);
		if (lines[made] == NULL)
			break;
		places += 2 * set->sizes[made];
	}
	if (made < set->rings)
	{
		while (made > 0)
			GEOSGeom_destroy_r(geos->handle, lines[--made]);
		geos_require(geos, false);
	}
	all = geos_keep(geos, GEOSGeom_createCollection_r(geos->handle, GEOS_MULTILINESTRING, lines, (unsigned) made));
	geos_require(geos, all != NULL);
	pfree(lines);
	all = geos_keep(geos, GEOSBuildArea_r(geos->handle, geos_times(geos, all, exponent)));
	geos_require(geos, all != NULL);
	return all;
}

/* Adds a ring in the other direction: GEOS goes clockwise around an area, and we do not. */
static void
add_turned(Geos *geos, const GEOSGeometry *ring, RingSet *set)
{
	const GEOSCoordSequence *points = GEOSGeom_getCoordSeq_r(geos->handle, ring);
	unsigned	count = 0;
	double	   *added;

	geos_require(geos, points != NULL && GEOSCoordSeq_getSize_r(geos->handle, points, &count) == 1);
	added = ring_set_add(set, count);
	geos_require(geos, GEOSCoordSeq_copyToBuffer_r(geos->handle, points, added, 0, 0) == 1);
	for (unsigned i = 0, k = count - 1; i < k; i++, k--)
		for (int axis = 0; axis < 2; axis++)
		{
			double		swapped = added[2 * i + axis];

			added[2 * i + axis] = added[2 * k + axis];
			added[2 * k + axis] = swapped;
		}
}

/* Adds the rings of all polygons; points and lines where areas only touch are left out. */
static void
add_polygons(Geos *geos, const GEOSGeometry *geometry, RingSet *set)
{
	int			parts = GEOSGetNumGeometries_r(geos->handle, geometry);

	geos_require(geos, parts >= 0);
	for (int i = 0; i < parts; i++)
	{
		const GEOSGeometry *part = GEOSGetGeometryN_r(geos->handle, geometry, i);
		int			holes;

		if (GEOSGeomTypeId_r(geos->handle, part) != GEOS_POLYGON || GEOSisEmpty_r(geos->handle, part) == 1)
			continue;
		add_turned(geos, GEOSGetExteriorRing_r(geos->handle, part), set);
		holes = GEOSGetNumInteriorRings_r(geos->handle, part);
		for (int k = 0; k < holes; k++)
			add_turned(geos, GEOSGetInteriorRingN_r(geos->handle, part, k), set);
	}
}

/* The exponent of the greatest coordinate. */
static int
magnitude_of(const RingSet *set)
{
	double		greatest = 0;

	for (size_t i = 0; i < 2 * set->points; i++)
		greatest = Max(greatest, fabs(set->places[i]));
	return greatest > 0 ? ilogb(greatest) : 0;
}

/*
 * The power of two by which rings and a polygon of these magnitudes are multiplied, so that both are far from
 * what GEOS cannot compute with; 0 for ordinary ones.
 */
static int
common_scale(int rings, int polygon)
{
	if (Max(abs(rings), abs(polygon)) <= GEOS_MAGNITUDE)
		return 0;
	if (abs(rings - polygon) > 2 * GEOS_MAGNITUDE)
		ereport(ERROR,
				(errcode(ERRCODE_NUMERIC_VALUE_OUT_OF_RANGE),
				 errmsg("the coordinates of a polygon and of the mesh differ too much"),
				 errdetail("The greatest ones are about 2^%d and 2^%d.", polygon, rings),
				 errhint("Give a polygon whose greatest coordinate is from 1e-180 to 1e180 times that of the mesh.")));
	return -(rings + polygon) / 2;
}

/*
 * Sets `clipped` to the rings of what is in the polygon, a text for which area_text_is() holds:
 * counterclockwise around what is inside, clockwise around a hole, from their least points on.
 */
void
clip_rings(const RingSet *given, const char *polygon, RingSet *clipped)
{
	Geos		geos;

	ring_set_clear(clipped);
	if (given->rings == 0)
		return;
	geos_begin(&geos);
	PG_TRY();
	{
		GEOSGeometry *cutter = area_text_geometry(&geos, "within", polygon);
		bool		is_empty = GEOSisEmpty_r(geos.handle, cutter) == 1;
		int			exponent = is_empty ? 0 : common_scale(magnitude_of(given), geos_magnitude(&geos, cutter));
		GEOSGeometry *common = geos_keep(&geos, GEOSIntersection_r(geos.handle, area_of(&geos, given, exponent),
																   geos_times(&geos, cutter, exponent)));

		geos_require(&geos, common != NULL && GEOSNormalize_r(geos.handle, common) == 0);
		add_polygons(&geos, common, clipped);
		for (size_t i = 0; i < 2 * clipped->points && exponent != 0; i++)
			clipped->places[i] = scalbn(clipped->places[i], -exponent);
	}
	PG_FINALLY();
	{
		geos_end(&geos);
	}
	PG_END_TRY();
}
