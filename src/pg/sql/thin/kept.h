/*
 * kept.h: what a thinned mesh keeps on wish, from an argument.
 */
#ifndef ABACUS_KEPT_H
#define ABACUS_KEPT_H

#include "pg/sql/thin/thinner.h"

typedef struct Kept
{
	bool		border;			/* vertices on the border */
	bool		lines;			/* and their vertices */
	const char *query;			/* of ids; or NULL */
} Kept;

extern void kept_parse(const char *argument, Kept *kept);
extern void kept_insert(Thinner *thinner, const Kept *kept);
extern void kept_constrain(const Thinner *thinner, Oid extension_namespace);

#endif
