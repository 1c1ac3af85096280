/*
 * line_geometries.h: lines given as geometries of PostGIS, as rows of points.
 */
#ifndef ABACUS_LINE_GEOMETRIES_H
#define ABACUS_LINE_GEOMETRIES_H

#include "pg/lines/line_rows.h"
#include "pg/postgis/catalogue.h"

typedef struct LineGeometries LineGeometries;

extern LineGeometries *line_geometries_begin(NamedRows *rows, Oid type, abacus_names names,
											 const char *z);
extern void line_geometries_put(LineGeometries *geometries, int64 line, Datum geometry,
								bool is_null);
extern void line_geometries_end(LineGeometries *geometries, LineShape *shape);
extern void line_geometries_tell(const LineGeometries *geometries);

#endif
