/*
 * fn_shard_pages.c: what a shard has of the mesh of all shards, as pages: for the coordinator of a mesh over
 * several servers, whose functions read them as if they were its own.
 */
#include "postgres.h"

#include "access/htup_details.h"
#include "funcapi.h"

#include "abacus/shards.h"
#include "pg/base/sql_function.h"
#include "pg/mesh/reader.h"
#include "pg/sql/rows/result.h"

SQL_FUNCTION(abacus_sql_shard_pages);
SQL_FUNCTION(abacus_sql_shard_facts);

/* Arguments of abacus_shard_pages */
enum
{
	PAGES_MESH,
	PAGES_KIND,
	PAGES_FIRST,
	PAGES_LAST,
	PAGES_FROM_CODE,
	PAGES_FROM_PART,
	PAGES_BYTES
};

/* Columns of the pages */
enum
{
	PAGE_CODE,
	PAGE_PART,
	PAGE_BYTES,
	PAGE_COLUMNS
};

/* Columns of the facts */
enum
{
	FACT_SIMPLICES,
	FACT_GHOSTS,
	FACT_VERTICES,
	FACT_STAMP,
	FACT_COLUMNS
};

/* A row of the result; without a page, only a key. */
static void
put_page(ReturnSetInfo *set, const abacus_page *page)
{
	Datum		values[PAGE_COLUMNS] = {
		[PAGE_CODE] = Int64GetDatum((int64) page->key.code),[PAGE_PART] = Int64GetDatum((int64) page->key.part)
	};
	bool		isnull[PAGE_COLUMNS] = {[PAGE_BYTES] = page->bytes == NULL};

	if (page->bytes != NULL)
	{
		bytea	   *bytes = palloc(VARHDRSZ + page->size);

		SET_VARSIZE(bytes, VARHDRSZ + page->size);
		memcpy(VARDATA(bytes), page->bytes, page->size);
		values[PAGE_BYTES] = PointerGetDatum(bytes);
	}
	tuplestore_putvalues(set->setResult, set->setDesc, values, isnull);
	if (page->bytes != NULL)
		pfree(DatumGetPointer(values[PAGE_BYTES]));
}

/* Pages of so many bytes, one at least, and then the key at which they end. */
static void
put_pages(ReturnSetInfo *set, Host *host, abacus_own_pages *pages, int32 most)
{
	abacus_page page;
	abacus_status status;
	int64		bytes = 0;

	while ((status = host_run(host, abacus_own_pages_next, pages, &page)) != ABACUS_END)
	{
		if (bytes > 0 && bytes >= most)
			break;
		put_page(set, &page);
		bytes += page.size;
	}
	if (status == ABACUS_END)
		page.key = abacus_own_pages_end(pages);
	page.bytes = NULL;
	put_page(set, &page);
}

/*
 * abacus_shard_pages(mesh regclass, kind int, first bigint, last bigint, from_code bigint, from_part bigint,
 * bytes int)
 *     -> code, part, page
 */
Datum
abacus_sql_shard_pages(PG_FUNCTION_ARGS)
{
	int64		first = PG_GETARG_INT64(PAGES_FIRST);
	int64		last = PG_GETARG_INT64(PAGES_LAST);
	abacus_key	from = {
		(uint64) PG_GETARG_INT64(PAGES_FROM_CODE), (uint64) PG_GETARG_INT64(PAGES_FROM_PART)
	};
	Reader	   *reader;
	abacus_own_pages *pages = NULL;

	if (first < 0 || (int64) from.code < 0 || (int64) from.part < 0)
		ereport(ERROR,
				(errcode(ERRCODE_INVALID_PARAMETER_VALUE),
				 errmsg("codes and parts must not be negative")));
	InitMaterializedSRF(fcinfo, 0);
	reader = reader_open(PG_GETARG_OID(PAGES_MESH), CurrentMemoryContext);
	if (first <= last)
	{
		host_run(reader->host, abacus_own_pages_open, &reader->host->table, &reader->header.facts,
				 (abacus_page_kind) PG_GETARG_INT32(PAGES_KIND), (uint64) first, (uint64) last, &from, &pages);
		host_own(reader->host, pages, (void (*) (void *)) abacus_own_pages_close);
		put_pages((ReturnSetInfo *) fcinfo->resultinfo, reader->host, pages, PG_GETARG_INT32(PAGES_BYTES));
	}
	host_release(reader->host);
	host_destroy(reader->host);
	PG_RETURN_NULL();
}

/* abacus_shard_facts(mesh regclass, first bigint, last bigint) -> simplices, ghosts, vertices, stamp */
Datum
abacus_sql_shard_facts(PG_FUNCTION_ARGS)
{
	int64		first = PG_GETARG_INT64(1);
	int64		last = PG_GETARG_INT64(2);
	TupleDesc	desc = result_row_type(fcinfo);
	Reader	   *reader = reader_open(PG_GETARG_OID(0), CurrentMemoryContext);
	uint64		simplices = 0;
	uint64		ghosts = 0;
	Datum		values[FACT_COLUMNS];
	bool		isnull[FACT_COLUMNS] = {false};

	if (first >= 0 && first <= last)
		host_run(reader->host, abacus_own_count, &reader->host->table, &reader->header.facts, (uint64) first,
				 (uint64) last, &simplices, &ghosts);
	values[FACT_SIMPLICES] = Int64GetDatum((int64) simplices);
	values[FACT_GHOSTS] = Int64GetDatum((int64) ghosts);
	values[FACT_VERTICES] = Int64GetDatum((int64) reader->header.facts.census.vertices);
	values[FACT_STAMP] = Int64GetDatum((int64) reader->header.stamp);
	host_release(reader->host);
	host_destroy(reader->host);
	PG_RETURN_DATUM(HeapTupleGetDatum(heap_form_tuple(desc, values, isnull)));
}
