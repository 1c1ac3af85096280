/*
 * crossings.h: where segments of lines in the plane cross.
 *
 * Two segments cross if they have exactly one point in common, which is an end of none of the
 * segments. Segments that touch in an end, or overlap along a stretch, do not cross.
 */
#ifndef ABACUS_ABACUS_CROSSINGS_H
#define ABACUS_ABACUS_CROSSINGS_H

#include "abacus/host_functions.h"

#ifdef __cplusplus
extern "C" {
#endif

/* A segment of a line, and the position of its first end in it. */
typedef struct abacus_line_segment
{
	int64_t line, position;
	double a[2], b[2];
} abacus_line_segment;

/* Two segments that cross, of one line or of two, the lesser one by line and position first. */
typedef struct abacus_crossing
{
	int64_t line[2], position[2];
	double place[2];  /* each coordinate rounded once */
	int32_t is_exact; /* whether nothing was rounded */
} abacus_crossing;

typedef struct abacus_crossings abacus_crossings;

/* Opens a collection of segments. It takes `memory` bytes, and spools beyond them. */
ABACUS_API abacus_status abacus_crossings_open(const abacus_host *host, size_t memory,
											   abacus_crossings **crossings, abacus_error *error);
/* Adds segments, in any order. */
ABACUS_API abacus_status abacus_crossings_add(abacus_crossings *crossings,
											  const abacus_line_segment *segments, size_t count,
											  abacus_error *error);
/*
 * Adds corners of lines, in any order: each 5 words of 8 bytes, line and position (signed), x and y
 * (doubles), and the number of a part of the line (0 where there is only one). A line has a segment
 * from each of its corners to the one with the next position, if that is of the same part;
 * ABACUS_ERROR (argument), later, if two have one position.
 */
ABACUS_API abacus_status abacus_crossings_add_corners(abacus_crossings *crossings,
													  const uint64_t *records, size_t count,
													  abacus_error *error);
/* How many there are. No more segments and corners may be added from here on. */
ABACUS_API abacus_status abacus_crossings_count(abacus_crossings *crossings, uint64_t *count,
												abacus_error *error);
/* The next crossing, by line and position of the first segment, then of the second one. */
ABACUS_API abacus_status abacus_crossings_next(abacus_crossings *crossings,
											   abacus_crossing *crossing, abacus_error *error);
ABACUS_API void abacus_crossings_close(abacus_crossings *crossings);

#ifdef __cplusplus
}
#endif

#endif
