/*
 * notices.h: notices of unexpected things that are not errors.
 */
#ifndef ABACUS_NOTICES_H
#define ABACUS_NOTICES_H

#include "pg/mesh/mesh.h"
#include "pg/mesh/writer.h"

extern void notice_equal_points(const char *mesh, uint64 points, bool hint);
extern void notice_waiting_points(const char *mesh, uint32 dimension, uint64 points);
extern void notice_duplicates(const Writer *writer, uint64 before, bool hint);
extern void notice_waiting(const Writer *writer);
extern bool notice_namesake(Oid mesh, SideRows rows);

#endif
