/*
 * point_room.c: where a server keeps points while they are spread: a temporary table, of which each row
 * has some thousand points, as bytes.
 *
 * Rows of the server's own query have no shard. Those for one shard have it: those that go there, and on
 * that server those that have come. `source` is the shard whose query gave them, and `n` their order.
 */
#include "postgres.h"

#include "catalog/pg_type.h"
#include "miscadmin.h"
#include "utils/builtins.h"
#include "utils/memutils.h"

#include "pg/shards/point_room.h"

#define ROWS_A_TIME 8

/* For this transaction. Bytes of points cannot be compressed: nothing is gained by an attempt. */
const char *
point_room_create(void)
{
	return "CREATE TEMPORARY TABLE abacus_points (n bigserial PRIMARY KEY, source integer NOT NULL, shard integer, "
		"points bytea NOT NULL) ON COMMIT DROP; "
		"ALTER TABLE pg_temp.abacus_points ALTER COLUMN points SET STORAGE EXTERNAL";
}

void
point_room_open(PointRoom *room, int source, int shard, int words)
{
	Oid			types[] = {INT4OID, INT4OID, BYTEAOID};

	room->source = source;
	room->shard = shard;
	room->words = words;
	room->insert = SPI_prepare("INSERT INTO pg_temp.abacus_points (source, shard, points) VALUES ($1, $2, $3)",
							   lengthof(types), types);
	if (room->insert == NULL)
		elog(ERROR, "could not prepare to keep points: %s", SPI_result_code_string(SPI_result));
	initStringInfo(&room->bytes);
}

static void
store(PointRoom *room)
{
	bytea	   *bytes;
	Datum		values[3] = {Int32GetDatum(room->source), Int32GetDatum(room->shard)};
	char		nulls[4] = "   ";

	if (room->bytes.len == 0)
		return;
	bytes = palloc(VARHDRSZ + room->bytes.len);
	SET_VARSIZE(bytes, VARHDRSZ + room->bytes.len);
	memcpy(VARDATA(bytes), room->bytes.data, room->bytes.len);
	values[2] = PointerGetDatum(bytes);
	if (room->shard < 0)
		nulls[1] = 'n';
	if (SPI_execute_plan(room->insert, values, nulls, false, 0) != SPI_OK_INSERT)
		elog(ERROR, "could not keep points");
	pfree(bytes);
	resetStringInfo(&room->bytes);
}

void
point_room_put(PointRoom *room, const uint64 *record)
{
	point_bytes_add(&room->bytes, record, room->words);
	if (room->bytes.len >= POINT_BYTES_FULL)
		store(room);
}

void
point_room_close(PointRoom *room)
{
	store(room);
	SPI_freeplan(room->insert);
	pfree(room->bytes.data);
}

/* Takes the points of all rows with this condition, in the order of the queries and of their rows. */
void
point_room_each(const char *condition, const abacus_facts *facts, PointRoomTake take, void *context)
{
	SPIPlanPtr	plan = SPI_prepare(psprintf("SELECT shard, points FROM pg_temp.abacus_points WHERE %s "
											"ORDER BY source, n", condition), 0, NULL);
	MemoryContext scratch = AllocSetContextCreate(CurrentMemoryContext, "Abacus points", ALLOCSET_DEFAULT_SIZES);
	Portal		portal;

	if (plan == NULL)
		elog(ERROR, "could not prepare to read points: %s", SPI_result_code_string(SPI_result));
	portal = SPI_cursor_open(NULL, plan, NULL, NULL, true);
	for (;;)
	{
		SPITupleTable *rows;
		uint64		count;

		SPI_cursor_fetch(portal, true, ROWS_A_TIME);
		rows = SPI_tuptable;
		count = SPI_processed;
		for (uint64 i = 0; i < count; i++)
		{
			bool		has_no_shard;
			bool		isnull;
			MemoryContext old = MemoryContextSwitchTo(scratch);
			Datum		points = SPI_getbinval(rows->vals[i], rows->tupdesc, 2, &isnull);
			const uint64 *records;
			size_t		found;

			CHECK_FOR_INTERRUPTS();
			(void) SPI_getbinval(rows->vals[i], rows->tupdesc, 1, &has_no_shard);
			records = point_bytes_read(DatumGetByteaPP(points), facts, &found);
			MemoryContextSwitchTo(old);
			take(context, !has_no_shard, records, found);
			MemoryContextReset(scratch);
		}
		SPI_freetuptable(rows);
		if (count == 0)
			break;
	}
	SPI_cursor_close(portal);
	SPI_freeplan(plan);
	MemoryContextDelete(scratch);
}
