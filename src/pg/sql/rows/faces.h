/*
 * faces.h: the vertices of a part of a mesh.
 */
#ifndef ABACUS_FACES_H
#define ABACUS_FACES_H

#include "fmgr.h"

extern Datum faces_vertices(FunctionCallInfo fcinfo);

#endif
