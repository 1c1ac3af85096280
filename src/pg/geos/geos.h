/*
 * geos.h: GEOS, which reads geometries and cuts them.
 *
 * GEOS never jumps, and must not be jumped over: between geos_begin() and geos_end() errors are
 * raised within PG_TRY. What it makes is kept by the handle until geos_end().
 */
#ifndef ABACUS_GEOS_H
#define ABACUS_GEOS_H

#include <geos_c.h>

#define GEOS_KEPT 8

/*
 * The products that GEOS makes of coordinates overflow or underflow silently where the greatest one is
 * beyond 2^±GEOS_MAGNITUDE.
 */
#define GEOS_MAGNITUDE 300

typedef struct Geos
{
	GEOSContextHandle_t handle;
	char		message[256];	/* of its last error */
	GEOSGeometry *kept[GEOS_KEPT];	/* to be freed */
	int			count;
	GEOSInterruptCallback *interrupt;	/* of others, such as PostGIS */
} Geos;

extern void geos_begin(Geos *geos);
extern void geos_end(Geos *geos);
extern GEOSGeometry *geos_keep(Geos *geos, GEOSGeometry *geometry);
extern GEOSGeometry *geos_read_text(Geos *geos, const char *text);
extern GEOSGeometry *geos_read_hex(Geos *geos, const char *text);
extern int	geos_magnitude(Geos *geos, const GEOSGeometry *geometry);
extern GEOSGeometry *geos_times(Geos *geos, GEOSGeometry *geometry, int exponent);
extern char *geos_message(const Geos *geos);
extern void geos_require(const Geos *geos, bool holds);

#endif
