/*
 * stored_page.c: reads a row of a mesh's table as a page.
 */
#include "postgres.h"

#include "pg/store/page_type.h"
#include "pg/store/stored_page.h"

/*
 * A row in a table can be anything. A value that cannot be a page is passed to the core as a page
 * without bytes. The core rejects it like any page that it cannot read, with an error, or with a
 * fault for abacus_check.
 */
void
stored_page_read(TupleTableSlot *slot, StoredPage *page)
{
	static const uint64 nothing[1];
	struct varlena *datum;

	slot_getsomeattrs(slot, PAGE_TABLE_KEYS + 1);
	for (int i = 0; i < PAGE_TABLE_KEYS; i++)
		page->key[i] = slot->tts_isnull[i] ? PG_INT64_MIN : DatumGetInt64(slot->tts_values[i]);
	page->tid = slot->tts_tid;
	page->bytes = (const unsigned char *) nothing;
	page->size = 0;
	if (slot->tts_isnull[PAGE_TABLE_KEYS] || page->key[PAGE_TABLE_KEYS - 1] < 0)
		return;
	datum = (struct varlena *) DatumGetPointer(slot->tts_values[PAGE_TABLE_KEYS]);
	if (VARATT_IS_4B_U(datum) && VARSIZE(datum) >= PAGE_TYPE_OVERHEAD &&
		VARSIZE(datum) <= PAGE_TYPE_OVERHEAD + ABACUS_MAX_PAGE_BYTES && PointerIsAligned(datum, double))
	{
		page->bytes = page_type_bytes(datum);
		page->size = page_type_size(datum);
	}
}
