/*
 * shard_sql.c: what the coordinator says to the servers, in SQL.
 *
 * On its server a shard is an ordinary mesh of the points that it owns and of guests, and a table beside
 * it that lists the guests: <mesh>_guests. During the exchange a session also has two temporary tables:
 * what was sent in this call of abacus_shard_build(), and what is to be sent in this round. If a call ends
 * early they are gone, and the next one sends everything again: a guest that is there already is left
 * out. So each step can be repeated.
 */
#include "postgres.h"

#include "utils/builtins.h"

#include "pg/shards/point_room.h"
#include "pg/shards/shard_sql.h"

/* ---- Pieces --------------------------------------------------------------------------------- */

static char *
text_list(char **texts, int count)
{
	StringInfoData list;

	initStringInfo(&list);
	appendStringInfoString(&list, "ARRAY[");
	for (int i = 0; i < count; i++)
		appendStringInfo(&list, "%s%s", i == 0 ? "" : ", ", quote_literal_cstr(texts[i]));
	appendStringInfoString(&list, "]::text[]");
	return list.data;
}

static char *
point_literal(const abacus_form *form, const double *point)
{
	StringInfoData literal;

	initStringInfo(&literal);
	for (uint32 i = 0; i < form->dimension; i++)
		appendStringInfo(&literal, "%s%s", i == 0 ? "'{" : ",", exact_text(point[i]));
	appendStringInfoString(&literal, "}'::double precision[]");
	return literal.data;
}

/* The corners of the domain, if there is one. */
static char *
domain_literals(const abacus_form *form)
{
	if (!form->has_domain)
		return pstrdup("NULL, NULL");
	return psprintf("%s, %s", point_literal(form, form->lower), point_literal(form, form->upper));
}

static char *
border_literal(const Generation *generation)
{
	StringInfoData literal;

	initStringInfo(&literal);
	appendStringInfoString(&literal, "'{");
	for (int i = 0; i + 1 < generation->shards; i++)
		appendStringInfo(&literal, "%s" UINT64_FORMAT, i == 0 ? "" : ",", generation->borders[i]);
	appendStringInfoString(&literal, "}'::bigint[]");
	return literal.data;
}

/* The arguments of functions that look at a shard's mesh as a part of the whole. */
char *
shard_sql_arguments(const Generation *generation, int shard)
{
	const abacus_form *form = &generation->form;
	abacus_box	reach;

	generation_reach(generation, &reach);
	return psprintf("'%s', %s, %d, %s, %s", generation_mesh(generation, shard), border_literal(generation), shard,
					point_literal(form, reach.lower), point_literal(form, reach.upper));
}

/*
 * The first and the last code that the shard owns; in space the greatest code is the greatest bigint. A
 * shard that owns none ends before it begins.
 */
char *
shard_sql_stretch(const Generation *generation, int shard)
{
	int64		first = shard == 0 ? 0 : (int64) generation->borders[shard - 1];
	int64		last = shard + 1 < generation->shards ? (int64) generation->borders[shard] - 1 : PG_INT64_MAX;

	return psprintf(INT64_FORMAT ", " INT64_FORMAT, first, last);
}

/* A condition that a code is the shard's own. */
char *
shard_sql_interval(const Generation *generation, int shard, const char *code)
{
	StringInfoData condition;

	initStringInfo(&condition);
	appendStringInfo(&condition, "%s >= " UINT64_FORMAT, code, shard == 0 ? 0 : generation->borders[shard - 1]);
	if (shard + 1 < generation->shards)
		appendStringInfo(&condition, " AND %s < " UINT64_FORMAT, code, generation->borders[shard]);
	return condition.data;
}

/* ---- A shard's mesh ------------------------------------------------------------------------- */

char *
shard_sql_drop(const Generation *generation, int shard)
{
	char	   *mesh = generation_mesh(generation, shard);

	return psprintf("DROP TABLE IF EXISTS %1$s, %1$s_guests, %1$s_arrivals, %1$s_version", mesh);
}

/* Makes the mesh, without points. */
char *
shard_sql_begin(const Generation *generation, int shard)
{
	const abacus_form *form = &generation->form;
	char	   *mesh = generation_mesh(generation, shard);

	return psprintf("%s; SELECT abacus_shard_begin('%s', %u, %s, %s, %u)::text; "
					"CREATE TABLE %s_guests (id bigint NOT NULL, x double precision, y double precision, "
					"z double precision, attributes double precision[] NOT NULL, inserted boolean NOT NULL, "
					"PRIMARY KEY (x, y, z)); "
					"CREATE UNLOGGED TABLE %s_arrivals (n bigserial, kind integer NOT NULL, id bigint NOT NULL, "
					"x double precision, y double precision, z double precision, attributes double precision[]); "
					"CREATE TABLE %s_version (version bigint NOT NULL); INSERT INTO %s_version VALUES (0)",
					shard_sql_drop(generation, shard), mesh, form->dimension,
					text_list(generation->attributes, generation->attribute_count), domain_literals(form), form->srid,
					mesh, mesh, mesh, mesh);
}

/* Inserts the points that wait, and the guests that have come; returns how many guests these are. */
char *
shard_sql_take(const Generation *generation, int shard)
{
	char	   *mesh = generation_mesh(generation, shard);

	return psprintf("SELECT abacus_shard_take('%s', 'SELECT id, %s FROM %s_guests WHERE NOT inserted')",
					mesh, point_columns(generation->form.dimension, generation->attribute_count, "attributes[%d]"), mesh);
}

/* The guests have been inserted. */
char *
shard_sql_taken(const Generation *generation, int shard)
{
	return psprintf("UPDATE %s_guests SET inserted = true WHERE NOT inserted", generation_mesh(generation, shard));
}

/* ---- Points are spread ---------------------------------------------------------------------- */

/* An array of the attributes of a row. */
char *
shard_sql_attributes(int attributes)
{
	StringInfoData list;

	initStringInfo(&list);
	appendStringInfoString(&list, "ARRAY[");
	for (int i = 1; i <= attributes; i++)
		appendStringInfo(&list, "%sa%d", i == 1 ? "" : ", ", i);
	appendStringInfoString(&list, "]::double precision[]");
	return list.data;
}

/* The number of the shard that owns the point x, y[, z]. */
static char *
point_owner(const Generation *generation)
{
	const abacus_form *form = &generation->form;

	if (!form->has_domain)
		return pstrdup("0");
	return psprintf("abacus_shard_owner(%s, %s, %s, ARRAY[%s]::double precision[])", point_literal(form, form->lower),
					point_literal(form, form->upper), border_literal(generation),
					form->dimension == 2 ? "x, y" : "x, y, z");
}

/* All that follows is in one snapshot. */
char *
shard_sql_begin_spread(const Generation *generation, int shard)
{
	return psprintf("BEGIN ISOLATION LEVEL REPEATABLE READ; %s", point_room_create());
}

char *
shard_sql_survey(const Generation *generation, int shard, const char *query)
{
	return psprintf("SELECT points, attributes, least, greatest, srid, sample FROM abacus_shard_survey(%s, %u, %d, %s)",
					quote_literal_cstr(query), generation->form.dimension, shard, domain_literals(&generation->form));
}

/* Finds the rows of the server's query that others own. */
char *
shard_sql_split(const Generation *generation, int shard)
{
	return psprintf("SELECT abacus_shard_split(%d, %s, %s, %d)::text", generation->attribute_count,
					domain_literals(&generation->form), border_literal(generation), shard);
}

/* These rows. */
char *
shard_sql_split_rows(int shard)
{
	return psprintf("SELECT shard, points FROM pg_temp.abacus_points WHERE source = %d AND shard <> %d ORDER BY n", shard,
					shard);
}

/* Points of a query come, as bytes in hexadecimal form. */
char *
shard_sql_arrive(int from, int shard, const char *bytes)
{
	return psprintf("INSERT INTO pg_temp.abacus_points (source, shard, points) VALUES (%d, %d, '\\x%s')", from, shard,
					bytes);
}

/* Stages all that the server owns, in the order of the queries. */
char *
shard_sql_stage(const Generation *generation, int shard)
{
	return psprintf("SELECT abacus_shard_stage(%s)::text", shard_sql_arguments(generation, shard));
}

/* ---- The exchange --------------------------------------------------------------------------- */

const char *
shard_sql_begin_exchange(void)
{
	return "DROP TABLE IF EXISTS pg_temp.abacus_sent, pg_temp.abacus_export; "
		"CREATE TEMPORARY TABLE abacus_sent (shard integer, x double precision, y double precision, "
		"z double precision, PRIMARY KEY (shard, x, y, z)); "
		"CREATE TEMPORARY TABLE abacus_export (n bigint PRIMARY KEY, shard integer, id bigint, "
		"x double precision, y double precision, z double precision, attributes double precision[])";
}

const char *
shard_sql_end_exchange(void)
{
	return "DROP TABLE IF EXISTS pg_temp.abacus_sent, pg_temp.abacus_export";
}

/*
 * Finds what other shards need and has not been sent to them. Of equal points that wait the first
 * counts, so the rows keep their order.
 */
char *
shard_sql_export(const Generation *generation, int shard)
{
	return psprintf("DELETE FROM pg_temp.abacus_export; "
					"WITH found AS MATERIALIZED (SELECT row_number() OVER () AS n, shard, id, x, y, "
					"coalesce(z, 0) AS z, attributes FROM abacus_shard_exports(%s)), "
					"fresh AS (INSERT INTO pg_temp.abacus_sent SELECT DISTINCT shard, x, y, z FROM found "
					"ON CONFLICT DO NOTHING RETURNING shard, x, y, z), "
					"first AS (SELECT DISTINCT ON (shard, x, y, z) n, shard, id, x, y, z, attributes "
					"FROM found JOIN fresh USING (shard, x, y, z) ORDER BY shard, x, y, z, n) "
					"INSERT INTO pg_temp.abacus_export "
					"SELECT row_number() OVER (ORDER BY n), shard, id, x, y, z, attributes FROM first",
					shard_sql_arguments(generation, shard));
}

/* Counts the simplices that the shard owns. */
char *
shard_sql_count(const Generation *generation, int shard)
{
	return psprintf("SELECT abacus_shard_count(%s)", shard_sql_arguments(generation, shard));
}

/* Some of these rows. */
char *
shard_sql_exported(int64 from, int64 to)
{
	return psprintf("SELECT shard, id, x, y, z, attributes FROM pg_temp.abacus_export "
					"WHERE n > " INT64_FORMAT " AND n <= " INT64_FORMAT " ORDER BY n", from, to);
}

/* Guests come; those that are there stay as they are. */
char *
shard_sql_receive(const Generation *generation, int from, int shard, const PointBatch *batch)
{
	return psprintf("INSERT INTO %s_guests SELECT id, x, y, %s, %s, false FROM %s ORDER BY n ON CONFLICT DO NOTHING",
					generation_mesh(generation, shard), batch->dimension == 2 ? "0" : "z",
					shard_sql_attributes(batch->attributes), point_batch_rows(batch));
}

/* ---- Versions ------------------------------------------------------------------------------- */

char *
shard_sql_version(const Generation *generation, int shard)
{
	return psprintf("SELECT version FROM %s_version", generation_mesh(generation, shard));
}

/* What holds for prepared changes of the shard. */
static char *
is_prepared(const Generation *generation, int shard)
{
	return psprintf("database = pg_catalog.current_database() AND pg_catalog.starts_with(gid, '%s_')",
					generation_change_prefix(generation, shard));
}

/* Whether changes can be prepared, and how many are. */
char *
shard_sql_readiness(const Generation *generation, int shard)
{
	return psprintf("SELECT pg_catalog.current_setting('max_prepared_transactions')::bigint, "
					"(SELECT count(*) FROM pg_catalog.pg_prepared_xacts WHERE %s)", is_prepared(generation, shard));
}

char *
shard_sql_prepared(const Generation *generation, int shard)
{
	return psprintf("SELECT gid FROM pg_catalog.pg_prepared_xacts WHERE %s", is_prepared(generation, shard));
}

/* ---- The check ------------------------------------------------------------------------------ */

/* Temporary tables, for this transaction, of what goes to other servers and what comes from them. */
const char *
shard_sql_make_room(void)
{
	return "CREATE TEMPORARY TABLE abacus_arrival (n bigserial, source integer, id bigint, "
		"x double precision, y double precision, z double precision, attributes double precision[]) "
		"ON COMMIT DROP; "
		"CREATE TEMPORARY TABLE abacus_export (n bigint PRIMARY KEY, shard integer, id bigint, "
		"x double precision, y double precision, z double precision, attributes double precision[]) "
		"ON COMMIT DROP";
}

/* What another server has listed comes. */
char *
shard_sql_list_arrived(const Generation *generation, int from, int shard, const PointBatch *batch)
{
	return psprintf("INSERT INTO pg_temp.abacus_arrival (source, id, x, y, z, attributes) "
					"SELECT %d, id, x, y, %s, %s FROM %s ORDER BY n",
					from, batch->dimension == 2 ? "0" : "z", shard_sql_attributes(batch->attributes),
					point_batch_rows(batch));
}

/* How many points the shard has that it does not own, besides its guests, and how many guests are missing. */
char *
shard_sql_strangers(const Generation *generation, int shard)
{
	char	   *mesh = generation_mesh(generation, shard);

	return psprintf("WITH v AS MATERIALIZED (SELECT id, x, y, z FROM abacus_vertices('%1$s')) "
					"SELECT (SELECT count(*) FROM v WHERE %2$s <> %3$d AND NOT EXISTS "
					"(SELECT FROM %1$s_guests AS g WHERE g.x = v.x AND g.y = v.y AND g.z = coalesce(v.z, 0))) + "
					"(SELECT count(*) FROM %1$s_guests AS g WHERE g.inserted AND NOT EXISTS "
					"(SELECT FROM v WHERE g.x = v.x AND g.y = v.y AND g.z = coalesce(v.z, 0)))",
					mesh, point_owner(generation), shard);
}

/* Lists the guests, for their owners. */
char *
shard_sql_list_guests(const Generation *generation, int shard)
{
	return psprintf("INSERT INTO pg_temp.abacus_export SELECT row_number() OVER (), %s, id, x, y, z, attributes "
					"FROM %s_guests", point_owner(generation), generation_mesh(generation, shard));
}

/* How many of the guests that other shards have listed the shard does not have just so. */
char *
shard_sql_count_unknown(const Generation *generation, int shard)
{
	return psprintf("SELECT count(*) FROM pg_temp.abacus_arrival AS a WHERE NOT EXISTS "
					"(SELECT FROM abacus_vertices('%s') AS v WHERE v.x = a.x AND v.y = a.y AND coalesce(v.z, 0) = a.z "
					"AND v.id = a.id AND v.attributes = a.attributes)", generation_mesh(generation, shard));
}

/* Lists what other shards need. */
char *
shard_sql_list_exports(const Generation *generation, int shard)
{
	return psprintf("INSERT INTO pg_temp.abacus_export SELECT row_number() OVER (), shard, id, x, y, coalesce(z, 0), "
					"attributes FROM abacus_shard_exports(%s)", shard_sql_arguments(generation, shard));
}

/* How many of these the shard lacks. */
char *
shard_sql_count_missing(const Generation *generation, int shard)
{
	return psprintf("SELECT count(DISTINCT (a.x, a.y, a.z)) FROM pg_temp.abacus_arrival AS a WHERE NOT EXISTS "
					"(SELECT FROM %s_guests AS g WHERE g.x = a.x AND g.y = a.y AND g.z = a.z AND g.inserted)",
					generation_mesh(generation, shard));
}
