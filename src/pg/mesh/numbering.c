/*
 * numbering.c: permanent numbers of attributes.
 *
 * Attributes have positions, and the header has their names. Both change: when an attribute is
 * dropped, those after it move up, and its name may be given to another one. So definitions outside
 * the mesh, as that of a foreign table, refer to an attribute by a number. An attribute keeps its
 * number as long as it exists, and no other one ever gets it.
 *
 * As long as no attribute has been dropped, the numbers are the positions. After that, a row of the
 * simplex table, (-1, 1000), after all rows of names, says how many attributes have been dropped,
 * and for each attribute left, how many of these came before it. New attributes come last, so these
 * figures never decrease. The row changes only with the header, which is locked then: a snapshot
 * that sees a header sees the row that belongs to it.
 */
#include "postgres.h"

#include "abacus/build.h"
#include "pg/mesh/numbering.h"
#include "pg/store/page_search.h"
#include "pg/store/page_write.h"

const int64 numbering_key[PAGE_TABLE_KEYS] = {-1, 1000};

/*
 * "ABAN", the number of attributes, the number of dropped ones, and a word for each; little-endian.
 */
#define NUMBERING_MAGIC 0x4E414241
#define NUMBERING_HEAD 3
#define WORD_BYTES 4

static uint32
get_word(const unsigned char *bytes, uint32 at)
{
	const unsigned char *from = bytes + at * WORD_BYTES;

	return from[0] | from[1] << 8 | from[2] << 16 | (uint32) from[3] << 24;
}

static void
put_word(unsigned char *bytes, uint32 at, uint32 word)
{
	for (int i = 0; i < WORD_BYTES; i++)
		bytes[at * WORD_BYTES + i] = (unsigned char) (word >> 8 * i);
}

/* Whether a row is valid for a mesh with this many attributes; *numbering gets its content. */
static bool
decode(const StoredPage *row, Numbering *numbering)
{
	uint32		count = numbering->count;

	if (row->size != (NUMBERING_HEAD + (size_t) count) * WORD_BYTES ||
		get_word(row->bytes, 0) != NUMBERING_MAGIC || get_word(row->bytes, 1) != count)
		return false;
	numbering->dropped = get_word(row->bytes, 2);
	if (numbering->dropped == 0 || numbering->dropped > NUMBERING_LIMIT - count)
		return false;
	for (uint32 i = 0; i < count; i++)
	{
		numbering->before[i] = get_word(row->bytes, NUMBERING_HEAD + i);
		if (numbering->before[i] > numbering->dropped ||
			(i > 0 && numbering->before[i] < numbering->before[i - 1]))
			return false;
	}
	return true;
}

/* Reads the numbers of a mesh, whose header the active snapshot sees; false if they are damaged. */
bool
numbering_try_read(Host *host, const abacus_columns *columns, Numbering *numbering)
{
	StoredPage	row;

	MemSet(numbering, 0, sizeof(*numbering));
	numbering->count = columns->attributes;
	return mesh_pages(host)->remote != NULL || !page_table_get(&mesh_pages(host)->simplices, numbering_key, &row) ||
		decode(&row, numbering);
}

/* The same; an error if they are damaged. */
void
numbering_read(Host *host, const abacus_columns *columns, Numbering *numbering)
{
	if (!numbering_try_read(host, columns, numbering))
		ereport(ERROR,
				(errcode(ERRCODE_DATA_CORRUPTED),
				 errmsg("mesh is corrupted"),
				 errdetail("The row (%d, %d) with the numbers of attributes is not valid.",
						   (int) numbering_key[0], (int) numbering_key[1]),
				 errhint("Restore the mesh from a backup or build it anew.")));
}

/* The number of the attribute at a position; both from 0. */
uint32
numbering_number(const Numbering *numbering, uint32 position)
{
	return position + numbering->before[position];
}

/* The position of the attribute with this number; -1 if it no longer exists. */
int
numbering_position(const Numbering *numbering, uint32 number)
{
	uint32		low = 0;
	uint32		high = numbering->count;

	while (low < high)
	{
		uint32		middle = (low + high) / 2;

		if (numbering_number(numbering, middle) < number)
			low = middle + 1;
		else
			high = middle;
	}
	return low < numbering->count && numbering_number(numbering, low) == number ? (int) low : -1;
}

static void
store(Host *host, const Numbering *numbering)
{
	PageTable  *table = &mesh_pages(host)->simplices;
	size_t		size = (NUMBERING_HEAD + (size_t) numbering->count) * WORD_BYTES;
	unsigned char bytes[(NUMBERING_HEAD + ABACUS_MAX_ATTRIBUTES) * WORD_BYTES];
	StoredPage	row;
	ItemPointerData tid;

	put_word(bytes, 0, NUMBERING_MAGIC);
	put_word(bytes, 1, numbering->count);
	put_word(bytes, 2, numbering->dropped);
	for (uint32 i = 0; i < numbering->count; i++)
		put_word(bytes, NUMBERING_HEAD + i, numbering->before[i]);
	if (page_table_get(table, numbering_key, &row))
	{
		tid = row.tid;
		page_table_update(table, numbering_key, bytes, size, &tid);
	}
	else
		page_table_insert(table, numbering_key, bytes, size, &tid);
}

/*
 * The attributes will change from those in the header: the i-th of `count` is the one at the
 * position source[i], in ascending order, or a new one (ABACUS_NO_ATTRIBUTE). To be called before
 * the header changes.
 */
void
numbering_change(Host *host, const abacus_columns *columns, const uint32 *source, uint32 count)
{
	Numbering  *former = palloc(sizeof(Numbering));
	Numbering  *numbering = palloc0(sizeof(Numbering));
	uint32		next;

	numbering_read(host, columns, former);
	next = former->count + former->dropped;
	for (uint32 i = 0; i < count; i++)
		numbering->before[i] = (source[i] == ABACUS_NO_ATTRIBUTE
								? next++ : numbering_number(former, source[i])) - i;
	if (next > NUMBERING_LIMIT)
		ereport(ERROR,
				(errcode(ERRCODE_PROGRAM_LIMIT_EXCEEDED),
				 errmsg("mesh has had too many attributes"),
				 errhint("Build it anew.")));
	numbering->count = count;
	numbering->dropped = next - count;
	if (numbering->dropped > 0)
		store(host, numbering);
	pfree(former);
	pfree(numbering);
}
