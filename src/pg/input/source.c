/*
 * source.c: the user's query, read through a portal in batches.
 *
 * SPI parses, plans and opens it as the caller, read-only; the rows then go
 * from the executor straight into a DestReceiver (row_packer.c), so no row is
 * ever copied into a tuple table and the result is never held as a whole.
 *
 * From source_prepare() to source_finish() SPI is connected.
 */
#include "postgres.h"

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

/* Whether a query, or one within it, locks rows. */
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

/* Parses the query; anything but one plain SELECT is refused. */
void
source_prepare(Source *source, const char *query)
{
	List	   *sources;
	bool		selects;

	MemSet(source, 0, sizeof(*source));
	source->query = query;
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

const char *
source_column_name(const Source *source, int column)
{
	return NameStr(TupleDescAttr(plan_source(source)->resultDesc, column)->attname);
}

/* Starts reading points for a mesh with this header. */
void
source_open(Source *source, const abacus_header *header)
{
	source->portal = SPI_cursor_open(NULL, source->plan, NULL, NULL, true);
	source->packer = row_packer_create(source->portal->tupDesc, header, ROWS_A_BATCH);
}

/* Starts reading simplices, by the ids of their vertices. */
void
source_open_simplices(Source *source, const abacus_header *header)
{
	source->portal = SPI_cursor_open(NULL, source->plan, NULL, NULL, true);
	source->packer = row_packer_create_simplices(source->portal->tupDesc, header, ROWS_A_BATCH);
}

/* Errors while reading say which query they come from, as SPI's do. */
static void
describe_query(void *query)
{
	errcontext("SQL statement \"%s\"", (const char *) query);
}

/* Reads on; the records stay valid until the next call. 0 at the end. */
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
