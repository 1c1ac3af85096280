/*
 * levels_table.h: the table of a mesh's levels: coarser meshes beside it, each with its error.
 */
#ifndef ABACUS_LEVELS_TABLE_H
#define ABACUS_LEVELS_TABLE_H

#include "pg/mesh/mesh.h"

/* A row of the table. */
typedef struct Level
{
	int32		number;			/* from 1, the finest */
	Oid			mesh;			/* it may have been dropped */
	char	   *attribute;
	double		max_error;		/* that was allowed */
	double		greatest;		/* that it had */
	int64		stamp;			/* of the full mesh then */
} Level;

extern Oid	levels_table_make(Relation mesh);
extern int	levels_read(Oid table, MeshAccess access, Level **levels);
extern bool levels_may_read(Oid mesh);
extern int	levels_read_if_allowed(Oid mesh, Level **levels);
extern int	levels_bound(Oid mesh, MeshAccess access, Oid **levels);
extern int	levels_count_unnamed(Oid mesh, MeshAccess access, const Level *levels, int count, Oid *level);
extern int	levels_count_lost(Oid mesh, const Level *levels, int count);
extern uint32 levels_hash(const Level *levels, int count);
extern int	levels_count_old(const Level *levels, int count, uint64 stamp);
extern void levels_bind(Relation mesh);
extern Oid	levels_choose(Oid mesh, double max_error, const char *attribute);

#endif
