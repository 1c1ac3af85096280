/*
 * pending_parts.h: the notes of pending.c, for those who apply them.
 */
#ifndef ABACUS_PENDING_PARTS_H
#define ABACUS_PENDING_PARTS_H

#include "nodes/pg_list.h"

#include "pg/track/pending.h"
#include "pg/track/point_log.h"

/* The part of a log that counts. */
typedef struct Extent
{
	uint64		start;			/* in bytes */
	uint64		end;
	uint64		came;			/* points, or lines that have changed */
	uint64		went;			/* points */
	bool		all;			/* all points of the table went before these; or all lines have changed */
} Extent;

/* The state that a nested transaction found. */
typedef struct Saved
{
	SubTransactionId of;
	Extent		extent;
} Saved;

struct Pending
{
	Oid			mesh;
	TrackedKind kind;
	Oid			user;			/* whose rights are used to change it */
	char	   *table;			/* for messages, like the trigger */
	char	   *trigger;
	ExpectedShape shape;		/* of the mesh; for lines its columns are 1, a line's id */
	uint32		srid;			/* of the mesh, or of the noted geometries; 0: none */
	PointLog   *log;
	Extent		extent;
	List	   *saved;			/* the innermost transaction's first */
	Pending    *next;
};

/* Receives noted points, or ids of lines. */
typedef void (*PendingSink) (void *context, const uint64 *records, size_t count);

extern void pending_read(const Pending *pending, bool gone, PendingSink sink, void *context);

#endif
