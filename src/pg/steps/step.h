/*
 * step.h: a step of a solution, whose values are read in place of the attributes of a mesh.
 */
#ifndef ABACUS_STEP_H
#define ABACUS_STEP_H

#include "fmgr.h"

#include "pg/mesh/header.h"

/* Of one step or all: its number, parts, how many are stored, vertices, whether it is whole; then values of a
 * vertex, and the mesh's stamp in two halves, if it is. %s: the table, and AND with what limits the steps. */
#define STEPS_QUERY \
	"SELECT step, max(\"values\"[1])::integer AS parts, count(*)::integer AS stored, " \
	"sum(\"values\"[2])::bigint AS vertices, count(*) = max(\"values\"[1]) AND " \
	"count(DISTINCT (\"values\"[1], \"values\"[3], \"values\"[4], \"values\"[5])) = 1 AS whole, " \
	"max(\"values\"[5])::integer AS width, max(\"values\"[3])::bigint AS upper, max(\"values\"[4])::bigint AS lower " \
	"FROM %s WHERE id IS NULL%s GROUP BY step ORDER BY step"

typedef struct Step Step;

extern Step *step_open(Oid mesh, const abacus_header *header, int64 number, MemoryContext memory);
extern Step *step_of_call(FunctionCallInfo fcinfo, Oid mesh, const abacus_header *header, int64 number);
extern char *step_tag(Oid mesh, int64 number);
extern bool step_range(Oid mesh, int64 number, int value, double *range);
extern abacus_names step_names(const Step *step);
extern bool step_find(Step *step, int64 id, double *values);
extern void step_replaces_attributes(Step *step, Host *host, abacus_header *header);

#endif
