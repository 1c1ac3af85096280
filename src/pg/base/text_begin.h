/*
 * text_begin.h: the beginning of a text, for messages.
 */
#ifndef ABACUS_TEXT_BEGIN_H
#define ABACUS_TEXT_BEGIN_H

#include "mb/pg_wchar.h"

/* At most 80 bytes of it, which end with "..." if more follow. */
static inline char *
text_begin(const char *text)
{
	size_t		length = strlen(text);

	return length <= 80 ? pstrdup(text)
		: psprintf("%.*s...", pg_mbcliplen(text, (int) Min(length, 128), 77), text);
}

#endif
