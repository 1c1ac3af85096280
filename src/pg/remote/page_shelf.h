/*
 * page_shelf.h: pages that came from other servers, kept to be read again.
 */
#ifndef ABACUS_PAGE_SHELF_H
#define ABACUS_PAGE_SHELF_H

#include "postgres.h"

#include "abacus/host_functions.h"

/* A page, and where the next one begins. */
typedef struct ShelfPage
{
	abacus_page page;
	abacus_key	upper;
	uint8		uses;			/* the hand passes it so often before it has to go */
} ShelfPage;

/* In the order of their keys; two never own the same key. */
typedef struct PageShelf
{
	MemoryContext memory;		/* of the bytes, and of this */
	size_t		most;			/* bytes */
	size_t		bytes;
	int			count;
	int			room;
	int			hand;			/* the next that may have to go: a clock (Corbató, 1968) */
	ShelfPage  *pages;
} PageShelf;

extern void shelf_init(PageShelf *shelf, MemoryContext memory, size_t most);
extern void shelf_clear(PageShelf *shelf);
extern const ShelfPage *shelf_find(PageShelf *shelf, const abacus_key *key);
extern void shelf_put(PageShelf *shelf, const abacus_key *key, const abacus_key *upper, const void *bytes,
					  size_t size);
extern int	key_compare(const abacus_key *a, const abacus_key *b);

#endif
