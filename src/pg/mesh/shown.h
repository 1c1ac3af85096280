/*
 * shown.h: the foreign tables and views that show a mesh.
 */
#ifndef ABACUS_SHOWN_H
#define ABACUS_SHOWN_H

#include "nodes/pg_list.h"

/* The server of these tables. */
#define FDW_SERVER "abacus"
/* The function by which they name the mesh. */
#define SHOWN_MESH_FUNCTION "abacus_published"

extern List *shown_tables(Oid mesh);
extern List *shown_views(Oid mesh);
extern void shown_bind(Oid mesh, Oid table);
extern char *shown_names(List *tables);

#endif
