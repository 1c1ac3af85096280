/*
 * fn_create.c: abacus_create, an empty mesh.
 */
#include "postgres.h"

#include "utils/lsyscache.h"

#include "pg/base/sql_function.h"
#include "pg/mesh/new_mesh.h"
#include "pg/mesh/shape.h"

SQL_FUNCTION(abacus_sql_create);

/*
 * abacus_create(mesh text, dimension int, attributes text[], lower float8[],
 * upper float8[]) -> regclass
 */
Datum
abacus_sql_create(PG_FUNCTION_ARGS)
{
	abacus_header *header = palloc0(sizeof(abacus_header));

	if (PG_ARGISNULL(0) || PG_ARGISNULL(1))
		ereport(ERROR,
				(errcode(ERRCODE_NULL_VALUE_NOT_ALLOWED),
				 errmsg("mesh and dimension must not be NULL")));
	shape_dimension(&header->facts.form, PG_GETARG_INT32(1));
	if (!PG_ARGISNULL(2))
		shape_attributes(header, PG_GETARG_ARRAYTYPE_P(2));
	shape_domain(&header->facts.form, PG_ARGISNULL(3) ? NULL : PG_GETARG_ARRAYTYPE_P(3),
				 PG_ARGISNULL(4) ? NULL : PG_GETARG_ARRAYTYPE_P(4));
	PG_RETURN_OID(new_mesh(PG_GETARG_TEXT_PP(0), get_func_namespace(fcinfo->flinfo->fn_oid),
						   header, "abacus_create()"));
}
