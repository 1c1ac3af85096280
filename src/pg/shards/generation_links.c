/*
 * generation_links.c: the generation of a mesh that readers see, and connections on which its shards are as
 * they belong together.
 *
 * Each change of a shard's mesh gives it another version, which is in a table there, and in the row on the
 * coordinator. They are committed one after the other. So a reader compares the versions that its
 * transactions on the servers see with those of the row that it has read. Where they are the same he has
 * the mesh as one change has left it. Else some commits are under way, or he has an old row: he reads
 * again. If what he sees of the row stays the same through the transaction, he cannot: that is a
 * serialization failure.
 */
#include "postgres.h"

#include <float.h>

#include "access/xact.h"
#include "access/xlog.h"
#include "catalog/pg_type.h"
#include "miscadmin.h"
#include "storage/latch.h"
#include "utils/lsyscache.h"
#include "utils/snapmgr.h"
#include "utils/wait_event.h"

#include "pg/lines/named_rows.h"
#include "pg/mesh/lines_table.h"
#include "pg/shards/generation_links.h"
#include "pg/shards/shard_resolve.h"
#include "pg/shards/shard_sql.h"
#include "pg/shards/shard_transaction.h"

/* Pauses before reading again, in milliseconds: they double up to the longest one. */
#define LONGEST_PAUSE 64
#define PATIENCE 5000
/* From then on the end of a change is searched for that nobody else may know. */
#define RESOLVE_AFTER 200

static void
let_pass(int milliseconds)
{
	(void) WaitLatch(MyLatch, WL_LATCH_SET | WL_TIMEOUT | WL_EXIT_ON_PM_DEATH, milliseconds, PG_WAIT_EXTENSION);
	ResetLatch(MyLatch);
	CHECK_FOR_INTERRUPTS();
}

/* ---- Versions ------------------------------------------------------------------------------- */

/* What servers say of the versions that are not known. */
static void
ask_versions(const Generation *generation, ShardLinks *links)
{
	bool	   *asked = palloc0(links->count * sizeof(bool));
	int64		version;

	for (int i = 0; i < links->count; i++)
	{
		connection_finish(links->connections[i]);
		shard_transaction_guard(links->connections[i]);
		asked[i] = !shard_transaction_knows_version(links->connections[i], generation->number, &version);
		if (asked[i])
			shard_transaction_send(links->connections[i], shard_sql_version(generation, i));
	}
	for (int i = 0; i < links->count; i++)
		if (asked[i])
			shard_transaction_set_version(links->connections[i], generation->number, link_int64(links, i));
	pfree(asked);
}

/* The first shard with another version than the row has, or -1. Its transaction ends, if it has no changes. */
static int
find_other(const Generation *generation, ShardLinks *links)
{
	int			other = -1;

	for (int i = links->count - 1; i >= 0; i--)
	{
		int64		version;

		if (shard_transaction_knows_version(links->connections[i], generation->number, &version) &&
			version == generation->versions[i])
			continue;
		other = i;
		if (!shard_transaction_has_changed(links->connections[i]))
			shard_transaction_end(links->connections[i]);
	}
	return other;
}

static int
open_and_compare(const Generation *generation, ShardLinks *links)
{
	links_prepare(links, generation->servers, generation->shards);
	links_open(links, CONNECTION_OF_TRANSACTION, generation->relid);
	for (int i = 0; i < links->count; i++)
		connection_name_mesh(links->connections[i], generation_mesh(generation, i), get_rel_name(generation->relid));
	ask_versions(generation, links);
	return find_other(generation, links);
}

static bool
any_has_changed(const ShardLinks *links)
{
	for (int i = 0; i < links->count; i++)
		if (shard_transaction_has_changed(links->connections[i]))
			return true;
	return false;
}

static void
give_up(const Generation *generation, int shard)
{
	ereport(ERROR,
			(errcode(ERRCODE_OBJECT_NOT_IN_PREREQUISITE_STATE),
			 errmsg("shard %d of mesh \"%s\", on server \"%s\", is not as the mesh was last changed", shard + 1,
					get_rel_name(generation->relid), generation->servers[shard]),
			 errdetail("A change waits there for its end, or the server or the coordinator has an older state than the other."),
			 errhint("Call abacus_shard_resolve() for the mesh. If that does not help, build it again with abacus_shard_build().")));
}

static void
read_newest(Oid relid, Generation *generation)
{
	PushActiveSnapshot(GetLatestSnapshot());
	generation_require_published(relid, generation);
	PopActiveSnapshot();
}

/* A build begins with dropping what was replaced by the one before. An old snapshot still sees its row. */
static void
require_kept(const Generation *seen)
{
	Generation	kept;
	bool		is_kept;

	if (!IsolationUsesXactSnapshot())
		return;
	PushActiveSnapshot(GetLatestSnapshot());
	is_kept = generation_read_numbered(seen->relid, seen->number, &kept);
	PopActiveSnapshot();
	if (!is_kept)
		ereport(ERROR,
				(errcode(ERRCODE_T_R_SERIALIZATION_FAILURE),
				 errmsg("mesh \"%s\" was built again since the transaction began", get_rel_name(seen->relid)),
				 errhint("Repeat the transaction.")));
}

/*
 * The generation that readers see, and connections to its shards, on which all queries of the transaction
 * see them as they belong together.
 */
void
generation_read_links(Oid relid, Generation *generation, ShardLinks *links)
{
	int			waited = 0;
	bool		resolved = false;
	int			other;

	generation_require_published(relid, generation);
	require_kept(generation);
	for (int step = 0; (other = open_and_compare(generation, links)) >= 0; step = Min(Max(1, 2 * step), LONGEST_PAUSE))
	{
		if (IsolationUsesXactSnapshot() && !any_has_changed(links))
			ereport(ERROR,
					(errcode(ERRCODE_T_R_SERIALIZATION_FAILURE),
					 errmsg("mesh \"%s\" was changed since the transaction began", get_rel_name(relid)),
					 errhint("Repeat the transaction.")));
		if (waited > PATIENCE)
			give_up(generation, other);
		if (step > 0)
			let_pass(step);
		waited += step;
		if (waited > RESOLVE_AFTER && !resolved && !RecoveryInProgress())
		{
			(void) shard_resolve(generation);
			resolved = true;
		}
		read_newest(relid, generation);
	}
}

/*
 * Begins transactions on other connections, which see the shards as one change has left them, and reads the
 * generation anew if there was one since. Returns -1, or the number of a shard that is not as the row says.
 */
int
generation_begin_together(Generation *generation, ShardLinks *links)
{
	for (int step = 1, waited = 0;; waited += step, step = Min(2 * step, LONGEST_PAUSE))
	{
		int			other = -1;

		for (int i = 0; i < links->count; i++)
			link_do(links, i, "BEGIN ISOLATION LEVEL REPEATABLE READ");
		for (int i = 0; i < links->count; i++)
			link_send(links, i, shard_sql_version(generation, i));
		for (int i = 0; i < links->count; i++)
			if (link_int64(links, i) != generation->versions[i])
				other = i;
		if (other < 0 || waited > PATIENCE)
			return other;
		for (int i = 0; i < links->count; i++)
			link_do(links, i, "ROLLBACK");
		let_pass(step);
		read_newest(generation->relid, generation);
	}
}

/* An error if the connection no longer sees the shard as the generation was read. */
void
generation_require_seen(const Generation *generation, ShardLinks *links, int shard)
{
	int64		version;

	connection_finish(links->connections[shard]);
	if (!shard_transaction_knows_version(links->connections[shard], generation->number, &version) ||
		version != generation->versions[shard])
		ereport(ERROR,
				(errcode(ERRCODE_T_R_SERIALIZATION_FAILURE),
				 errmsg("mesh \"%s\" was changed while it was read", get_rel_name(generation->relid)),
				 errhint("Repeat the query.")));
}

/* ---- For changes ---------------------------------------------------------------------------- */

/*
 * The generation that readers see, locked until the end of the transaction: one writer waits for
 * another.
 */
static Generation *
lock_generation(Oid relid)
{
	Generation *generation = palloc(sizeof(Generation));

	for (;;)
	{
		int64		number;

		generation_require_published(relid, generation);
		number = generation->number;
		(void) query_run(psprintf("SELECT FROM %s WHERE generation OPERATOR(pg_catalog.=) '" INT64_FORMAT "' FOR UPDATE",
								  lines_table_name(relid), number));
		read_newest(relid, generation);
		if (generation->number == number)
			return generation;
		if (IsolationUsesXactSnapshot())
			ereport(ERROR,
					(errcode(ERRCODE_T_R_SERIALIZATION_FAILURE),
					 errmsg("mesh \"%s\" was built again since the transaction began", get_rel_name(relid)),
					 errhint("Repeat the transaction.")));
	}
}

/* Whether a shard can be changed now, or after ends of other changes are found out. */
static bool
can_change(const Generation *generation, ShardLinks *links)
{
	bool		can = true;

	for (int i = 0; i < links->count; i++)
		shard_transaction_send(links->connections[i], shard_sql_readiness(generation, i));
	for (int i = 0; i < links->count; i++)
	{
		LinkRows   *rows = link_rows(links, i, link_columns(2, (Oid[]) {INT8OID, INT8OID}, NULL));

		if (DatumGetInt64(link_value(rows, 0, 1)) == 0)
			ereport(ERROR,
					(errcode(ERRCODE_OBJECT_NOT_IN_PREREQUISITE_STATE),
					 errmsg("server \"%s\" takes no changes of a mesh over several servers: max_prepared_transactions is 0 there",
							links->servers[i]),
					 errhint("Set max_prepared_transactions on the server to the number of its connections, and restart it.")));
		can &= DatumGetInt64(link_value(rows, 0, 2)) == 0;
		link_rows_free(rows);
	}
	return can;
}

/*
 * The same for a change: others wait until the transaction ends. Changes whose end is not known are ended
 * first, since they keep rows of the shards locked.
 */
Generation *
generation_change_links(Oid relid, ShardLinks *links)
{
	Generation *generation = lock_generation(relid);
	int			waited = 0;
	int			step = 1;

	for (;;)
	{
		int			other = open_and_compare(generation, links);

		if (other < 0 && (any_has_changed(links) || can_change(generation, links)))
			return generation;
		if (waited > PATIENCE)
			give_up(generation, Max(other, 0));
		for (int i = 0; i < links->count; i++)
			if (!shard_transaction_has_changed(links->connections[i]))
				shard_transaction_end(links->connections[i]);
		if (waited > 0)
			(void) shard_resolve(generation);
		let_pass(step);
		waited += step;
		step = Min(2 * step, LONGEST_PAUSE);
	}
}

/* ---- Where points may come ------------------------------------------------------------------ */

/*
 * A box around all points, the same for many changes: the domain, or its double, and so on. Wherever a
 * point comes, regions of shards are as they were, unless the box grows.
 */
void
generation_reach(const Generation *generation, abacus_box *reach)
{
	const abacus_form *form = &generation->form;
	double		side = 0;
	bool		contains = false;

	for (uint32 i = 0; i < form->dimension; i++)
	{
		reach->lower[i] = form->has_domain ? form->lower[i] : generation->extent.lower[i];
		reach->upper[i] = form->has_domain ? form->upper[i] : generation->extent.upper[i];
		side = Max(side, reach->upper[i] / 2 - reach->lower[i] / 2);
	}
	for (side = Max(side, DBL_MIN); !contains; side *= 2)
	{
		contains = true;
		for (uint32 i = 0; i < form->dimension; i++)
			contains &= reach->lower[i] <= generation->extent.lower[i] && generation->extent.upper[i] <= reach->upper[i];
		for (uint32 i = 0; i < form->dimension && !contains; i++)
		{
			reach->lower[i] = Max(reach->lower[i] - side, -DBL_MAX);
			reach->upper[i] = Min(reach->upper[i] + side, DBL_MAX);
		}
	}
}
