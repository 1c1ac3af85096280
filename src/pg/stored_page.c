/*
 * stored_page.c: a row of a mesh's table as a page.
 */
#include "postgres.h"

#include "pg/page_type.h"
#include "pg/stored_page.h"

/* Bytes in a table can be anything: checks what the core relies on. */
void
stored_page_read(Relation heap, TupleTableSlot *slot, StoredPage *page)
{
	struct varlena *datum;
	bool		sound = true;

	slot_getsomeattrs(slot, PAGE_TABLE_KEYS + 1);
	for (int i = 0; i <= PAGE_TABLE_KEYS; i++)
		sound &= !slot->tts_isnull[i];
	if (sound)
	{
		for (int i = 0; i < PAGE_TABLE_KEYS; i++)
			page->key[i] = DatumGetInt64(slot->tts_values[i]);
		datum = (struct varlena *) DatumGetPointer(slot->tts_values[PAGE_TABLE_KEYS]);
		sound = VARATT_IS_4B_U(datum) && VARSIZE(datum) >= PAGE_TYPE_OVERHEAD &&
			VARSIZE(datum) <= PAGE_TYPE_OVERHEAD + ABACUS_PAGE_BYTES &&
			PointerIsAligned(datum, double) && page->key[1] >= 0;
	}
	if (!sound)
		ereport(ERROR,
				(errcode(ERRCODE_DATA_CORRUPTED),
				 errmsg("table \"%s\" holds a row that is no page of a mesh",
						RelationGetRelationName(heap)),
				 errdetail("The row is at (%u,%u).", ItemPointerGetBlockNumber(&slot->tts_tid),
						   ItemPointerGetOffsetNumber(&slot->tts_tid)),
				 errhint("Restore the mesh from a backup or build it anew.")));
	page->bytes = page_type_bytes(datum);
	page->size = page_type_size(datum);
	page->tid = slot->tts_tid;
}
