/*
 * step.c: a step of a solution, whose values are read in place of the attributes of a mesh.
 *
 * Values are found by the id of their vertex, by queries of the table of steps, so with the caller's privileges
 * and what the active snapshot sees. Ranks store parts as they got their shares, along the curve. So the rows in
 * the block of a row are near it in space, and the core gets all of them together, like a page. It keeps no more
 * of them than it has room for.
 *
 * Queries have operators with their schema: they are planned once, and the search path may change.
 */
#include "postgres.h"

#include <math.h>

#include "access/table.h"
#include "access/xact.h"
#include "catalog/pg_type.h"
#include "executor/spi.h"
#include "fmgr.h"
#include "miscadmin.h"
#include "utils/array.h"
#include "utils/builtins.h"
#include "utils/lsyscache.h"
#include "utils/memutils.h"
#include "utils/snapmgr.h"

#include "pg/base/snapshot_mark.h"
#include "pg/lines/named_rows.h"
#include "pg/mesh/lines_table.h"
#include "pg/steps/step.h"

struct Step
{
	uint32		values;			/* of a vertex */
	abacus_facts facts;			/* of the mesh, with these values as attributes */
	char		(*names)[ABACUS_NAME_BYTES];	/* of them: their numbers */
	SPIPlanPtr	row;			/* ctid and values of an id */
	SPIPlanPtr	block;			/* ids and values from a ctid up to another */
	MemoryContextCallback ending;
	HostPageFunctions functions;
	double		page[ABACUS_MAX_PAGE_BYTES / sizeof(double)];
};

static void
free_plans(void *argument)
{
	Step	   *step = argument;

	if (step->row != NULL)
		SPI_freeplan(step->row);
	if (step->block != NULL)
		SPI_freeplan(step->block);
}

/* Why a step cannot be read: not all parts are there, or they do not belong together. */
static void
refuse_parts(Oid mesh, int64 number, int32 parts, int32 stored)
{
	ereport(ERROR,
			(errcode(ERRCODE_OBJECT_NOT_IN_PREREQUISITE_STATE),
			 errmsg("step " INT64_FORMAT " of mesh \"%s\" is not whole", number, get_rel_name(mesh)),
			 stored < parts ? errdetail("%d of its %d parts are stored.", stored, parts)
			 : errdetail("Its parts were not cut in the same way from the same state of the mesh, or have different numbers of values."),
			 errhint("SELECT max(step) FROM abacus_steps(%s) WHERE whole finds the last whole step.",
					 quote_literal_cstr(quote_identifier(get_rel_name(mesh))))));
}

/* Reads what the parts of a step say, which must be whole. Returns the number of its values. */
static int32
read_marks(Oid mesh, const char *table, int64 number, uint64 stamp)
{
	enum
	{
		NUMBER, PARTS, STORED, VERTICES, WHOLE, WIDTH, UPPER, LOWER, COLUMNS
	};
	Datum		values[COLUMNS];
	bool		isnull[COLUMNS];
	uint64		of;

	if (table == NULL ||
		!query_first(psprintf(STEPS_QUERY, table, psprintf(" AND step = '" INT64_FORMAT "'", number)), values, isnull, COLUMNS))
		ereport(ERROR,
				(errcode(ERRCODE_UNDEFINED_OBJECT),
				 errmsg("mesh \"%s\" has no step " INT64_FORMAT, get_rel_name(mesh), number),
				 errhint("abacus_steps(%s) shows which steps are stored.",
						 quote_literal_cstr(quote_identifier(get_rel_name(mesh))))));
	for (int i = 0; i < COLUMNS; i++)
		if (isnull[i])
			ereport(ERROR,
					(errcode(ERRCODE_DATA_CORRUPTED),
					 errmsg("step " INT64_FORMAT " of mesh \"%s\" is not as abacus_store() writes it", number,
							get_rel_name(mesh)),
					 errhint("Store its parts again.")));
	if (!DatumGetBool(values[WHOLE]))
		refuse_parts(mesh, number, DatumGetInt32(values[PARTS]), DatumGetInt32(values[STORED]));
	of = (uint64) DatumGetInt64(values[UPPER]) << 32 | (uint64) DatumGetInt64(values[LOWER]);
	if (of != stamp)
		ereport(NOTICE,
				(errmsg("mesh \"%s\" has changed since step " INT64_FORMAT " was stored", get_rel_name(mesh), number),
				 errdetail("Vertices that the step lacks have no value.")));
	return DatumGetInt32(values[WIDTH]);
}

/* The table of steps of a mesh as a name in SQL, checked; NULL if there is none. */
static char *
table_name(Oid mesh)
{
	Relation	rel = mesh_table_open(mesh, MESH_READ);
	Oid			table = mesh_rows_table(rel, MESH_STEPS, MESH_READ);

	table_close(rel, NoLock);
	return OidIsValid(table) ? lines_table_name(table) : NULL;
}

/* The first row of a query of a mesh's steps, %s in it; false if it has none, or there is no table. */
static bool
ask(Oid mesh, const char *query, Datum *values, bool *isnull, int count)
{
	char	   *table = table_name(mesh);
	bool		found;
	int			level;

	if (table == NULL)
		return false;
	SPI_connect();
	level = plain_names_begin(false);
	found = query_first(psprintf(query, table), values, isnull, count);
	plain_names_end(level);
	SPI_finish();
	return found;
}

/* A text that changes when a part of the step is stored again. */
char *
step_tag(Oid mesh, int64 number)
{
	Datum		hash;
	bool		isnull;

	if (!ask(mesh, psprintf("SELECT hashtext(string_agg(concat(part, ' ', tableoid, ctid, xmin), ',' ORDER BY part)) "
							"FROM %%s WHERE step = '" INT64_FORMAT "' AND id IS NULL", number), &hash, &isnull, 1) || isnull)
		return psprintf(INT64_FORMAT, number);
	return psprintf(INT64_FORMAT "-%08x", number, DatumGetUInt32(hash));
}

/* The least and the greatest of the n-th values of a step, counted from 0; false if none is finite. */
bool
step_range(Oid mesh, int64 number, int value, double *range)
{
	Datum		values[2];
	bool		isnull[2];

	if (!ask(mesh, psprintf("SELECT min(v), max(v) FROM (SELECT \"values\"[%d] AS v FROM %%s WHERE step = '" INT64_FORMAT
							"' AND id IS NOT NULL) AS s WHERE abs(v) < 'Infinity'", value + 1, number), values, isnull, 2) ||
		isnull[0])
		return false;
	range[0] = DatumGetFloat8(values[0]);
	range[1] = DatumGetFloat8(values[1]);
	return true;
}

static SPIPlanPtr
prepare(const char *query, int arguments, Oid type)
{
	SPIPlanPtr	plan = SPI_prepare(query, arguments, (Oid[2]) {type, type});

	if (plan == NULL || SPI_keepplan(plan) != 0)
		elog(ERROR, "could not prepare \"%s\": %s", query, SPI_result_code_string(SPI_result));
	return plan;
}

/* The numbers of the values as names. */
static void
name_values(Step *step, const abacus_facts *facts, MemoryContext memory)
{
	step->facts = *facts;
	step->facts.columns.in_pages = facts->columns.apart ? 0 : facts->columns.attributes;
	step->facts.columns.by_id = 1;
	step->facts.columns.apart = 0;
	step->facts.columns.attributes = step->values;
	step->names = MemoryContextAllocZero(memory, Max(1, step->values) * sizeof(*step->names));
	for (uint32 i = 0; i < step->values; i++)
		pg_ultoa_n(i + 1, step->names[i]);
}

/* Opens a step of a mesh, which must be whole, with what the active snapshot sees. It lives in `memory`. */
Step *
step_open(Oid mesh, const abacus_header *header, int64 number, MemoryContext memory)
{
	Step	   *step = MemoryContextAllocZero(memory, sizeof(Step));
	char	   *name = table_name(mesh);
	int32		width;
	int			level;

	SPI_connect();
	level = plain_names_begin(false);
	width = read_marks(mesh, name, number, header->stamp);
	plain_names_end(level);
	if (width < 0 || width > ABACUS_MAX_ATTRIBUTES)
		ereport(ERROR,
				(errcode(ERRCODE_PROGRAM_LIMIT_EXCEEDED),
				 errmsg("step " INT64_FORMAT " has %d values at each vertex", number, width),
				 errdetail("At most %d can be read in place of attributes.", ABACUS_MAX_ATTRIBUTES),
				 errhint("Join the table of steps with abacus_weights().")));
	step->values = (uint32) width;
	name_values(step, &header->facts, memory);
	step->ending.func = free_plans;
	step->ending.arg = step;
	MemoryContextRegisterResetCallback(memory, &step->ending);
	step->row = prepare(psprintf("SELECT ctid, \"values\" FROM %s WHERE step OPERATOR(pg_catalog.=) '" INT64_FORMAT
								 "'::pg_catalog.int8 AND id OPERATOR(pg_catalog.=) $1", name, number), 1, INT8OID);
	step->block = prepare(psprintf("SELECT id, \"values\" FROM %s WHERE step OPERATOR(pg_catalog.=) '" INT64_FORMAT
								   "'::pg_catalog.int8 AND id IS NOT NULL AND ctid OPERATOR(pg_catalog.>=) $1 "
								   "AND ctid OPERATOR(pg_catalog.<) $2", name, number), 2, TIDOID);
	SPI_finish();
	return step;
}

/* A step in the state of a function that is called for each row. */
typedef struct StepOfCall
{
	MemoryContext memory;		/* of the step */
	Step	   *step;
	Oid			mesh;
	int64		number;
	Oid			user;
	SubTransactionId within;	/* an abort takes a step back without a trace in the snapshot */
	SnapshotMark valid;
} StepOfCall;

/* A step that the calls of a function share: opened anew if the snapshot may see another one. */
Step *
step_of_call(FunctionCallInfo fcinfo, Oid mesh, const abacus_header *header, int64 number)
{
	StepOfCall *call = fcinfo->flinfo->fn_extra;

	if (call == NULL)
	{
		call = MemoryContextAllocZero(fcinfo->flinfo->fn_mcxt, sizeof(StepOfCall));
		call->memory = AllocSetContextCreate(fcinfo->flinfo->fn_mcxt, "Abacus step", ALLOCSET_DEFAULT_SIZES);
		fcinfo->flinfo->fn_extra = call;
	}
	if (call->step == NULL || call->mesh != mesh || call->number != number || call->user != GetUserId() ||
		call->within != GetCurrentSubTransactionId() || !same_snapshot(&call->valid, GetActiveSnapshot()))
	{
		call->step = NULL;
		MemoryContextReset(call->memory);
		call->step = step_open(mesh, header, number, call->memory);
		call->mesh = mesh;
		call->number = number;
		call->user = GetUserId();
		call->within = GetCurrentSubTransactionId();
		mark_snapshot(&call->valid, GetActiveSnapshot(), fcinfo->flinfo->fn_mcxt);
	}
	return call->step;
}

/* The values as attributes of the mesh. */
abacus_names
step_names(const Step *step)
{
	return (abacus_names) {&step->facts, (const char (*)[ABACUS_NAME_BYTES]) step->names};
}

/* The elements of a row's array; those that are missing are NaN. */
static void
take_values(const Step *step, HeapTuple row, double *values)
{
	bool		isnull;
	Datum		value = SPI_getbinval(row, SPI_tuptable->tupdesc, 2, &isnull);
	ArrayType  *array = isnull ? NULL : DatumGetArrayTypeP(value);
	int			count = isnull ? 0 : ArrayGetNItems(ARR_NDIM(array), ARR_DIMS(array));

	if (isnull || ARR_HASNULL(array))
	{
		Datum	   *elements = NULL;
		bool	   *missing = NULL;

		if (!isnull)
			deconstruct_array(array, FLOAT8OID, sizeof(float8), FLOAT8PASSBYVAL, TYPALIGN_DOUBLE, &elements, &missing,
							  &count);
		for (uint32 i = 0; i < step->values; i++)
			values[i] = i < (uint32) count && !missing[i] ? DatumGetFloat8(elements[i]) : NAN;
		return;
	}
	memcpy(values, ARR_DATA_PTR(array), Min((uint32) count, step->values) * sizeof(double));
	for (uint32 i = (uint32) count; i < step->values; i++)
		values[i] = NAN;
}

/* Runs a query of the step, whose rows are then in SPI_tuptable. */
static uint64
run(SPIPlanPtr plan, Datum *arguments)
{
	int			status = SPI_execute_plan(plan, arguments, NULL, true, 0);

	if (status != SPI_OK_SELECT)
		elog(ERROR, "could not read a step: %s", SPI_result_code_string(status));
	return SPI_processed;
}

/* The row of an id; false if the step has none. SPI is connected. */
static bool
find_row(Step *step, int64 id, double *values, ItemPointer place)
{
	Datum		argument = Int64GetDatum(id);
	bool		isnull;

	if (run(step->row, &argument) == 0)
		return false;
	take_values(step, SPI_tuptable->vals[0], values);
	*place = *(ItemPointer) DatumGetPointer(SPI_getbinval(SPI_tuptable->vals[0], SPI_tuptable->tupdesc, 1, &isnull));
	SPI_freetuptable(SPI_tuptable);
	return true;
}

/* The values of a vertex; false, and all NaN, if the step has none. */
bool
step_find(Step *step, int64 id, double *values)
{
	ItemPointerData place;
	bool		found;

	SPI_connect();
	found = find_row(step, id, values, &place);
	SPI_finish();
	for (uint32 i = 0; !found && i < step->values; i++)
		values[i] = NAN;
	return found;
}

/* Adds the other rows of the block as far as there is room. Returns how many rows there are then. */
static size_t
add_block(Step *step, BlockNumber block, size_t room)
{
	size_t		count = 1;
	size_t		words = 1 + step->values;
	ItemPointerData first,
				end;
	uint64		rows;

	ItemPointerSet(&first, block, 0);
	ItemPointerSet(&end, block + 1, 0);
	rows = run(step->block, (Datum[2]) {PointerGetDatum(&first), PointerGetDatum(&end)});
	for (uint64 i = 0; i < rows && count < room; i++)
	{
		bool		isnull;
		int64		id = DatumGetInt64(SPI_getbinval(SPI_tuptable->vals[i], SPI_tuptable->tupdesc, 1, &isnull));

		if (memcmp(&id, step->page, sizeof(id)) == 0)
			continue;
		memcpy(&step->page[count * words], &id, sizeof(id));
		take_values(step, SPI_tuptable->vals[i], &step->page[count * words + 1]);
		count++;
	}
	SPI_freetuptable(SPI_tuptable);
	return count;
}

/* For the core: ABACUS_STEP_PAGES. */
static bool
find_page(void *owner, abacus_page_kind kind, abacus_key key, abacus_page *page)
{
	Step	   *step = owner;
	size_t		row = (1 + step->values) * sizeof(double);
	int64		id = (int64) key.code;
	ItemPointerData place;
	size_t		count = 1;

	SPI_connect();
	if (!find_row(step, id, step->page + 1, &place))
	{
		SPI_finish();
		return false;
	}
	memcpy(step->page, &id, sizeof(id));
	if (2 * row <= sizeof(step->page))
		count = add_block(step, ItemPointerGetBlockNumber(&place), sizeof(step->page) / row);
	SPI_finish();
	page->key = key;
	page->bytes = (const unsigned char *) step->page;
	page->size = count * row;
	page->location = 0;
	return true;
}

/* From here on, the core and the names of the header take the step for the attributes of the mesh. */
void
step_replaces_attributes(Step *step, Host *host, abacus_header *header)
{
	uint32		before = header->facts.columns.attributes;
	uint32		labels = header->facts.columns.labels;

	memmove(header->names[step->values], header->names[before], labels * sizeof(header->names[0]));
	memmove(header->types + step->values, header->types + before, labels);
	memcpy(header->names, step->names, step->values * sizeof(header->names[0]));
	memset(header->types, ABACUS_FLOAT8, step->values);
	header->facts.columns = step->facts.columns;
	step->functions = host_no_pages;
	step->functions.find = find_page;
	host_register_pages(host, ABACUS_STEP_PAGES, &step->functions, step);
}
