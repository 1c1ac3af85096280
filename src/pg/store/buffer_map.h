/*
 * buffer_map.h: maps shared buffers into this process's address space.
 */
#ifndef ABACUS_BUFFER_MAP_H
#define ABACUS_BUFFER_MAP_H

#include "storage/buf.h"

extern void buffer_map_around(Buffer buffer);

#endif
