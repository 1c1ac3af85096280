/*
 * fn_constrain.c: abacus_constrain, which gives a mesh lines, and abacus_unconstrain, which takes
 * them away.
 */
#include "postgres.h"

#include "utils/builtins.h"

#include "pg/base/sql_function.h"
#include "pg/lines/line_rows.h"
#include "pg/lines/new_lines.h"
#include "pg/mesh/lines_table.h"
#include "pg/mesh/mesh_lines.h"
#include "pg/sql/arguments/word.h"
#include "pg/track/by_hand.h"

SQL_FUNCTION(abacus_sql_constrain);
SQL_FUNCTION(abacus_sql_unconstrain);

static const char *const kinds[] = {"hard", "soft", NULL};

/* In the order of ExistingLines. */
static const char *const existing_words[] = {"error", "replace", NULL};

static Relation
mesh_of(const Change *change)
{
	return mesh_pages(change->writer.host)->simplices.heap;
}

/* abacus_constrain(mesh regclass, query text, kind text, existing text, z text) -> bigint */
Datum
abacus_sql_constrain(PG_FUNCTION_ARGS)
{
	static const NewPoints points = {.allow = by_hand_refuse_points};
	const char *kind;
	const char *z = NULL;
	int			existing;
	Source		source;
	Change	   *change;
	uint64		lines;

	if (PG_ARGISNULL(0) || PG_ARGISNULL(1))
		ereport(ERROR,
				(errcode(ERRCODE_NULL_VALUE_NOT_ALLOWED),
				 errmsg("mesh and query must not be NULL")));
	kind = kinds[word_argument(fcinfo, 2, kinds, "kind", "Use 'hard' or 'soft'.")];
	existing = word_argument(fcinfo, 3, existing_words, "existing", "Use 'error' or 'replace'.");
	if (!PG_ARGISNULL(4))
		z = text_to_cstring(PG_GETARG_TEXT_PP(4));
	source_prepare(&source, text_to_cstring(PG_GETARG_TEXT_PP(1)));
	change = change_begin(PG_GETARG_OID(0), "abacus_constrain()");
	new_lines_check_mesh(change);
	by_hand_refuse_lines(change);
	lines = new_lines_add(change, &source, new_lines_vertices(fcinfo->flinfo->fn_oid, PG_GETARG_OID(0)),
						  kind, existing, z, &points);
	if (lines > 0)
		change_end(change);
	else
		change_abandon(change);
	source_finish(&source);
	PG_RETURN_INT64((int64) lines);
}

/* ---- abacus_unconstrain ------------------------------------------------------------------ */

static void
tell_of_unknown(const Change *change, uint64 ids, uint64 gone)
{
	if (ids > gone)
		ereport(NOTICE,
				(errmsg_plural("mesh \"%s\" has no line for " UINT64_FORMAT " id",
							   "mesh \"%s\" has no lines for " UINT64_FORMAT " ids",
							   (unsigned long) (ids - gone), RelationGetRelationName(mesh_of(change)),
							   ids - gone)));
}

/* Removes the lines whose ids have been read; returns how many there were. */
static uint64
remove_lines(Change *change)
{
	Oid			table = lines_table_of(mesh_of(change), change->writer.header->facts.census.lines);
	uint64		gone = 0;
	int64		soft = 0;
	Datum		ids;
	bool		isnull;
	int			level = plain_names_begin(true);

	query_first("SELECT count(DISTINCT line) FROM " LINE_IDS, &ids, &isnull, 1);
	if (OidIsValid(table))
		gone = new_lines_delete(change, lines_table_name(table), "SELECT line FROM " LINE_IDS, &soft);
	plain_names_end(level);
	tell_of_unknown(change, (uint64) DatumGetInt64(ids), gone);
	if (gone > 0)
	{
		change_unfix(change);
		change_lines(change, -(int64) gone, -soft);
		mesh_lines_notice_waiting(&change->writer);
	}
	return gone;
}

/* abacus_unconstrain(mesh regclass, query text) -> bigint */
Datum
abacus_sql_unconstrain(PG_FUNCTION_ARGS)
{
	Source		source;
	Change	   *change;
	NamedRows  *ids;
	uint64		gone = 0;

	source_prepare(&source, text_to_cstring(PG_GETARG_TEXT_PP(1)));
	change = change_begin(PG_GETARG_OID(0), "abacus_unconstrain()");
	new_lines_check_mesh(change);
	by_hand_refuse_lines(change);
	ids = line_ids_read(&source);
	named_rows_register(ids);
	if (ids->count > 0)
		gone = remove_lines(change);
	if (gone > 0)
		change_end(change);
	else
		change_abandon(change);
	named_rows_free(ids);
	source_finish(&source);
	PG_RETURN_INT64((int64) gone);
}
