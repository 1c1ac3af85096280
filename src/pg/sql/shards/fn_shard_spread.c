/*
 * fn_shard_spread.c: abacus_shard_split and abacus_shard_stage, with which a server deals out the points
 * of its own query, and takes what it owns.
 *
 * Points lie in a temporary table (point_room.h): abacus_shard_survey() has put those of the server's own
 * query there, and the coordinator those of others.
 */
#include "postgres.h"

#include "executor/spi.h"
#include "utils/array.h"

#include "abacus/shards.h"
#include "pg/base/sql_function.h"
#include "pg/mesh/change.h"
#include "pg/mesh/shape.h"
#include "pg/shards/point_room.h"
#include "pg/shards/shard_owner.h"

SQL_FUNCTION(abacus_sql_shard_split);
SQL_FUNCTION(abacus_sql_shard_stage);

static void
owners_argument(FunctionCallInfo fcinfo, int argument, ShardOwners *owners)
{
	ArrayType  *array = PG_GETARG_ARRAYTYPE_P(argument);

	if (ARR_NDIM(array) > 1 || array_contains_nulls(array))
		ereport(ERROR,
				(errcode(ERRCODE_INVALID_PARAMETER_VALUE),
				 errmsg("borders must be a one-dimensional array without NULLs")));
	owners->count = ARR_NDIM(array) == 0 ? 0 : ARR_DIMS(array)[0];
	owners->borders = (const uint64 *) ARR_DATA_PTR(array);
}

/* ---- abacus_shard_split --------------------------------------------------------------------- */

typedef struct Split
{
	ShardOwners owners;
	int			own;
	int			words;
	PointRoom **rooms;			/* for each other shard, once needed */
	int64		points;			/* in them */
} Split;

static void
split_records(void *context, bool is_sorted_out, const uint64 *records, size_t count)
{
	Split	   *split = context;

	for (size_t i = 0; i < count; i++, records += split->words)
	{
		int			owner = owner_of_point(&split->owners, (const double *) (records + 1));

		if (owner == split->own)
			continue;
		if (split->rooms[owner] == NULL)
		{
			split->rooms[owner] = palloc(sizeof(PointRoom));
			point_room_open(split->rooms[owner], split->own, owner, split->words);
		}
		point_room_put(split->rooms[owner], records);
		split->points++;
	}
}

/*
 * abacus_shard_split(attributes int, lower float8[], upper float8[], borders bigint[], own int) -> bigint
 */
Datum
abacus_sql_shard_split(PG_FUNCTION_ARGS)
{
	ArrayType  *lower = PG_GETARG_ARRAYTYPE_P(1);
	abacus_facts facts = {.columns.attributes = (uint32) Max(0, PG_GETARG_INT32(0))};
	Split		split = {.own = PG_GETARG_INT32(4)};

	shape_dimension(&facts.form, ARR_NDIM(lower) == 1 ? ARR_DIMS(lower)[0] : 0);
	shape_point(&facts.form, lower, "lower", facts.form.lower);
	shape_point(&facts.form, PG_GETARG_ARRAYTYPE_P(2), "upper", facts.form.upper);
	facts.form.has_domain = 1;
	split.owners.form = facts.form;
	owners_argument(fcinfo, 3, &split.owners);
	split.words = point_words(&facts);
	split.rooms = palloc0((split.owners.count + 1) * sizeof(PointRoom *));
	SPI_connect();
	point_room_each("shard IS NULL", &facts, split_records, &split);
	for (int i = 0; i <= split.owners.count; i++)
		if (split.rooms[i] != NULL)
			point_room_close(split.rooms[i]);
	SPI_finish();
	PG_RETURN_INT64(split.points);
}

/* ---- abacus_shard_stage --------------------------------------------------------------------- */

typedef struct Staging
{
	ShardOwners owners;
	int			own;
	int			words;
	abacus_box	extent;			/* of all points of all shards */
	Change	   *change;
} Staging;

/* A point outside would not be looked for where it is. */
static void
require_extent(const Staging *staging, const double *point)
{
	for (uint32 i = 0; i < staging->owners.form.dimension; i++)
		if (point[i] < staging->extent.lower[i] || point[i] > staging->extent.upper[i])
			ereport(ERROR,
					(errcode(ERRCODE_INVALID_PARAMETER_VALUE),
					 errmsg("a point lies outside the extent of all points"),
					 errdetail("Its %c is %.17g.", "xyz"[i], point[i])));
}

/* Adds the records from `begin` up to `end`. */
static void
add_run(Staging *staging, const uint64 *begin, const uint64 *end)
{
	if (begin < end)
		change_add(staging->change, begin, (size_t) (end - begin) / staging->words);
}

static void
stage_records(void *context, bool is_sorted_out, const uint64 *records, size_t count)
{
	Staging    *staging = context;
	const uint64 *run = records;	/* of own points */

	for (size_t i = 0; i < count; i++)
	{
		const uint64 *record = records + i * staging->words;
		const double *point = (const double *) (record + 1);

		if (owner_of_point(&staging->owners, point) == staging->own)
		{
			require_extent(staging, point);
			continue;
		}
		if (is_sorted_out)
			ereport(ERROR,
					(errcode(ERRCODE_DATA_CORRUPTED),
					 errmsg("a point has come to a shard that does not own it")));
		add_run(staging, run, record);
		run = record + staging->words;
	}
	add_run(staging, run, records + count * staging->words);
}

/*
 * abacus_shard_stage(mesh regclass, borders bigint[], own int, least float8[], greatest float8[])
 *     -> bigint
 */
Datum
abacus_sql_shard_stage(PG_FUNCTION_ARGS)
{
	Staging		staging = {.own = PG_GETARG_INT32(2)};
	Change	   *change = change_begin(PG_GETARG_OID(0), "abacus_shard_stage()");
	const abacus_facts *facts = &change->writer.header->facts;
	uint64		points;

	staging.change = change;
	staging.owners.form = facts->form;
	staging.words = point_words(facts);
	owners_argument(fcinfo, 1, &staging.owners);
	shape_point(&facts->form, PG_GETARG_ARRAYTYPE_P(3), "least", staging.extent.lower);
	shape_point(&facts->form, PG_GETARG_ARRAYTYPE_P(4), "greatest", staging.extent.upper);
	change_open_stage(change, facts);
	SPI_connect();
	point_room_each(psprintf("shard IS NULL OR shard OPERATOR(pg_catalog.=) %d", staging.own), facts, stage_records,
					&staging);
	SPI_finish();
	change_stage(change);
	points = change->points;
	change_end(change);
	PG_RETURN_INT64((int64) points);
}
