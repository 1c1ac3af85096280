/*
 * kept.c: what a thinned mesh keeps on wish, from an argument.
 */
#include "postgres.h"

#include "catalog/pg_type.h"
#include "executor/spi.h"
#include "utils/builtins.h"
#include "utils/lsyscache.h"

#include "pg/base/settings.h"
#include "pg/input/source.h"
#include "pg/lines/named_rows.h"
#include "pg/mesh/lines_table.h"
#include "pg/sql/thin/kept.h"

/* Ids that are looked for in one pass take this share of the memory for sorting. */
#define IDS_SHARE 4
#define IDS_A_FETCH 1024

/* Whether a text begins as a query does, which no word of keep does. */
static bool
begins_as_query(const char *text)
{
	static const char *const words[] = {"select", "values", "table", "with", "--", "/*"};

	text += strspn(text, " \t\n\r(");
	for (int i = 0; i < lengthof(words); i++)
		if (pg_strncasecmp(text, words[i], strlen(words[i])) == 0)
			return true;
	return false;
}

/*
 * Words, separated by commas, or else a query. Without words that say otherwise, lines are kept.
 */
void
kept_parse(const char *argument, Kept *kept)
{
	char	   *rest = pstrdup(argument != NULL ? argument : "lines");
	char	   *word;
	bool		none = false;

	memset(kept, 0, sizeof(*kept));
	if (begins_as_query(rest))
	{
		kept->query = argument;
		kept->lines = true;
		return;
	}
	while ((word = strsep(&rest, ",")) != NULL)
	{
		word += strspn(word, " \t\n\r");
		word[strcspn(word, " \t\n\r")] = '\0';
		if (strcmp(word, "border") == 0)
			kept->border = true;
		else if (strcmp(word, "lines") == 0)
			kept->lines = true;
		else if (strcmp(word, "none") == 0)
			none = true;
		else
			ereport(ERROR,
					(errcode(ERRCODE_INVALID_PARAMETER_VALUE),
					 errmsg("keep \"%s\" is not known", argument),
					 errhint("Use 'border', 'lines', 'border, lines', 'none', or a query of ids.")));
	}
	if (none && (kept->border || kept->lines))
		ereport(ERROR,
				(errcode(ERRCODE_INVALID_PARAMETER_VALUE),
				 errmsg("keep must not be \"%s\"", argument),
				 errhint("Use 'none' alone.")));
}

static void
check_ids(const Source *source, TupleDesc desc)
{
	Oid			type = source_columns(source) == 1 ? TupleDescAttr(desc, 0)->atttypid : InvalidOid;

	if (type != INT2OID && type != INT4OID && type != INT8OID)
		ereport(ERROR,
				(errcode(ERRCODE_DATATYPE_MISMATCH),
				 errmsg("the query of keep must return ids"),
				 errdetail("Rows have one integer column, the id of a vertex."),
				 errhint("Return the ids alone, as in SELECT id FROM points.")));
}

static int64
id_of(HeapTuple tuple, TupleDesc desc)
{
	bool		isnull;
	Datum		value = SPI_getbinval(tuple, desc, 1, &isnull);

	if (isnull)
		ereport(ERROR,
				(errcode(ERRCODE_NULL_VALUE_NOT_ALLOWED),
				 errmsg("the query of keep returns an id that is NULL"),
				 errhint("Leave out rows without an id.")));
	switch (TupleDescAttr(desc, 0)->atttypid)
	{
		case INT2OID:
			return DatumGetInt16(value);
		case INT4OID:
			return DatumGetInt32(value);
		default:
			return DatumGetInt64(value);
	}
}

/* Takes up to `room` ids from the query; returns how many there were. */
static size_t
fetch_ids(Portal portal, int64 *ids, size_t room)
{
	size_t		count = 0;

	while (count < room)
	{
		SPI_cursor_fetch(portal, true, (long) Min(room - count, IDS_A_FETCH));
		if (SPI_processed == 0)
			break;
		for (uint64 i = 0; i < SPI_processed; i++)
			ids[count++] = id_of(SPI_tuptable->vals[i], SPI_tuptable->tupdesc);
		SPI_freetuptable(SPI_tuptable);
	}
	return count;
}

/* Inserts the vertices with the ids of a query. */
static void
insert_ids(Thinner *thinner, const char *query)
{
	Host	   *host = thinner->writer.host;
	size_t		room = setting_sort_bytes() / IDS_SHARE / sizeof(int64);
	int64	   *ids = MemoryContextAllocHuge(host->home, room * sizeof(int64));
	size_t		count;
	uint64		unknown = 0;
	Source		source;
	Portal		portal;

	source_prepare(&source, query);
	portal = SPI_cursor_open(NULL, source.plan, NULL, NULL, true);
	check_ids(&source, portal->tupDesc);
	while ((count = fetch_ids(portal, ids, room)) > 0)
	{
		host_run(host, abacus_thin_keep, thinner->thinning, ids, count);
		thinner_step(thinner, ABACUS_THIN_KEEP);
		unknown += abacus_thin_unknown_ids(thinner->thinning);
	}
	SPI_cursor_close(portal);
	source_finish(&source);
	pfree(ids);
	if (unknown > 0)
		ereport(NOTICE,
				(errmsg_plural("mesh \"%s\" has no vertex with " UINT64_FORMAT " id of keep",
							   "mesh \"%s\" has no vertices with " UINT64_FORMAT " ids of keep",
							   (unsigned long) unknown, get_rel_name(thinner->source), unknown)));
}

/* Inserts the vertices that are kept. */
void
kept_insert(Thinner *thinner, const Kept *kept)
{
	if (kept->border)
		thinner_step(thinner, ABACUS_THIN_BORDER);
	if (kept->lines)
		thinner_step(thinner, ABACUS_THIN_LINES);
	if (kept->query != NULL)
		insert_ids(thinner, kept->query);
}

/* Gives the mesh the lines of the source, whose vertices it has. It is closed. */
void
kept_constrain(const Thinner *thinner, Oid extension_namespace)
{
	static const char *const kinds[] = {"hard", "soft"};
	const char *schema = quote_identifier(get_namespace_name(extension_namespace));
	int			level = plain_names_begin(true);

	SPI_connect();
	for (int i = 0; i < lengthof(kinds); i++)
	{
		char	   *query = psprintf("SELECT line, position, point, x, y, part FROM %s.abacus_lines(%s) "
									 "WHERE kind = '%s'", schema,
									 quote_literal_cstr(lines_table_name(thinner->source)), kinds[i]);

		if (SPI_execute(psprintf("SELECT %s.abacus_constrain(%s, %s, '%s')", schema,
								 quote_literal_cstr(lines_table_name(thinner->mesh)),
								 quote_literal_cstr(query), kinds[i]), false, 0) != SPI_OK_SELECT)
			elog(ERROR, "could not copy the lines: %s", SPI_result_code_string(SPI_result));
	}
	SPI_finish();
	plain_names_end(level);
}
