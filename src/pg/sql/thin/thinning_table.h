/*
 * thinning_table.h: the table beside a thinned mesh, which says how it was thinned.
 */
#ifndef ABACUS_THINNING_TABLE_H
#define ABACUS_THINNING_TABLE_H

#include "pg/mesh/mesh.h"

/* Its only row; texts that are NULL are NULL there. */
typedef struct ThinningRow
{
	char	   *mesh;			/* the mesh that was thinned, with its schema */
	int64		stamp;			/* of that mesh */
	char	   *attribute;
	double		max_error;
	char	   *keep;
	int64		target;			/* 0: none */
	bool		is_done;
	double		greatest;		/* error, if it is done */
	int64		reached;		/* stamp of the thinned mesh after the last step, until it is done */
} ThinningRow;

extern void thinning_table_make(Relation mesh, const ThinningRow *row);
extern bool thinning_table_read(Relation mesh, ThinningRow *row);
extern bool thinning_is_unfinished(Oid mesh);
extern void thinning_table_reach(Relation mesh, int64 stamp);
extern void thinning_table_finish(Relation mesh, double greatest);

#endif
