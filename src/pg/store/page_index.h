/*
 * page_index.h: the indexes of a table of pages: the primary key, by which pages are found, and all
 * others that a writer must maintain.
 */
#ifndef ABACUS_PAGE_INDEX_H
#define ABACUS_PAGE_INDEX_H

#include "nodes/execnodes.h"
#include "nodes/pg_list.h"
#include "utils/rel.h"

#define PAGE_TABLE_KEYS 2

extern Relation page_index_open_primary(Relation heap, LOCKMODE lock);

extern List *page_index_open_all(Relation heap);
extern void page_index_insert(List *indexes, Relation heap, const Datum *values,
							  const bool *isnull, ItemPointer tid, bool same_key);
extern void page_index_close_all(List *indexes);

#endif
