/*
 * page_search.h: rows of a table of pages found by key.
 */
#ifndef ABACUS_PAGE_SEARCH_H
#define ABACUS_PAGE_SEARCH_H

#include "pg/store/page_table.h"

extern void page_table_refuse_newer_index(PageTable *table);
extern void page_table_refuse_newer(PageTable *table);
extern bool page_table_get(PageTable *table, const int64 *key, StoredPage *page);
extern bool page_table_floor(PageTable *table, const int64 *key, StoredPage *page);
extern bool page_table_next(PageTable *table, const int64 *key, StoredPage *page);
extern TableScanDesc page_table_scan_heap_page(PageTable *table, BlockNumber block);

#endif
