/*
 * page_shelf.c: pages that came from other servers, kept to be read again.
 *
 * They are sorted by their keys. When they take too many bytes, one that has not been read for long makes
 * room. All pages are of one state of the mesh; with another state the shelf is cleared.
 */
#include "postgres.h"

#include "utils/memutils.h"

#include "pg/remote/page_shelf.h"

#define FIRST_ROOM 64
/* A page that has come stays while an eighth of the room gets other pages: the hand passes it twice. */
#define FRESH 2
/* No page is found by its location: looking into the shelf is as quick. */
#define REMOTE_LOCATION 1

int
key_compare(const abacus_key *a, const abacus_key *b)
{
	if (a->code != b->code)
		return a->code < b->code ? -1 : 1;
	if (a->part != b->part)
		return a->part < b->part ? -1 : 1;
	return 0;
}

/* The bytes and the shelf live in a context of their own below `memory`. */
void
shelf_init(PageShelf *shelf, MemoryContext memory, size_t most)
{
	MemSet(shelf, 0, sizeof(*shelf));
	shelf->memory = AllocSetContextCreate(memory, "Abacus remote pages", ALLOCSET_DEFAULT_SIZES);
	shelf->most = most;
}

void
shelf_clear(PageShelf *shelf)
{
	MemoryContextReset(shelf->memory);
	shelf->pages = NULL;
	shelf->count = shelf->room = shelf->hand = 0;
	shelf->bytes = 0;
}

/* How many pages begin at the key or before it. */
static int
count_up_to(const PageShelf *shelf, const abacus_key *key)
{
	int			low = 0;
	int			high = shelf->count;

	while (low < high)
	{
		int			middle = (low + high) / 2;

		if (key_compare(&shelf->pages[middle].page.key, key) <= 0)
			low = middle + 1;
		else
			high = middle;
	}
	return low;
}

/* The page that owns the key, valid until a page is put; NULL if it is not there. */
const ShelfPage *
shelf_find(PageShelf *shelf, const abacus_key *key)
{
	int			i = count_up_to(shelf, key) - 1;

	if (i < 0 || key_compare(key, &shelf->pages[i].upper) >= 0)
		return NULL;
	shelf->pages[i].uses = Max(shelf->pages[i].uses, 1);
	return &shelf->pages[i];
}

static void
remove_page(PageShelf *shelf, int i)
{
	shelf->bytes -= shelf->pages[i].page.size;
	pfree(unconstify(unsigned char *, shelf->pages[i].page.bytes));
	shelf->count--;
	memmove(shelf->pages + i, shelf->pages + i + 1, (shelf->count - i) * sizeof(ShelfPage));
}

static void
make_room(PageShelf *shelf, size_t size)
{
	while (shelf->count > 0 && shelf->bytes + size > shelf->most)
	{
		if (shelf->hand >= shelf->count)
			shelf->hand = 0;
		if (shelf->pages[shelf->hand].uses > 0)
			shelf->pages[shelf->hand++].uses--;
		else
			remove_page(shelf, shelf->hand);
	}
	if (shelf->count < shelf->room)
		return;
	shelf->room = Max(FIRST_ROOM, 2 * shelf->room);
	shelf->pages = shelf->pages == NULL
		? MemoryContextAlloc(shelf->memory, shelf->room * sizeof(ShelfPage))
		: repalloc_huge(shelf->pages, shelf->room * sizeof(ShelfPage));
}

/* Keeps a copy of a page that owns the keys from `key` on, up to `upper`. */
void
shelf_put(PageShelf *shelf, const abacus_key *key, const abacus_key *upper, const void *bytes, size_t size)
{
	unsigned char *copy;
	ShelfPage  *page;
	int			i;

	if (shelf_find(shelf, key) != NULL)
		return;
	make_room(shelf, size);
	copy = MemoryContextAlloc(shelf->memory, Max(1, size));
	memcpy(copy, bytes, size);
	i = count_up_to(shelf, key);
	page = shelf->pages + i;
	memmove(page + 1, page, (shelf->count - i) * sizeof(ShelfPage));
	*page = (ShelfPage) {
		.page = {*key, copy, size, REMOTE_LOCATION},.upper = *upper,.uses = FRESH
	};
	if (i <= shelf->hand)
		shelf->hand++;
	shelf->count++;
	shelf->bytes += size;
}
