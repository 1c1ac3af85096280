/*
 * shard_sql_change.c: what the coordinator says to the servers when a mesh is changed, in SQL.
 *
 * Points and guests come into a table, <mesh>_arrivals, which is empty outside of a change. It is not a
 * temporary one: a transaction that has used such a table cannot be prepared.
 */
#include "postgres.h"

#include "utils/builtins.h"

#include "pg/shards/change/shard_sql_change.h"
#include "pg/shards/shard_sql.h"

/* ---- What comes ----------------------------------------------------------------------------- */

/* The batch as a table `b` with columns n, id, x, y, z, attributes. */
static char *
batch_rows(const PointBatch *batch)
{
	return psprintf("(SELECT n, id, x, y, %s AS z, %s AS attributes FROM %s) AS b",
					batch->dimension == 2 ? "0::double precision" : "z", shard_sql_attributes(batch->attributes),
					point_batch_rows(batch));
}

char *
shard_sql_arrive_point(const Generation *generation, int from, int shard, const PointBatch *batch)
{
	return psprintf("INSERT INTO %s_arrivals (kind, id, x, y, z, attributes) "
					"SELECT %d, id, x, y, z, attributes FROM %s ORDER BY n",
					generation_mesh(generation, shard), ARRIVES_POINT, batch_rows(batch));
}

/* Guests that are there stay as they are. */
char *
shard_sql_arrive_guest(const Generation *generation, int from, int shard, const PointBatch *batch)
{
	char	   *mesh = generation_mesh(generation, shard);

	return psprintf("WITH fresh AS (INSERT INTO %1$s_guests SELECT id, x, y, z, attributes, true FROM %2$s ORDER BY n "
					"ON CONFLICT DO NOTHING RETURNING id, x, y, z, attributes) "
					"INSERT INTO %1$s_arrivals (kind, id, x, y, z, attributes) "
					"SELECT %3$d, id, x, y, z, attributes FROM fresh",
					mesh, batch_rows(batch), ARRIVES_GUEST);
}

/* Of points of the query that another shard owns: those at whose places there are guests. */
char *
shard_sql_arrive_named(const Generation *generation, int from, int shard, const PointBatch *batch)
{
	char	   *mesh = generation_mesh(generation, shard);

	return psprintf("INSERT INTO %1$s_arrivals (kind, id, x, y, z, attributes) SELECT DISTINCT %2$d, %3$d, g.x, g.y, g.z, "
					"'{}'::double precision[] FROM %4$s JOIN %1$s_guests AS g ON g.x = b.x AND g.y = b.y AND g.z = b.z",
					mesh, ARRIVES_NAMED, from, batch_rows(batch));
}

/* These, for their owners. */
char *
shard_sql_named(const Generation *generation, int shard)
{
	return psprintf("SELECT DISTINCT id::integer, 0::bigint, x, y, z, attributes FROM %s_arrivals WHERE kind = %d",
					generation_mesh(generation, shard), ARRIVES_NAMED);
}

char *
shard_sql_forget_named(const Generation *generation, int shard)
{
	return psprintf("DELETE FROM %s_arrivals WHERE kind = %d", generation_mesh(generation, shard), ARRIVES_NAMED);
}

char *
shard_sql_arrive_asked(const Generation *generation, int from, int shard, const PointBatch *batch)
{
	return psprintf("INSERT INTO %s_arrivals (kind, id, x, y, z, attributes) SELECT %d, 0, x, y, z, '{}' FROM %s",
					generation_mesh(generation, shard), ARRIVES_ASKED, batch_rows(batch));
}

/* Vertices that are no longer there; some may be guests. */
char *
shard_sql_arrive_gone(const Generation *generation, int from, int shard, const PointBatch *batch)
{
	char	   *mesh = generation_mesh(generation, shard);

	return psprintf("WITH gone AS (DELETE FROM %1$s_guests AS g USING %2$s WHERE g.x = b.x AND g.y = b.y AND g.z = b.z "
					"RETURNING g.id, g.x, g.y, g.z) "
					"INSERT INTO %1$s_arrivals (kind, id, x, y, z, attributes) SELECT %3$d, id, x, y, z, '{}' FROM gone",
					mesh, batch_rows(batch), ARRIVES_GONE);
}

/* Vertices that may have another id or other attributes than before; some may be guests. */
char *
shard_sql_arrive_other(const Generation *generation, int from, int shard, const PointBatch *batch)
{
	char	   *mesh = generation_mesh(generation, shard);

	return psprintf("WITH other AS MATERIALIZED (SELECT g.id AS former, b.id, b.x, b.y, b.z, b.attributes "
					"FROM %1$s_guests AS g, %2$s WHERE g.x = b.x AND g.y = b.y AND g.z = b.z AND "
					"(g.id <> b.id OR g.attributes IS DISTINCT FROM b.attributes)), "
					"noted AS (UPDATE %1$s_guests AS g SET id = o.id, attributes = o.attributes FROM other AS o "
					"WHERE g.x = o.x AND g.y = o.y AND g.z = o.z) "
					"INSERT INTO %1$s_arrivals (kind, id, x, y, z, attributes) "
					"SELECT %3$d, former, x, y, z, '{}' FROM other WHERE former <> id UNION ALL "
					"SELECT CASE WHEN former = id THEN %4$d ELSE %5$d END, id, x, y, z, attributes FROM other",
					mesh, batch_rows(batch), ARRIVES_GONE, ARRIVES_OTHER, ARRIVES_GUEST);
}

/* How many guests are new, are to go, and have other attributes. */
char *
shard_sql_arrived(const Generation *generation, int shard)
{
	return psprintf("SELECT count(*) FILTER (WHERE kind = %d), count(*) FILTER (WHERE kind = %d), "
					"count(*) FILTER (WHERE kind = %d) FROM %s_arrivals",
					ARRIVES_GUEST, ARRIVES_GONE, ARRIVES_OTHER, generation_mesh(generation, shard));
}

/* ---- What is done with it ------------------------------------------------------------------- */

/*
 * Inserts or deletes what has come; `how` as abacus_shard_change takes it. Returns the simplices of the shard
 * that have come and gone, if they are wanted, and what happened, in a row whose first column is NULL.
 */
char *
shard_sql_change(const Generation *generation, int shard, Arrival kind, const char *how, bool with_simplices)
{
	char	   *mesh = generation_mesh(generation, shard);
	bool		deletes = strcmp(how, "delete") == 0;
	uint32		dimension = generation->form.dimension;
	int			attributes = deletes ? 0 : generation->attribute_count;
	char	   *query = psprintf("SELECT id, %s FROM %s_arrivals WHERE kind = %d ORDER BY n",
								 point_columns(dimension, attributes, "attributes[%d]"), mesh, kind);
	const char *noted = "";

	/* vertices around those that go have new simplices */
	if (deletes)
		noted = psprintf(", noted AS (INSERT INTO %s_arrivals (kind, id, x, y, z) SELECT DISTINCT %d, 0, corners[i][1], "
						 "corners[i][2], %s FROM c CROSS JOIN generate_series(1, %u) AS i WHERE NOT created)",
						 mesh, ARRIVES_AROUND, dimension == 2 ? "0::double precision" : "corners[i][3]", dimension + 1);
	return psprintf("WITH c AS MATERIALIZED (SELECT * FROM abacus_shard_change('%s', %s, '%s', %s, %s))%s "
					"SELECT created, code, v0, v1, v2, v3, corners, points, more, duplicates, gained, is_all_new FROM c "
					"WHERE created IS NULL%s",
					mesh, quote_literal_cstr(query), how, shard_sql_stretch(generation, shard),
					with_simplices || deletes ? "true" : "false", noted,
					with_simplices ? psprintf(" OR (%s)", shard_sql_interval(generation, shard, "code")) : "");
}

/* Gives what has come other attributes, those with these names. */
char *
shard_sql_update(const Generation *generation, int shard, Arrival kind, char **names, int count)
{
	char	   *mesh = generation_mesh(generation, shard);
	StringInfoData query;

	initStringInfo(&query);
	appendStringInfo(&query, "SELECT id, %s", point_columns(generation->form.dimension, 0, ""));
	for (int i = 0; i < count; i++)
		appendStringInfo(&query, ", attributes[%d] AS %s", i + 1, quote_identifier(names[i]));
	appendStringInfo(&query, " FROM %s_arrivals WHERE kind = %d ORDER BY n", mesh, kind);
	return psprintf("SELECT abacus_update('%s', %s)", mesh, quote_literal_cstr(query.data));
}

/* ---- What others must know ------------------------------------------------------------------ */

/*
 * The vertices at the places where others have guests as they are now, for all other shards; or the places
 * without any. Before there are simplices, a vertex is the first of the points that wait at its place.
 */
char *
shard_sql_states(const Generation *generation, int shard, bool gone)
{
	char	   *mesh = generation_mesh(generation, shard);
	bool		flat = generation->form.dimension == 2;

	return psprintf("WITH a AS MATERIALIZED (SELECT DISTINCT x, y, z FROM %1$s_arrivals WHERE kind = %2$d), "
					"waiting AS MATERIALIZED (SELECT DISTINCT ON (x, y, z) id, x, y, coalesce(z, 0) AS z, attributes "
					"FROM abacus_vertices('%1$s') WHERE (SELECT value FROM abacus_stats('%1$s') WHERE name = 'simplices') = 0 "
					"ORDER BY x, y, z, sequence), "
					"state AS MATERIALIZED (SELECT coalesce(n.vertex, w.id) AS id, a.x, a.y, a.z, coalesce(n.attributes, w.attributes) "
					"AS attributes FROM a LEFT JOIN LATERAL abacus_nearest('%1$s', a.x, a.y, %3$s1) AS n "
					"ON n.x = a.x AND n.y = a.y AND coalesce(n.z, 0) = a.z "
					"LEFT JOIN waiting AS w ON w.x = a.x AND w.y = a.y AND w.z = a.z) "
					"SELECT s, coalesce(id, 0), x, y, z, coalesce(attributes, '{}') FROM state "
					"CROSS JOIN generate_series(0, %4$d) AS s WHERE s <> %5$d AND id IS %6$s",
					mesh, ARRIVES_ASKED, flat ? "" : "a.z, ", generation->shards - 1, shard, gone ? "NULL" : "NOT NULL");
}

/* The vertices that others need since simplices are new; or all that they need. */
char *
shard_sql_exports_around(const Generation *generation, int shard, bool all)
{
	char	   *mesh = generation_mesh(generation, shard);
	char	   *arguments = shard_sql_arguments(generation, shard);
	const char *columns = "shard, id, x, y, coalesce(z, 0) AS z, attributes";

	if (all)
		return psprintf("SELECT DISTINCT ON (1, 3, 4, 5) %s FROM abacus_shard_exports(%s)", columns, arguments);
	return psprintf("SELECT DISTINCT ON (1, 3, 4, 5) %s FROM abacus_shard_exports_around(%s, %s)", columns, arguments,
					quote_literal_cstr(psprintf("SELECT DISTINCT 0::bigint, %s FROM %s_arrivals",
												point_columns(generation->form.dimension, 0, ""), mesh)));
}

/* ---- The end -------------------------------------------------------------------------------- */

char *
shard_sql_clear(const Generation *generation, int shard)
{
	return psprintf("DELETE FROM %s_arrivals", generation_mesh(generation, shard));
}

char *
shard_sql_set_version(const Generation *generation, int shard)
{
	return psprintf("UPDATE %s_version SET version = " INT64_FORMAT, generation_mesh(generation, shard),
					generation->versions[shard]);
}
