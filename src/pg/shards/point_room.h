/*
 * point_room.h: where a server keeps points while they are spread: a temporary table.
 */
#ifndef ABACUS_POINT_ROOM_H
#define ABACUS_POINT_ROOM_H

#include "executor/spi.h"

#include "pg/shards/point_bytes.h"

/* Rows of points that are put in, for one shard, or, below 0, for any. SPI must be connected. */
typedef struct PointRoom
{
	SPIPlanPtr	insert;
	int			source;			/* whose query gave them */
	int			shard;
	int			words;			/* of a record */
	StringInfoData bytes;		/* not in the table yet */
} PointRoom;

/* Takes records; `is_sorted_out`: they are those of the shard. */
typedef void (*PointRoomTake) (void *context, bool is_sorted_out, const uint64 *records, size_t count);

extern const char *point_room_create(void);
extern void point_room_open(PointRoom *room, int source, int shard, int words);
extern void point_room_put(PointRoom *room, const uint64 *record);
extern void point_room_close(PointRoom *room);
extern void point_room_each(const char *condition, const abacus_facts *facts, PointRoomTake take, void *context);

#endif
