/*
 * type_name.h: the word for an object of a type, for messages.
 */
#ifndef ABACUS_TYPE_NAME_H
#define ABACUS_TYPE_NAME_H

#include "abacus/facts.h"

static inline const char *
type_name(uint32_t type)
{
	return type == ABACUS_OCTREE ? "octree" : "mesh";
}

#endif
