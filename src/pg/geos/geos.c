/*
 * geos.c: GEOS: its errors, its memory, and cancelling it.
 */
#include "postgres.h"

#include <math.h>

#include "miscadmin.h"

#include "pg/geos/geos.h"

static void
keep_message(const char *message, void *context)
{
	Geos	   *geos = context;

	strlcpy(geos->message, message, sizeof(geos->message));
}

/* Called by GEOS while it works. */
static void
stop_when_cancelled(void)
{
	if (InterruptPending && (QueryCancelPending || ProcDiePending))
		GEOS_interruptRequest();
}

void
geos_begin(Geos *geos)
{
	memset(geos, 0, sizeof(Geos));
	geos->handle = GEOS_init_r();
	if (geos->handle == NULL)
		ereport(ERROR, (errcode(ERRCODE_OUT_OF_MEMORY), errmsg("out of memory")));
	GEOSContext_setErrorMessageHandler_r(geos->handle, keep_message, geos);
	geos->interrupt = GEOS_interruptRegisterCallback(stop_when_cancelled);
}

void
geos_end(Geos *geos)
{
	GEOS_interruptRegisterCallback(geos->interrupt);
	GEOS_interruptCancel();
	while (geos->count > 0)
		GEOSGeom_destroy_r(geos->handle, geos->kept[--geos->count]);
	GEOS_finish_r(geos->handle);
}

/* Frees the geometry with the handle; NULL stays NULL. */
GEOSGeometry *
geos_keep(Geos *geos, GEOSGeometry *geometry)
{
	if (geometry == NULL)
		return NULL;
	if (geos->count == GEOS_KEPT)
	{
		GEOSGeom_destroy_r(geos->handle, geometry);
		elog(ERROR, "too many geometries are kept");
	}
	geos->kept[geos->count++] = geometry;
	return geometry;
}

/* NULL if it cannot be read. */
GEOSGeometry *
geos_read_text(Geos *geos, const char *text)
{
	GEOSWKTReader *reader = GEOSWKTReader_create_r(geos->handle);
	GEOSGeometry *geometry = reader == NULL ? NULL : GEOSWKTReader_read_r(geos->handle, reader, text);

	if (reader != NULL)
		GEOSWKTReader_destroy_r(geos->handle, reader);
	return geos_keep(geos, geometry);
}

/* NULL if it cannot be read. */
GEOSGeometry *
geos_read_hex(Geos *geos, const char *text)
{
	GEOSWKBReader *reader = GEOSWKBReader_create_r(geos->handle);
	GEOSGeometry *geometry = reader == NULL ? NULL
		: GEOSWKBReader_readHEX_r(geos->handle, reader, (const unsigned char *) text, strlen(text));

	if (reader != NULL)
		GEOSWKBReader_destroy_r(geos->handle, reader);
	return geos_keep(geos, geometry);
}

/* The exponent of the greatest coordinate; 0 if there is none. */
int
geos_magnitude(Geos *geos, const GEOSGeometry *geometry)
{
	double		ends[4];
	double		greatest = 0;

	if (GEOSisEmpty_r(geos->handle, geometry) == 1)
		return 0;
	geos_require(geos, GEOSGeom_getExtent_r(geos->handle, geometry, &ends[0], &ends[1], &ends[2], &ends[3]) == 1);
	for (int i = 0; i < 4; i++)
		greatest = Max(greatest, fabs(ends[i]));
	return greatest > 0 ? ilogb(greatest) : 0;
}

static int
scale(double *x, double *y, void *exponent)
{
	*x = scalbn(*x, *(int *) exponent);
	*y = scalbn(*y, *(int *) exponent);
	return 1;
}

/* The geometry times a power of two; itself for exponent 0. */
GEOSGeometry *
geos_times(Geos *geos, GEOSGeometry *geometry, int exponent)
{
	if (exponent == 0)
		return geometry;
	geometry = geos_keep(geos, GEOSGeom_transformXY_r(geos->handle, geometry, scale, &exponent));
	geos_require(geos, geometry != NULL);
	return geometry;
}

/* A copy of its last error. */
char *
geos_message(const Geos *geos)
{
	return pstrdup(geos->message[0] == '\0' ? "GEOS gives no reason." : geos->message);
}

/* An error of GEOS, unless it was stopped, or succeeded. */
void
geos_require(const Geos *geos, bool holds)
{
	if (holds)
		return;
	CHECK_FOR_INTERRUPTS();
	ereport(ERROR,
			(errcode(ERRCODE_INTERNAL_ERROR),
			 errmsg("GEOS failed"),
			 errdetail_internal("%s", geos_message(geos))));
}
