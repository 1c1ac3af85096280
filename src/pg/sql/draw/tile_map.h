/*
 * tile_map.h: arguments of tiles: the map that they are of, and the attribute that they show.
 */
#ifndef ABACUS_TILE_MAP_H
#define ABACUS_TILE_MAP_H

#include "fmgr.h"

#include "abacus/tile.h"
#include "pg/mesh/header.h"

/* Half of the side of the map of Web Mercator, in metres */
#define HALF_WORLD 20037508.342789244

extern void tile_map(FunctionCallInfo fcinfo, int srid, int world, const abacus_form *form,
					 abacus_tile *tile);
extern int	tile_attribute(FunctionCallInfo fcinfo, int argument, abacus_names names);

#endif
