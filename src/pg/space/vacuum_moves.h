/*
 * vacuum_moves.h: the rows of meshes that have been vacuumed, moved to the
 * beginning of their tables.
 */
#ifndef ABACUS_VACUUM_MOVES_H
#define ABACUS_VACUUM_MOVES_H

#include "nodes/pg_list.h"

/* What the statement says about all tables. */
typedef struct VacuumOptions
{
	bool		verbose;
	bool		truncate;		/* said to be on: the tables' settings do not count */
	bool		index_cleanup;	/* likewise */
} VacuumOptions;

/* A mesh, and its tables as far as they are vacuumed, else InvalidOid. */
typedef struct VacuumJob
{
	Oid			mesh;
	Oid			simplices;
	Oid			vertices;
} VacuumJob;

extern List *vacuum_move_meshes(List *jobs, const VacuumOptions *options, MemoryContext home);

#endif
