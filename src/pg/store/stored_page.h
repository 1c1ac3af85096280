/*
 * stored_page.h: reads a row of a mesh's table as a page.
 */
#ifndef ABACUS_STORED_PAGE_H
#define ABACUS_STORED_PAGE_H

#include "executor/tuptable.h"

#include "pg/store/page_index.h"

/* A stored page; bytes stay valid until the next search. */
typedef struct StoredPage
{
	int64		key[PAGE_TABLE_KEYS];
	const unsigned char *bytes;
	size_t		size;
	ItemPointerData tid;
} StoredPage;

extern void stored_page_read(TupleTableSlot *slot, StoredPage *page);

#endif
