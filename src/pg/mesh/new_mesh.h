/*
 * new_mesh.h: the tables of a new mesh.
 */
#ifndef ABACUS_NEW_MESH_H
#define ABACUS_NEW_MESH_H

#include "abacus/mesh_header.h"

extern Oid	new_mesh(text *name, Oid extension_namespace, abacus_header *header,
					 const char *command);

#endif
