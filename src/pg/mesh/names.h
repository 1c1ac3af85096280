/*
 * names.h: names of attributes and labels in the encoding in which they are stored.
 */
#ifndef ABACUS_NAMES_H
#define ABACUS_NAMES_H

#include "abacus/mesh_header.h"

/* Names as the header of a mesh has them. */
typedef struct StoredNames
{
	uint32		count;
	char		names[ABACUS_MAX_NAMES][ABACUS_NAME_BYTES];
} StoredNames;

extern int	names_find_invalid(const abacus_header *header);
extern bool names_are_converted(void);
extern void names_to_database(abacus_header *header, StoredNames *stored);
extern void names_move(abacus_header *header, StoredNames *stored, const uint32 *source);
extern void names_to_storage(abacus_header *header, const StoredNames *stored);

#endif
