/*
 * page_type.h: the base type abacus_page, the bytes of one page.
 *
 * A varlena stored plain (never compressed, shortened or moved out of line) with the
 * alignment of double: four bytes of length, four zero bytes, then the page. So the
 * page lies at a multiple of eight and is read in place.
 */
#ifndef ABACUS_PAGE_TYPE_H
#define ABACUS_PAGE_TYPE_H

#include "abacus/host_functions.h"

#include "pg/port/port.h"

#define PAGE_TYPE_OVERHEAD 8

static inline const unsigned char *
page_type_bytes(const struct varlena *datum)
{
	return (const unsigned char *) datum + PAGE_TYPE_OVERHEAD;
}

static inline size_t
page_type_size(const struct varlena *datum)
{
	return VARSIZE(datum) - PAGE_TYPE_OVERHEAD;
}

/* Fills a zeroed datum that has room for the page. */
static inline void
page_type_fill(struct varlena *datum, const void *bytes, size_t size)
{
	SET_VARSIZE(datum, PAGE_TYPE_OVERHEAD + size);
	memcpy((char *) datum + PAGE_TYPE_OVERHEAD, bytes, size);
}

#endif
