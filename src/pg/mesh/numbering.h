/*
 * numbering.h: permanent numbers of attributes.
 */
#ifndef ABACUS_NUMBERING_H
#define ABACUS_NUMBERING_H

#include "pg/mesh/header.h"

/* The greatest number that an attribute can have. */
#define NUMBERING_LIMIT 0x3FFFFFFF

typedef struct Numbering
{
	uint32		count;			/* of attributes */
	uint32		dropped;		/* attributes of the mesh that were dropped */
	uint32		before[ABACUS_MAX_ATTRIBUTES];	/* how many of the dropped ones came before each */
} Numbering;

/* The row with the numbering, if an attribute has been dropped. */
extern const int64 numbering_key[PAGE_TABLE_KEYS];

extern bool numbering_try_read(Host *host, const abacus_columns *columns, Numbering *numbering);
extern void numbering_read(Host *host, const abacus_columns *columns, Numbering *numbering);
extern uint32 numbering_number(const Numbering *numbering, uint32 position);
extern int	numbering_position(const Numbering *numbering, uint32 number);
extern void numbering_change(Host *host, const abacus_columns *columns, const uint32 *source,
							 uint32 count);

#endif
