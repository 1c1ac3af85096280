/*
 * area_text.h: polygons as text, read by GEOS.
 */
#ifndef ABACUS_AREA_TEXT_H
#define ABACUS_AREA_TEXT_H

/* The rings of a valid polygon, one after the other; the last point of a ring is its first. */
typedef struct AreaText
{
	int32		srid;			/* 0: none is given */
	size_t		rings;
	size_t	   *sizes;			/* points of each ring */
	double	   *points;			/* x, y */
} AreaText;

struct Geos;

extern bool area_text_is(const char *text);
extern struct GEOSGeom_t *area_text_geometry(struct Geos *geos, const char *what, const char *text);
extern AreaText area_text_read(const char *what, const char *text);

#endif
