/*
 * loaded_lines.h: lines of a triangulation that is loaded: rows of its edges.
 */
#ifndef ABACUS_LOADED_LINES_H
#define ABACUS_LOADED_LINES_H

#include "pg/lines/named_rows.h"
#include "pg/mesh/change.h"

extern void loaded_lines_read(Change *change, Source *source);
extern NamedRows *loaded_lines_take(Change *change);
extern void loaded_lines_add(Change *change, NamedRows *edges);

#endif
