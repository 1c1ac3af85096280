/*
 * page_index.c: the indexes of a table of pages.
 *
 * Pages are found through the primary key. There may be other indexes. REINDEX CONCURRENTLY builds
 * a new one while writers continue. As soon as it is ready, the writers add the entries that it
 * would miss. They also maintain the old one until no one reads it. So a writer maintains every
 * index on the key columns, including those that others have made. Indexes with expressions or
 * predicates would need the executor, and indexes on the page itself are useless: with one of these
 * the mesh can only be read.
 */
#include "postgres.h"

#include "access/genam.h"
#include "catalog/index.h"
#include "catalog/pg_am.h"

#include "pg/port/port.h"
#include "pg/store/page_index.h"

typedef struct PageIndex
{
	Relation	index;
	IndexInfo  *info;
} PageIndex;

/*
 * The primary key, which must be the index that we search by. The table's list of indexes names it
 * only while it is valid. The index's own entry may be newer or older than the list, since others
 * see that a transaction has committed before they learn what it has changed. Then REINDEX
 * CONCURRENTLY has just put one index in the other's place. Both are complete, and stay so while we
 * keep our lock on the table, which it waits for.
 */
Relation
page_index_open_primary(Relation heap, LOCKMODE lock)
{
	Oid			index_oid = port_primary_key_index(heap);
	Relation	index = OidIsValid(index_oid) ? index_open(index_oid, lock) : NULL;
	bool		usable = index != NULL && index->rd_rel->relam == BTREE_AM_OID &&
		index->rd_index->indimmediate && index->rd_index->indnkeyatts == PAGE_TABLE_KEYS;

	for (int i = 0; usable && i < PAGE_TABLE_KEYS; i++)
		usable = index->rd_index->indkey.values[i] == i + 1;
	if (!usable)
		ereport(ERROR,
				(errcode(ERRCODE_OBJECT_NOT_IN_PREREQUISITE_STATE),
				 errmsg("table \"%s\" lacks the primary key of a mesh",
						RelationGetRelationName(heap)),
				 errhint("Add it again: PRIMARY KEY (%s, %s).",
						 NameStr(TupleDescAttr(RelationGetDescr(heap), 0)->attname),
						 NameStr(TupleDescAttr(RelationGetDescr(heap), 1)->attname))));
	return index;
}

/* Whether entries can be formed from the key columns alone. */
static bool
is_on_keys(const IndexInfo *info)
{
	bool		is = info->ii_Expressions == NIL && info->ii_Predicate == NIL &&
		info->ii_ExclusionOps == NULL;

	for (int i = 0; is && i < info->ii_NumIndexAttrs; i++)
		is = info->ii_IndexAttrNumbers[i] >= 1 && info->ii_IndexAttrNumbers[i] <= PAGE_TABLE_KEYS;
	return is;
}

/* All indexes that a writer must maintain, in the current memory context. */
List *
page_index_open_all(Relation heap)
{
	List	   *oids = RelationGetIndexList(heap);
	List	   *indexes = NIL;
	ListCell   *cell;

	foreach(cell, oids)
	{
		PageIndex  *opened = palloc(sizeof(PageIndex));

		opened->index = index_open(lfirst_oid(cell), RowExclusiveLock);
		opened->info = BuildIndexInfo(opened->index);
		if (!is_on_keys(opened->info) || !opened->index->rd_index->indimmediate)
			ereport(ERROR,
					(errcode(ERRCODE_OBJECT_NOT_IN_PREREQUISITE_STATE),
					 errmsg("cannot change mesh table \"%s\" because of its index \"%s\"",
							RelationGetRelationName(heap),
							RelationGetRelationName(opened->index)),
					 errdetail("Abacus keeps plain indexes on the key columns only."),
					 errhint("Drop that index.")));
		indexes = lappend(indexes, opened);
	}
	list_free(oids);
	return indexes;
}

/*
 * Makes the entries of a new row, or of a new version of a row with the same key. The
 * key stays unique without a check. A check would visit all versions that this
 * transaction has left, thousands in a loop of small changes.
 */
void
page_index_insert(List *indexes, Relation heap, const Datum *values, const bool *isnull,
				  ItemPointer tid, bool same_key)
{
	ListCell   *cell;

	foreach(cell, indexes)
	{
		const PageIndex *opened = lfirst(cell);
		const IndexInfo *info = opened->info;
		Datum		columns[INDEX_MAX_KEYS];
		bool		nulls[INDEX_MAX_KEYS];

		if (!info->ii_ReadyForInserts)
			continue;
		for (int i = 0; i < info->ii_NumIndexAttrs; i++)
		{
			columns[i] = values[info->ii_IndexAttrNumbers[i] - 1];
			nulls[i] = isnull[info->ii_IndexAttrNumbers[i] - 1];
		}
		index_insert(opened->index, columns, nulls, tid, heap,
					 info->ii_Unique && !same_key ? UNIQUE_CHECK_YES : UNIQUE_CHECK_NO, same_key,
					 opened->info);
	}
}

/* Closes them; locks stay until the end of the transaction. */
void
page_index_close_all(List *indexes)
{
	ListCell   *cell;

	foreach(cell, indexes)
	{
		PageIndex  *opened = lfirst(cell);

		port_index_insert_cleanup(opened->index, opened->info);
		index_close(opened->index, NoLock);
		pfree(opened->info);
	}
	list_free_deep(indexes);
}
