/*
 * vacuum_moves.h: moves the rows of vacuumed meshes to the beginning of their tables.
 */
#ifndef ABACUS_VACUUM_MOVES_H
#define ABACUS_VACUUM_MOVES_H

#include "nodes/pg_list.h"

/* The statement's options for all tables. */
typedef struct VacuumOptions
{
	bool		verbose;
	bool		truncate;		/* explicitly on: the tables' settings do not count */
	bool		index_cleanup;	/* likewise */
} VacuumOptions;

/* A mesh, and its tables if they are vacuumed, otherwise InvalidOid. */
typedef struct VacuumJob
{
	Oid			mesh;
	Oid			simplices;
	Oid			vertices;
} VacuumJob;

extern List *vacuum_move_meshes(List *jobs, const VacuumOptions *options, MemoryContext home);

#endif
