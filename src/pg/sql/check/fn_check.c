/*
 * fn_check.c: abacus_check, the exact verification of a mesh.
 *
 * The core verifies everything in the first call and keeps the faults. Without a readable header
 * there is no call of the core. That is also a fault and not an error, and so is a row under a key
 * that the core does not have.
 */
#include "postgres.h"

#include "access/htup_details.h"
#include "access/table.h"
#include "funcapi.h"
#include "utils/builtins.h"

#include "abacus/check.h"
#include "pg/base/settings.h"
#include "pg/base/sql_function.h"
#include "pg/mesh/numbering.h"
#include "pg/shards/shard_check.h"
#include "pg/remote/shard_read.h"
#include "pg/sql/constrain/fixed_edges.h"
#include "pg/sql/constrain/regions_fault.h"
#include "pg/sql/rows/result.h"
#include "pg/store/page_search.h"

SQL_FUNCTION(abacus_sql_check);

typedef struct Checking
{
	Host	   *host;
	bool		has_fault;		/* `fault` comes before the core's remaining faults */
	abacus_fault fault;
	int64		code;			/* of the faulty row */
} Checking;

static void
note_fault(Checking *checking, const char *kind, const int64 *key, const char *message)
{
	checking->has_fault = true;
	checking->code = key[0];
	checking->fault.kind = kind;
	checking->fault.key.part = (uint64) key[1];
	strlcpy(checking->fault.message, message, sizeof(checking->fault.message));
}

/* Notes a header that is missing or damaged; true if it is sound. */
static bool
read_header(Checking *checking, abacus_header *header)
{
	Host	   *host = checking->host;
	StoredPage	row;

	if (!header_find(host, &row))
		note_fault(checking, "header", header_key, "the header row (-1, 0) is missing");
	else if (header_try_decode(host, &row, header) != ABACUS_OK)
		note_fault(checking, "header", header_key,
				   host->failure.detail[0] != '\0' ? host->failure.detail : host->failure.message);
	return !checking->has_fault;
}

/* Notes a damaged row with the numbering of attributes. */
static void
check_numbers(Checking *checking, const abacus_columns *columns)
{
	Numbering  *numbering = palloc(sizeof(Numbering));

	if (!numbering_try_read(checking->host, columns, numbering))
		note_fault(checking, "header", numbering_key, "The numbers of attributes are not valid.");
	pfree(numbering);
}

/* Notes the first row, besides the header's, in front of all pages. */
static void
look_before_pages(Checking *checking, const abacus_facts *facts)
{
	static const int64 attributes_end[PAGE_TABLE_KEYS] = {-2, PG_INT64_MAX};
	PageTable  *table = &mesh_pages(checking->host)->simplices;
	StoredPage	row;
	bool		has_attributes = facts->columns.apart || facts->columns.labels > 0 ||
		facts->census.marked > 0;
	bool		found = page_table_next(table, has_attributes ? attributes_end : NULL, &row);

	for (uint32 i = 0; i <= abacus_header_name_rows(&facts->columns) && found; i++)
	{
		int64		key[PAGE_TABLE_KEYS] = {header_key[0], header_key[1] + i};

		if (memcmp(row.key, key, sizeof(key)) == 0)
			found = page_table_next(table, key, &row);
	}
	if (found && memcmp(row.key, numbering_key, sizeof(numbering_key)) == 0)
		found = page_table_next(table, numbering_key, &row);
	if (found && row.key[0] < 0)
		note_fault(checking, "interval", row.key, "A row lies before the beginning of the curve.");
}

/* Lets the core verify everything; it keeps at most this many faults. */
static void
check_pages(Checking *checking, Oid mesh, const abacus_facts *facts, int32 limit)
{
	Host	   *host = checking->host;
	abacus_check *check = NULL;

	header_open_vertices(host, facts);
	progress_begin(&host->progress, mesh);
	host_run(host, abacus_check_open, &host->table, facts, setting_cache_bytes(), limit, &check);
	progress_end(&host->progress);
	host_own(host, check, (void (*) (void *)) abacus_check_close);
}

/* The code of the row in which the core has found a fault. */
static int64
row_code(const abacus_fault *fault)
{
	static const char *const kinds[] = {"attributes", "labels", "markers"};

	for (int i = 0; i < lengthof(kinds); i++)
		if (strcmp(fault->kind, kinds[i]) == 0)
			return (int64) (fault->key.code + (uint64) PG_INT64_MIN);
	return (int64) fault->key.code;
}

/* Reads the core's first fault, if there is one. */
static void
look_for_first_fault(Checking *checking)
{
	Host	   *host = checking->host;

	checking->has_fault = host->handle != NULL &&
		host_check(host, abacus_check_next(host->handle, &checking->fault)) == ABACUS_OK;
	if (checking->has_fault)
		checking->code = row_code(&checking->fault);
}

/* Reports how many simplices of a sound mesh are so flat that doubles do not give their volume. */
static void
notice_flat(const Checking *checking, Relation table, const abacus_form *form)
{
	uint64		flat = abacus_check_flat(checking->host->handle);

	if (flat == 0)
		return;
	ereport(NOTICE,
			(form->dimension == 2
			 ? errmsg_plural(UINT64_FORMAT " triangle of mesh \"%s\" is flat in doubles",
							 UINT64_FORMAT " triangles of mesh \"%s\" are flat in doubles",
							 (unsigned long) flat, flat, RelationGetRelationName(table))
			 : errmsg_plural(UINT64_FORMAT " tetrahedron of mesh \"%s\" is flat in doubles",
							 UINT64_FORMAT " tetrahedra of mesh \"%s\" are flat in doubles",
							 (unsigned long) flat, flat, RelationGetRelationName(table)),
			 errdetail("The mesh is sound, and values there are right. Only %s this small are lost in rounding.",
					   form->dimension == 2 ? "areas" : "volumes")));
}

/* Compares the fixed edges of a sound mesh with its lines, which are in a table beside it. */
static void
check_lines(Checking *checking, Oid mesh, const abacus_facts *facts)
{
	char	   *fault;
	uint64		fixed,
				soft;

	if (facts->standing != ABACUS_CONSTRAINED || facts->census.lines_wait > 0)
		return;
	fixed = abacus_check_fixed(checking->host->handle, &soft);
	fault = fixed_edges_fault(mesh, fixed, soft);
	if (fault != NULL)
		note_fault(checking, "lines", header_key, fault);
}

/* The same with its regions. */
static void
check_regions(Checking *checking, Oid mesh, const abacus_facts *facts)
{
	char	   *fault = NULL;

	if (!checking->has_fault && facts->census.regions > 0 && facts->census.lines_wait == 0)
		fault = regions_fault(mesh);
	if (fault != NULL)
		note_fault(checking, "regions", header_key, fault);
}

static Checking *
begin_check(Oid mesh, int32 limit, MemoryContext memory)
{
	Relation	table = mesh_table_open(mesh, MESH_READ);
	Checking   *checking = MemoryContextAllocZero(memory, sizeof(Checking));
	abacus_header header;

	checking->host = mesh_host_create(memory, mesh, MESH_READ);
	mesh_pages(checking->host)->type = ANY_TYPE;
	if (read_header(checking, &header))
	{
		look_before_pages(checking, &header.facts);
		if (!checking->has_fault)
			check_numbers(checking, &header.facts.columns);
		limit -= checking->has_fault;
		if (limit > 0)
			check_pages(checking, mesh, &header.facts, limit);
	}
	if (!checking->has_fault)
		look_for_first_fault(checking);
	if (!checking->has_fault && limit > 0)
	{
		check_lines(checking, mesh, &header.facts);
		check_regions(checking, mesh, &header.facts);
	}
	if (checking->has_fault)
		host_doubt_pages(checking->host);
	else if (checking->host->handle != NULL)
		notice_flat(checking, table, &header.facts.form);
	host_release(checking->host);
	table_close(table, NoLock);
	return checking;
}

/* The next fault, if any. */
static bool
next_fault(Checking *checking, abacus_fault *fault, int64 *code)
{
	if (checking->has_fault)
	{
		*fault = checking->fault;
		*code = checking->code;
		checking->has_fault = false;
		return true;
	}
	if (checking->host->handle == NULL ||
		host_check(checking->host, abacus_check_next(checking->host->handle, fault)) == ABACUS_END)
		return false;
	*code = row_code(fault);
	return true;
}

/* abacus_check(mesh regclass, max_faults int) -> fault, code, part, message */
Datum
abacus_sql_check(PG_FUNCTION_ARGS)
{
	FuncCallContext *set;
	abacus_fault fault;
	int64		code;
	Datum		values[4];
	bool		isnull[4] = {false};

	if (SRF_IS_FIRSTCALL() && is_over_shards(fcinfo))
		return shard_check(fcinfo);
	if (SRF_IS_FIRSTCALL())
	{
		int32		limit;
		MemoryContext old;

		/* no row would mean that all is well */
		if (PG_ARGISNULL(0) || PG_ARGISNULL(1))
			ereport(ERROR,
					(errcode(ERRCODE_NULL_VALUE_NOT_ALLOWED),
					 errmsg("mesh and max_faults must not be NULL")));
		limit = PG_GETARG_INT32(1);
		if (limit < 1)
			ereport(ERROR,
					(errcode(ERRCODE_INVALID_PARAMETER_VALUE),
					 errmsg("max_faults must be at least 1")));
		set = SRF_FIRSTCALL_INIT();
		old = MemoryContextSwitchTo(set->multi_call_memory_ctx);
		set->tuple_desc = result_row_type(fcinfo);
		set->user_fctx = begin_check(PG_GETARG_OID(0), limit, set->multi_call_memory_ctx);
		MemoryContextSwitchTo(old);
	}
	set = SRF_PERCALL_SETUP();
	if (!next_fault(set->user_fctx, &fault, &code))
		SRF_RETURN_DONE(set);
	values[0] = CStringGetTextDatum(fault.kind);
	values[1] = Int64GetDatum(code);
	values[2] = Int64GetDatum((int64) fault.key.part);
	values[3] = CStringGetTextDatum(fault.message);
	SRF_RETURN_NEXT(set, HeapTupleGetDatum(heap_form_tuple(set->tuple_desc, values, isnull)));
}
