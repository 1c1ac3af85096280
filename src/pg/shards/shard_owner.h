/*
 * shard_owner.h: which shard owns a point.
 */
#ifndef ABACUS_SHARD_OWNER_H
#define ABACUS_SHARD_OWNER_H

#include "abacus/facts.h"

/* The codes over a domain, cut at borders. */
typedef struct ShardOwners
{
	abacus_form form;
	const uint64 *borders;		/* codes that ascend */
	int			count;			/* of borders */
} ShardOwners;

extern int	owner_of_code(const uint64 *borders, int count, uint64 code);
extern int	owner_of_point(const ShardOwners *owners, const double *point);

#endif
