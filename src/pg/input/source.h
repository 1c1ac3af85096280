/*
 * source.h: the user's query that yields points (id, x, y[, z][, attribute...]) or (id, geometry[,
 * attribute...]), or simplices (v0, v1, v2[, v3][, label...]), or (code, v0, v1, v2[, v3],
 * label...), or their facets (code, v0, v1, v2[, v3], facet, marker), or edges of lines (line, v0, v1),
 * or values of vertices (id, value...).
 */
#ifndef ABACUS_SOURCE_H
#define ABACUS_SOURCE_H

#include "executor/spi.h"

#include "pg/input/row_packer.h"

typedef struct Source
{
	const char *query;
	SPIPlanPtr	plan;
	Portal		portal;			/* NULL while not reading */
	RowPacker  *packer;
} Source;

extern void source_prepare(Source *source, const char *query);
extern int	source_columns(const Source *source);
extern const char *source_column_name(const Source *source, int column);
extern void source_require_attributes(const Source *source, uint32 dimension);
extern int	source_first_attribute(const Source *source, uint32 dimension);
extern void source_open(Source *source, abacus_names names, bool takes_srid);
extern void source_open_places(Source *source, abacus_names names);
extern void source_open_simplices(Source *source, abacus_names names);
extern void source_open_labels(Source *source, abacus_names names);
extern void source_open_facets(Source *source, abacus_names names);
extern void source_open_loaded_facets(Source *source, abacus_names names);
extern void source_open_loaded_lines(Source *source, abacus_names names);
extern void source_open_values(Source *source);
extern void source_open_octants(Source *source, abacus_names names, OctantRows rows,
								bool takes_srid);
extern size_t source_fetch(Source *source, const uint64 **points);
extern void source_close(Source *source);
extern void source_finish(Source *source);

#endif
