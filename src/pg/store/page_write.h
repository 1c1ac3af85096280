/*
 * page_write.h: adds, replaces, removes and moves rows of a table of pages.
 */
#ifndef ABACUS_PAGE_WRITE_H
#define ABACUS_PAGE_WRITE_H

#include "pg/store/page_table.h"

extern void page_table_insert(PageTable *table, const int64 *key, const unsigned char *bytes,
							  size_t size, ItemPointer tid);
extern void page_table_update(PageTable *table, const int64 *key, const unsigned char *bytes,
							  size_t size, ItemPointer tid);
extern void page_table_delete(PageTable *table, ItemPointer tid);
extern bool page_table_move(PageTable *table, TupleTableSlot *slot);

#endif
