/*
 * octree_places.h: the places of a query, read for a function that answers all
 * of them from an octree.
 */
#ifndef ABACUS_OCTREE_PLACES_H
#define ABACUS_OCTREE_PLACES_H

#include "abacus/octree_ask.h"
#include "pg/input/source.h"
#include "pg/mesh/reader.h"

/* Made by octree_places_open() and octree_places_fetch(), between which arguments are read. */
typedef struct OctreePlaces
{
	Source		source;
	Reader	   *reader;
	abacus_octree_places *places;
} OctreePlaces;

extern void octree_places_open(OctreePlaces *read, Oid octree, const char *query);
extern void octree_places_fetch(OctreePlaces *read);
extern void octree_places_done(OctreePlaces *read);

#endif
