/*
 * page_type.c: input, output and casts of abacus_page.
 *
 * Text and binary forms are those of bytea, so that pg_dump, COPY and logical
 * replication carry pages, and the casts let SQL look into them. Any bytes
 * up to the size of a page are accepted: the core checks what it reads.
 */
#include "postgres.h"

#include "libpq/pqformat.h"
#include "utils/builtins.h"

#include "pg/base/sql_function.h"
#include "pg/store/page_type.h"

SQL_FUNCTION(abacus_sql_page_in);
SQL_FUNCTION(abacus_sql_page_out);
SQL_FUNCTION(abacus_sql_page_recv);
SQL_FUNCTION(abacus_sql_page_send);
SQL_FUNCTION(abacus_sql_page_from_bytea);
SQL_FUNCTION(abacus_sql_page_to_bytea);

static Datum
make_page(const void *bytes, size_t size)
{
	struct varlena *page;

	if (size > ABACUS_MAX_PAGE_BYTES)
		ereport(ERROR,
				(errcode(ERRCODE_PROGRAM_LIMIT_EXCEEDED),
				 errmsg("value too long for type abacus_page"),
				 errdetail("A page has at most %d bytes, not %zu.", ABACUS_MAX_PAGE_BYTES, size)));
	page = palloc0(PAGE_TYPE_OVERHEAD + size);
	page_type_fill(page, bytes, size);
	return PointerGetDatum(page);
}

/* A page as SQL hands it over. Its length is checked, since it may come from anywhere. */
static struct varlena *
get_page(Datum datum)
{
	struct varlena *page = PG_DETOAST_DATUM(datum);

	if (VARSIZE(page) < PAGE_TYPE_OVERHEAD)
		ereport(ERROR,
				(errcode(ERRCODE_DATA_CORRUPTED), errmsg("invalid value of type abacus_page")));
	return page;
}

static Datum
page_to_bytea(struct varlena *page)
{
	size_t		size = page_type_size(page);
	bytea	   *result = palloc(VARHDRSZ + size);

	SET_VARSIZE(result, VARHDRSZ + size);
	memcpy(VARDATA(result), page_type_bytes(page), size);
	return PointerGetDatum(result);
}

Datum
abacus_sql_page_in(PG_FUNCTION_ARGS)
{
	bytea	   *bytes = DatumGetByteaPP(DirectFunctionCall1(byteain, PG_GETARG_DATUM(0)));

	return make_page(VARDATA_ANY(bytes), VARSIZE_ANY_EXHDR(bytes));
}

Datum
abacus_sql_page_out(PG_FUNCTION_ARGS)
{
	return DirectFunctionCall1(byteaout, page_to_bytea(get_page(PG_GETARG_DATUM(0))));
}

Datum
abacus_sql_page_recv(PG_FUNCTION_ARGS)
{
	StringInfo	message = (StringInfo) PG_GETARG_POINTER(0);
	int			size = message->len - message->cursor;

	return make_page(pq_getmsgbytes(message, size), size);
}

Datum
abacus_sql_page_send(PG_FUNCTION_ARGS)
{
	return page_to_bytea(get_page(PG_GETARG_DATUM(0)));
}

Datum
abacus_sql_page_from_bytea(PG_FUNCTION_ARGS)
{
	bytea	   *bytes = PG_GETARG_BYTEA_PP(0);

	return make_page(VARDATA_ANY(bytes), VARSIZE_ANY_EXHDR(bytes));
}

Datum
abacus_sql_page_to_bytea(PG_FUNCTION_ARGS)
{
	return page_to_bytea(get_page(PG_GETARG_DATUM(0)));
}
