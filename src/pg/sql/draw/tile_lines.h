/*
 * tile_lines.h: the lines over the fixed edges of a vector tile.
 */
#ifndef ABACUS_TILE_LINES_H
#define ABACUS_TILE_LINES_H

#include "abacus/tile.h"
#include "pg/mesh/reader.h"

extern bool tile_lines_may_read(Oid mesh, const abacus_census *census);
extern bool tile_lines_layer(Reader *reader, const abacus_tile *tile, const abacus_extent *extent,
							 abacus_picture *layer);

#endif
