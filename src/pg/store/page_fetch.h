/*
 * page_fetch.h: reads rows of a table of pages by their location.
 */
#ifndef ABACUS_PAGE_FETCH_H
#define ABACUS_PAGE_FETCH_H

#include "pg/store/page_table.h"

extern void page_table_expect_moves(PageTable *table);
extern bool page_table_fetch(PageTable *table, ItemPointer tid, const unsigned char *bytes,
							 size_t size, StoredPage *page);

#endif
