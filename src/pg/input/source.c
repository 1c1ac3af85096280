/*
 * source.c: the user's query, read through a portal in batches.
 *
 * SPI parses, plans and opens it with the caller's rights, read-only. The rows go from
 * the executor straight into a DestReceiver (row_packer.c). So no row is copied into a
 * tuple table, and the result is never held as a whole.
 *
 * From source_prepare() to source_finish() SPI is connected.
 */
#include "postgres.h"

#include <ctype.h>

#include "common/keywords.h"
#include "mb/pg_wchar.h"
#include "nodes/nodeFuncs.h"
#include "nodes/parsenodes.h"
#include "tcop/pquery.h"
#include "utils/memutils.h"
#include "utils/plancache.h"
#include "utils/portal.h"

#include "pg/input/source.h"

#define ROWS_A_BATCH 1024

static CachedPlanSource *
plan_source(const Source *source)
{
	return linitial(SPI_plan_get_plan_sources(source->plan));
}

/* Whether a query, or one inside it, locks rows. */
static bool
locks_rows(Node *node, void *context)
{
	if (node == NULL)
		return false;
	if (!IsA(node, Query))
		return expression_tree_walker(node, locks_rows, context);
	return ((Query *) node)->rowMarks != NIL ||
		query_tree_walker((Query *) node, locks_rows, context, 0);
}

/* Skips a comment, with nested ones; returns the text unchanged if there is none. */
static const char *
skip_comment(const char *text)
{
	int			depth = 0;

	if (strncmp(text, "--", 2) == 0)
		return text + strcspn(text, "\r\n");
	do
	{
		int			change = strncmp(text, "/*", 2) == 0 ? 1 : strncmp(text, "*/", 2) == 0 ? -1 : 0;

		if (depth == 0 && change <= 0)
			return text;
		depth += change;
		text += change != 0 ? 2 : 1;
	} while (depth > 0 && *text != '\0');
	return text;
}

/* Skips everything that may come before the first word: white space, comments, parentheses. */
static const char *
skip_to_word(const char *text)
{
	const char *from;

	do
	{
		from = text;
		text = skip_comment(text + strspn(text, " \t\n\r\f\v(;"));
	} while (text != from);
	return text;
}

static bool
is_word_of_sql(const char *text)
{
	char		word[NAMEDATALEN];
	int			length = 0;

	for (; length < NAMEDATALEN - 1 && (isalnum((unsigned char) *text) || *text == '_'); text++)
		word[length++] = pg_ascii_tolower((unsigned char) *text);
	word[length] = '\0';
	return ScanKeywordLookup(word, &ScanKeywords) >= 0;
}

/*
 * A text that does not begin with a word of SQL is not a query. Most often it is a value that
 * PostgreSQL has implicitly cast to text, such as a geometry.
 */
static void
check_is_query(const char *query)
{
	const int	most = 40;
	const char *word = skip_to_word(query);
	int			length = pg_mbcliplen(query, strlen(query), most);

	if (*word == '\0' || is_word_of_sql(word))
		return;
	ereport(ERROR,
			(errcode(ERRCODE_SYNTAX_ERROR),
			 errmsg("this is not a query: \"%.*s%s\"", length, query,
					query[length] == '\0' ? "" : "..."),
			 errdetail("A query begins with SELECT, VALUES, TABLE or WITH."),
			 errhint("For a geometry give its coordinates, ST_X(geom) and ST_Y(geom), or, with the "
					 "extension abacus_postgis, a value of type geometry.")));
}

/* Parses the query; rejects everything but one plain SELECT. */
void
source_prepare(Source *source, const char *query)
{
	List	   *sources;
	bool		selects;

	MemSet(source, 0, sizeof(*source));
	source->query = query;
	check_is_query(query);
	SPI_connect();
	source->plan = SPI_prepare_cursor(query, 0, NULL, CURSOR_OPT_NO_SCROLL);
	if (source->plan == NULL)
		elog(ERROR, "could not prepare the query: %s", SPI_result_code_string(SPI_result));

	sources = SPI_plan_get_plan_sources(source->plan);
	selects = list_length(sources) == 1;
	if (selects)
	{
		List	   *queries = plan_source(source)->query_list;
		Query	   *parsed = list_length(queries) == 1 ? linitial_node(Query, queries) : NULL;

		selects = parsed != NULL && parsed->commandType == CMD_SELECT &&
			!parsed->hasModifyingCTE && !locks_rows((Node *) parsed, NULL);
	}
	if (!selects)
		ereport(ERROR,
				(errcode(ERRCODE_INVALID_PARAMETER_VALUE),
				 errmsg("source query must be a single SELECT that changes and locks nothing"),
				 errhint("For example: SELECT id, x, y FROM points.")));
}

int
source_columns(const Source *source)
{
	return plan_source(source)->resultDesc->natts;
}

/* The first column after id and coordinates; a geometry may replace the coordinates. */
int
source_first_attribute(const Source *source, uint32 dimension)
{
	return row_packer_takes_geometry(plan_source(source)->resultDesc) ? 2 : 1 + (int) dimension;
}

/* An error if there are none after the coordinates. */
void
source_require_attributes(const Source *source, uint32 dimension)
{
	if (source_columns(source) <= source_first_attribute(source, dimension))
		ereport(ERROR,
				(errcode(ERRCODE_DATATYPE_MISMATCH),
				 errmsg("source query has no column for an attribute"),
				 errhint("After the id and the coordinates, add columns that are named after attributes.")));
}

const char *
source_column_name(const Source *source, int column)
{
	return NameStr(TupleDescAttr(plan_source(source)->resultDesc, column)->attname);
}

/*
 * Starts reading points for a mesh with these names. If the points come to stay, a mesh without
 * SRID takes the geometries' SRID.
 */
void
source_open(Source *source, abacus_names names, bool takes_srid)
{
	source->portal = SPI_cursor_open(NULL, source->plan, NULL, NULL, true);
	source->packer = row_packer_create(source->portal->tupDesc, names, takes_srid, ROWS_A_BATCH);
}

/* Starts reading places: points without attributes; other columns are ignored. */
void
source_open_places(Source *source, abacus_names names)
{
	source->portal = SPI_cursor_open(NULL, source->plan, NULL, NULL, true);
	source->packer = row_packer_create_places(source->portal->tupDesc, names, ROWS_A_BATCH);
}

/* Starts reading simplices, by the ids of their vertices. */
void
source_open_simplices(Source *source, abacus_names names)
{
	source->portal = SPI_cursor_open(NULL, source->plan, NULL, NULL, true);
	source->packer = row_packer_create_simplices(source->portal->tupDesc, names, ROWS_A_BATCH);
}

/* Starts reading simplices of a mesh, by code and ids, with the given labels. */
void
source_open_labels(Source *source, abacus_names names)
{
	source->portal = SPI_cursor_open(NULL, source->plan, NULL, NULL, true);
	source->packer = row_packer_create_labels(source->portal->tupDesc, names, ROWS_A_BATCH);
}

/*
 * Starts reading facets of a mesh, each by a simplex and the corner opposite, with their markers.
 */
void
source_open_facets(Source *source, abacus_names names)
{
	source->portal = SPI_cursor_open(NULL, source->plan, NULL, NULL, true);
	source->packer = row_packer_create_facets(source->portal->tupDesc, names, ROWS_A_BATCH);
}

/* Starts reading facets of simplices that are loaded, by the ids of their vertices, and markers. */
void
source_open_loaded_facets(Source *source, abacus_names names)
{
	source->portal = SPI_cursor_open(NULL, source->plan, NULL, NULL, true);
	source->packer = row_packer_create_loaded_facets(source->portal->tupDesc, names, ROWS_A_BATCH);
}

/* Starts reading lines of a triangulation that is loaded: each edge by its line and two ids. */
void
source_open_loaded_lines(Source *source, abacus_names names)
{
	source->portal = SPI_cursor_open(NULL, source->plan, NULL, NULL, true);
	source->packer = row_packer_create_loaded_lines(source->portal->tupDesc, names, ROWS_A_BATCH);
}

/* Starts reading values of vertices, by their ids. */
void
source_open_values(Source *source)
{
	source->portal = SPI_cursor_open(NULL, source->plan, NULL, NULL, true);
	source->packer = row_packer_create_values(source->portal->tupDesc, ROWS_A_BATCH);
}

/* Starts reading rows for an octree; see row_packer_create_octants(). */
void
source_open_octants(Source *source, abacus_names names, OctantRows rows, bool takes_srid)
{
	source->portal = SPI_cursor_open(NULL, source->plan, NULL, NULL, true);
	source->packer = row_packer_create_octants(source->portal->tupDesc, names, rows, takes_srid,
											   ROWS_A_BATCH);
}

/* Errors while reading quote the query, as SPI's errors do. */
static void
describe_query(void *query)
{
	errcontext("SQL statement \"%s\"", (const char *) query);
}

/* Reads the next records, which stay valid until the next call; 0 at the end. */
size_t
source_fetch(Source *source, const uint64 **points)
{
	ErrorContextCallback context = {error_context_stack, describe_query,
									unconstify(char *, source->query)};

	error_context_stack = &context;
	row_packer_reset(source->packer);
	PortalRunFetch(source->portal, FETCH_FORWARD, ROWS_A_BATCH, &source->packer->receiver);
	error_context_stack = context.previous;
	*points = source->packer->points;
	return source->packer->count;
}

void
source_close(Source *source)
{
	SPI_cursor_close(source->portal);
	source->portal = NULL;
}

void
source_finish(Source *source)
{
	SPI_finish();
}
