/*
 * places.h: reads the places of a query, for a function that answers all of them.
 */
#ifndef ABACUS_PLACES_H
#define ABACUS_PLACES_H

#include "abacus/locate.h"
#include "abacus/octree_ask.h"
#include "pg/input/source.h"
#include "pg/mesh/reader.h"

/*
 * Made by places_read(), or by places_open() and places_fetch() if arguments depend on the mesh.
 * The caller then puts its question for each place to the core.
 */
typedef struct PlacesRead
{
	Source		source;
	Reader	   *reader;			/* its host and header are below */
	Host	   *host;
	uint32		dimension;
	abacus_names names;
	abacus_places *places;		/* for a mesh */
	abacus_octree_places *octants;	/* for an octree */
	uint64		count;			/* number of places */
} PlacesRead;

extern void places_open(PlacesRead *read, Oid mesh, uint32 type, const char *query);
extern void places_fetch(PlacesRead *read);
extern void places_read(PlacesRead *read, Oid mesh, uint32 type, const char *query);
extern void places_done(PlacesRead *read);

#endif
