/*
 * line_crossings.h: where lines cross elsewhere than in a vertex, by a sweep of the core.
 */
#ifndef ABACUS_LINE_CROSSINGS_H
#define ABACUS_LINE_CROSSINGS_H

#include "abacus/crossings.h"
#include "pg/mesh/writer.h"

typedef struct LineCrossings
{
	Host	   *host;
	abacus_crossings *swept;
} LineCrossings;

/* Whether there is a vertex at a place. */
typedef bool (*VertexTest) (void *context, const double *place);

/* A corner of a line, as words for line_crossings_add(). */
enum
{
	CORNER_LINE,
	CORNER_POSITION,
	CORNER_X,
	CORNER_Y,
	CORNER_PART,				/* 0 where a line has only one */
	CORNER_COLUMNS
};

extern void line_crossings_open(LineCrossings *crossings, size_t memory);
extern void line_crossings_add(LineCrossings *crossings, const uint64 *corners, size_t count);
extern void line_crossings_add_query(LineCrossings *crossings, const char *query,
									 bool sees_changes);
extern bool line_crossings_next(LineCrossings *crossings, VertexTest is_vertex, void *context,
								abacus_crossing *crossing);
extern void line_crossings_close(LineCrossings *crossings);
extern bool line_crossings_any(Writer *writer, VertexTest is_vertex, void *context);
extern void line_crossings_refuse(Writer *writer, VertexTest is_vertex, void *context);

#endif
