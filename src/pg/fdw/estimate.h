/*
 * estimate.h: how many rows and pages of a published mesh a query needs.
 */
#ifndef ABACUS_FDW_ESTIMATE_H
#define ABACUS_FDW_ESTIMATE_H

#include "pg/fdw/conditions.h"

/* The size of a mesh, as far as it is known while a query is planned. */
typedef struct MeshSize
{
	bool		is_known;		/* the header could be read */
	uint32		dimension;
	double		lower[ABACUS_MAX_DIMENSION];	/* domain */
	double		upper[ABACUS_MAX_DIMENSION];
	double		rows;			/* without conditions */
	double		pages;
} MeshSize;

/* The shares that conditions leave. */
typedef struct Share
{
	double		rows;			/* shares of all, from 0 to 1 */
	double		pages;
	bool		is_whole;		/* pages are read in their order */
} Share;

extern void estimate_mesh(const Published *published, Oid user, MeshSize *size);
extern void estimate_share(const Shown *shown, const MeshSize *size, List *conditions,
						   Share *share);

#endif
