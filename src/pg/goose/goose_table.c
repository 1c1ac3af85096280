/*
 * goose_table.c: a table with one row for each simplex, and a GiST index of boxes.
 *
 * Rows are found by index scans that are kept open and rescanned, and changed
 * by heap_insert(), index_insert() and simple_heap_delete(): no SPI and no
 * executor once the table is made.
 *
 * Of three simplices that an insertion makes, later ones remove two, all in one command. PostgreSQL
 * keeps their index entries, since a rollback to a savepoint or an older snapshot might need them.
 * Searches would go through three times the entries, and visit a dead row for each that they hit.
 * But the same command makes and fills this table: no one else sees it, and a rollback of the
 * command drops the whole table. So the entry of a removed row is marked dead at once, as index
 * scans mark rows that are dead to all (kill_prior_tuple). Further scans skip it, and its space is
 * reused when its page is full. GiST has no other call for that, so a removal is a search for the
 * row's box. It is the same in the dissertation's R-tree, whose deletions spend 98 % of their time
 * searching. The rows themselves stay in the heap until VACUUM.
 *
 * All rows are inserted under one command id and removed under the next. PostgreSQL
 * lets only a later command remove a row. With an id for each step, every removed row
 * would leave a pair of ids in the backend's memory (combocid.c); with two ids there is
 * one pair in all. Scans use SnapshotSelf, which sees all these changes at once.
 */
#include "postgres.h"

#include "access/genam.h"
#include "access/heapam.h"
#include "access/relscan.h"
#include "access/stratnum.h"
#include "access/table.h"
#include "access/tableam.h"
#include "access/xact.h"
#include "catalog/index.h"
#include "catalog/namespace.h"
#include "catalog/pg_am.h"
#include "catalog/pg_type.h"
#include "lib/stringinfo.h"
#include "utils/builtins.h"
#include "utils/lsyscache.h"
#include "utils/memutils.h"
#include "utils/snapmgr.h"
#include "utils/varlena.h"

#include "pg/base/location.h"
#include "pg/base/utility.h"
#include "pg/goose/goose_row.h"
#include "pg/goose/goose_table.h"
#include "pg/host/guard.h"
#include "pg/mesh/new_table.h"
#include "pg/port/port.h"

/* ---- The table -------------------------------------------------------------- */

/* Makes table and index through the usual utility path, as the caller; returns the table. */
static Oid
create_table(const char *name, Oid namespace, int dimension)
{
	static const char axes[] = "xyz";
	const char *qualified = quote_qualified_identifier(get_namespace_name(namespace), name);
	StringInfoData command;

	initStringInfo(&command);
	appendStringInfo(&command, "CREATE TABLE %s (", qualified);
	for (int i = 0; i < GOOSE_CORNERS(dimension); i++)
		appendStringInfo(&command, "v%d pg_catalog.int8, ", i);
	for (int i = 0; i < GOOSE_CORNERS(dimension); i++)
		for (int k = 0; k < dimension; k++)
			appendStringInfo(&command, "%c%d pg_catalog.float8, ", axes[k], i);
	appendStringInfo(&command, "box %s) USING heap",
					 format_type_be_qualified(goose_box_type(dimension)));
	utility_run(command.data);
	utility_run(psprintf("CREATE INDEX ON %s USING gist (box)", qualified));
	return new_table_id(namespace, name);
}

/* An event trigger may have changed the new table: it must be what the code below relies on. */
static void
check_shape(const GooseTable *table, List *indexes)
{
	TupleDesc	row = RelationGetDescr(table->heap);
	int			columns = GOOSE_BOX_COLUMN(table->dimension) + 1;
	bool		is = row->natts == columns && list_length(indexes) == 1 &&
		table->heap->rd_rel->relam == HEAP_TABLE_AM_OID;

	for (int i = 0; is && i < columns; i++)
		is = TupleDescAttr(row, i)->atttypid ==
			(i < GOOSE_FIRST_COORDINATE(table->dimension) ? INT8OID :
			 i < columns - 1 ? FLOAT8OID : goose_box_type(table->dimension));
	if (!is)
		ereport(ERROR,
				(errcode(ERRCODE_OBJECT_NOT_IN_PREREQUISITE_STATE),
				 errmsg("table \"%s\" was changed as soon as it had been made",
						RelationGetRelationName(table->heap)),
				 errhint("Look for an event trigger that changes it.")));
}

static void
init_key(ScanKey key, Relation index, StrategyNumber strategy)
{
	Oid			type = index->rd_opcintype[0];
	Oid			operator = get_opfamily_member(index->rd_opfamily[0], type, type, strategy);

	ScanKeyEntryInitialize(key, 0, 1, strategy, type, InvalidOid, get_opcode(operator), (Datum) 0);
}

/* Makes a table with that name and opens it, in the current memory context. */
GooseTable *
goose_table_create(text *name, int dimension)
{
	GooseTable *table = palloc0(sizeof(GooseTable));
	RangeVar   *range = makeRangeVarFromNameList(textToQualifiedNameList(name));
	List	   *indexes;

	table->dimension = dimension;
	table->memory = CurrentMemoryContext;
	table->scratch = AllocSetContextCreate(table->memory, "Goose row", ALLOCSET_DEFAULT_SIZES);
	table->relid = create_table(range->relname, new_table_schema(range), dimension);
	table->heap = table_open(table->relid, RowExclusiveLock);
	indexes = RelationGetIndexList(table->heap);
	check_shape(table, indexes);
	table->index = index_open(linitial_oid(indexes), RowExclusiveLock);
	table->index_info = BuildIndexInfo(table->index);
	init_key(&table->overlaps, table->index, RTOverlapStrategyNumber);
	init_key(&table->equals, table->index, RTSameStrategyNumber);
	table->slot = MakeSingleTupleTableSlot(RelationGetDescr(table->heap), &TTSOpsBufferHeapTuple);
	table->scan = port_index_beginscan(table->heap, table->index, SnapshotSelf, 1);
	table->inserting = GetCurrentCommandId(true);
	CommandCounterIncrement();
	return table;
}

void
goose_table_close(GooseTable *table)
{
	index_endscan(table->scan);
	ExecDropSingleTupleTableSlot(table->slot);
	index_close(table->index, NoLock);
	table_close(table->heap, NoLock);
}

/* ---- Rows ------------------------------------------------------------------------ */

static void
read_row(const GooseTable *table, abacus_boxed_simplex *row)
{
	if (!goose_row_decode(table->dimension, table->slot, row))
		ereport(ERROR,
				(errcode(ERRCODE_DATA_CORRUPTED),
				 errmsg("table \"%s\" holds a row that is not a simplex",
						RelationGetRelationName(table->heap)),
				 errhint("Do not write to the table while abacus_goose() makes it.")));
}

static void
insert_row(GooseTable *table, const abacus_boxed_simplex *row)
{
	int			box = GOOSE_BOX_COLUMN(table->dimension);
	MemoryContext old = MemoryContextSwitchTo(table->scratch);
	Datum		values[GOOSE_MAX_COLUMNS];
	bool		isnull[GOOSE_MAX_COLUMNS];
	GooseBox	room;
	HeapTuple	tuple;

	goose_row_encode(table->dimension, row, values, isnull, &room);
	tuple = heap_form_tuple(RelationGetDescr(table->heap), values, isnull);
	heap_insert(table->heap, tuple, table->inserting, 0, NULL);
	index_insert(table->index, &values[box], &isnull[box], &tuple->t_self, table->heap,
				 UNIQUE_CHECK_NO, false, table->index_info);
	MemoryContextSwitchTo(old);
	MemoryContextReset(table->scratch);
}

/* ---- Searches -------------------------------------------------------------------- */

/*
 * A search is measured by the boxes that it compares. GiST calls the operator class once for each
 * box, so these calls are counted.
 */
static uint64 boxes_looked_at;
static PGFunction look_at_box;

static Datum
count_box(PG_FUNCTION_ARGS)
{
	boxes_looked_at++;
	return look_at_box(fcinfo);
}

/* Starts a search. */
static void
search(GooseTable *table, ScanKey key, const double *lower, const double *upper, GooseBox *room)
{
	FmgrInfo   *consistent = &table->scan->keyData[0].sk_func;

	key->sk_argument = goose_box(table->dimension, lower, upper, room);
	index_rescan(table->scan, key, 1, NULL, 0);
	look_at_box = consistent->fn_addr;	/* a rescan installs it again */
	consistent->fn_addr = count_box;
	boxes_looked_at = 0;
}

static size_t
find_rows(GooseTable *table, const double *point)
{
	size_t		count = 0;
	GooseBox		room;

	search(table, &table->overlaps, point, point, &room);
	while (index_getnext_slot(table->scan, ForwardScanDirection, table->slot))
	{
		if (count == table->room)
		{
			table->room = table->room == 0 ? 64 : 2 * table->room;
			table->found = table->found == NULL
				? MemoryContextAlloc(table->memory, table->room * sizeof(abacus_boxed_simplex))
				: repalloc_huge(table->found, table->room * sizeof(abacus_boxed_simplex));
		}
		read_row(table, &table->found[count++]);
	}
	return count;
}

/*
 * Searches for a row's box and marks the row's index entry dead; false if it is not there. GiST
 * collects the marks until it leaves a page, but never marks an index of only one page. It would
 * then set these marks on the first page that it leaves later. So nothing is marked until there are
 * more pages.
 */
static bool
kill_entry(GooseTable *table, const abacus_boxed_simplex *row)
{
	bool		killed = false;
	ItemPointerData wanted;
	ItemPointer tid;
	GooseBox		room;

	unpack_location(row->location, &wanted);
	if (!table->has_leaves)
		table->has_leaves = RelationGetNumberOfBlocks(table->index) > 1;
	search(table, &table->equals, row->lower, row->upper, &room);
	/* to the end, since the mark is made when the scan continues */
	while ((tid = index_getnext_tid(table->scan, ForwardScanDirection)) != NULL)
		if (ItemPointerEquals(tid, &wanted))
		{
			killed = true;
			table->scan->kill_prior_tuple = table->has_leaves;
		}
	return killed;
}

/* The finished table has no ghosts. */
void
goose_table_remove_ghosts(GooseTable *table)
{
	TableScanDesc scan = port_table_beginscan(table->heap, SnapshotSelf);
	abacus_boxed_simplex row;

	while (table_scan_getnextslot(scan, ForwardScanDirection, table->slot))
		if (slot_attisnull(table->slot, table->dimension + 1))
		{
			read_row(table, &row);
			kill_entry(table, &row);
			simple_heap_delete(table->heap, &table->slot->tts_tid);
		}
	ExecClearTuple(table->slot);
	table_endscan(scan);
}

/* ---- What the core calls ------------------------------------------------------------ */

static abacus_host_status
rtree_search(void *context, const double *point, const abacus_boxed_simplex **found,
			 size_t *count, uint64_t *boxes)
{
	GooseTable *table = context;

	GUARD_BEGIN();
	*count = find_rows(table, point);
	*found = table->found;
	*boxes += boxes_looked_at;
	GUARD_END(table->host);
	return ABACUS_HOST_OK;
}

static abacus_host_status
rtree_unlink(void *context, const abacus_boxed_simplex *row, uint64_t *boxes)
{
	GooseTable *table = context;
	volatile bool killed = false;

	GUARD_BEGIN();
	killed = kill_entry(table, row);
	*boxes += boxes_looked_at;
	GUARD_END(table->host);
	return killed ? ABACUS_HOST_OK : ABACUS_HOST_NONE;
}

static abacus_host_status
rtree_erase(void *context, const abacus_boxed_simplex *row)
{
	GooseTable *table = context;
	ItemPointerData tid;

	GUARD_BEGIN();
	unpack_location(row->location, &tid);
	simple_heap_delete(table->heap, &tid);
	GUARD_END(table->host);
	return ABACUS_HOST_OK;
}

static abacus_host_status
rtree_insert(void *context, const abacus_boxed_simplex *row)
{
	GooseTable *table = context;

	GUARD_BEGIN();
	insert_row(table, row);
	GUARD_END(table->host);
	return ABACUS_HOST_OK;
}

/* Sets the host that keeps errors of the functions of table->rtree. */
void
goose_table_own(GooseTable *table, Host *host)
{
	table->host = host;
	table->rtree.context = table;
	table->rtree.search = rtree_search;
	table->rtree.unlink = rtree_unlink;
	table->rtree.erase = rtree_erase;
	table->rtree.insert = rtree_insert;
}
