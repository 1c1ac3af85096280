/*
 * shard_owner.c: which shard owns a point.
 */
#include "postgres.h"

#include "abacus/shards.h"
#include "pg/shards/shard_owner.h"

/* The shard that owns a code: as many borders are not above it. */
int
owner_of_code(const uint64 *borders, int count, uint64 code)
{
	int			least = 0;
	int			most = count;

	while (least < most)
	{
		int			middle = (least + most) / 2;

		if (code < borders[middle])
			most = middle;
		else
			least = middle + 1;
	}
	return least;
}

int
owner_of_point(const ShardOwners *owners, const double *point)
{
	abacus_error error;
	uint64		code;

	if (abacus_codes(&owners->form, point, 1, &code, &error) != ABACUS_OK)
		elog(ERROR, "could not compute a code: %s", error.message);
	return owner_of_code(owners->borders, owners->count, code);
}
