/*
 * geometry_text.h: which texts are geometries, and where they end.
 */
#ifndef ABACUS_GEOMETRY_TEXT_H
#define ABACUS_GEOMETRY_TEXT_H

/* What a text looks like. */
typedef enum GeometryText
{
	NO_GEOMETRY,				/* a name */
	GEOMETRY_WKT,				/* also EWKT: behind "SRID=number;" */
	GEOMETRY_HEX				/* WKB or EWKB in hexadecimal digits */
} GeometryText;

extern GeometryText geometry_text(const char *text);
extern const char *geometry_text_behind_srid(const char *text, int32 *srid);
extern const char *geometry_text_excess(const char *text);
extern const char *geometry_text_other(const char *text);

#endif
