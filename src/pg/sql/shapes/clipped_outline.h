/*
 * clipped_outline.h: the border of what a mesh has in a polygon.
 */
#ifndef ABACUS_CLIPPED_OUTLINE_H
#define ABACUS_CLIPPED_OUTLINE_H

#include "abacus/shapes.h"
#include "pg/mesh/reader.h"
#include "pg/sql/rows/answers.h"

typedef void (*PutOutlineRow) (const Answers *answers, const abacus_outline_row *row, bool is_vertex);

extern void clipped_outline(Reader *reader, const abacus_outline_kind *kind, const char *polygon,
							PutOutlineRow put, const Answers *answers);

#endif
