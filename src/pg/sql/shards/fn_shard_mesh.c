/*
 * fn_shard_mesh.c: what the coordinator of a mesh over several servers calls on a server, to change
 * the shard there: abacus_shard_begin makes its mesh, abacus_shard_take inserts points.
 *
 * The domain of all shards is that of one mesh. So a shard's mesh keeps it, however few of its points
 * lie in its part of the domain: points outside are not counted as such.
 */
#include "postgres.h"

#include <math.h>

#include "utils/builtins.h"
#include "utils/lsyscache.h"

#include "pg/base/sql_function.h"
#include "pg/mesh/change.h"
#include "pg/mesh/new_mesh.h"
#include "pg/mesh/shape.h"

SQL_FUNCTION(abacus_sql_shard_begin);
SQL_FUNCTION(abacus_sql_shard_take);

/*
 * abacus_shard_begin(mesh text, dimension int, attributes text[], lower float8[], upper float8[],
 *     srid int) -> regclass
 *
 * As abacus_create, but the domain is the box that a plan has found: it may be flat.
 */
Datum
abacus_sql_shard_begin(PG_FUNCTION_ARGS)
{
	abacus_header *header = palloc0(sizeof(abacus_header));
	abacus_form *form = &header->facts.form;

	if (PG_ARGISNULL(0) || PG_ARGISNULL(1) || PG_ARGISNULL(2) || PG_ARGISNULL(3) != PG_ARGISNULL(4))
		ereport(ERROR,
				(errcode(ERRCODE_NULL_VALUE_NOT_ALLOWED),
				 errmsg("mesh, dimension and attributes must not be NULL, and lower and upper be given together")));
	shape_dimension(form, PG_GETARG_INT32(1));
	shape_attributes(header, PG_GETARG_ARRAYTYPE_P(2));
	if (!PG_ARGISNULL(3))
	{
		shape_point(form, PG_GETARG_ARRAYTYPE_P(3), "lower", form->lower);
		shape_point(form, PG_GETARG_ARRAYTYPE_P(4), "upper", form->upper);
		for (uint32 i = 0; i < form->dimension; i++)
			if (!isfinite(form->lower[i]) || !isfinite(form->upper[i]) || form->lower[i] > form->upper[i])
				ereport(ERROR,
						(errcode(ERRCODE_INVALID_PARAMETER_VALUE),
						 errmsg("lower must not be greater than upper, and both must be finite, on axis %c",
								"xyz"[i])));
		form->has_domain = 1;
	}
	form->srid = PG_ARGISNULL(5) ? 0 : (uint32) Max(0, PG_GETARG_INT32(5));
	PG_RETURN_OID(new_mesh(PG_GETARG_TEXT_PP(0), get_func_namespace(fcinfo->flinfo->fn_oid), header,
						   "abacus_shard_begin()"));
}

/* abacus_shard_take(mesh regclass, query text) -> bigint */
Datum
abacus_sql_shard_take(PG_FUNCTION_ARGS)
{
	Source		source;
	Change	   *change;
	uint64		points;

	source_prepare(&source, text_to_cstring(PG_GETARG_TEXT_PP(1)));
	change = change_begin(PG_GETARG_OID(0), "abacus_shard_take()");
	change->keeps_domain = true;
	change_read(change, &source);
	change_insert(change);
	points = change->points;
	change_end(change);
	source_finish(&source);
	PG_RETURN_INT64((int64) points);
}
