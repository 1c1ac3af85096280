/*
 * retriangulate.h: a triangulation made elsewhere becomes Abacus' own of the same vertices.
 */
#ifndef ABACUS_RETRIANGULATE_H
#define ABACUS_RETRIANGULATE_H

#include "abacus/standing.h"
#include "pg/lines/named_rows.h"
#include "pg/mesh/change.h"

typedef struct Retriangulation
{
	bool		labels;			/* it has some */
	bool		markers;
	bool		inherit;		/* new simplices get labels of those that their centroids lay in */
	const char *facets;			/* the name of abacus_facets() in SQL */
} Retriangulation;

extern void retriangulate(Change *change, const Retriangulation *anew, NamedRows *edges, abacus_delaunay delaunay);

#endif
