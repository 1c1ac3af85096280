/*
 * fn_locate.c: abacus_locate and abacus_walk, one simplex a call.
 *
 * These are called for every row of a query. If the session's cache has all the data that a call
 * needs, the call opens no relation and takes no lock.
 */
#include "postgres.h"

#include "pg/base/sql_function.h"
#include "pg/input/place.h"
#include "pg/mesh/mesh_cache.h"
#include "pg/sql/rows/simplex_row.h"

SQL_FUNCTION(abacus_sql_locate);
SQL_FUNCTION(abacus_sql_walk);

/*
 * abacus_locate(mesh regclass, x float8, y float8) -> abacus_simplex
 * abacus_locate(mesh regclass, x float8, y float8, z float8) -> abacus_simplex
 *
 * Two functions, not one with a default: an omitted z and a z that is NULL are different things.
 */
Datum
abacus_sql_locate(PG_FUNCTION_ARGS)
{
	double		point[ABACUS_MAX_DIMENSION];
	CachedMesh *cached;
	Host	   *host;
	abacus_simplex simplex;
	abacus_status status;

	cached = mesh_cache_get(PG_GETARG_OID(0));
	if (!place_arguments(fcinfo, PG_NARGS() - 1, &cached->header.facts.form, point))
		PG_RETURN_NULL();		/* outside every hull */

	host = cached->host;
	status = host_run(host, abacus_mesh_locate, cached->mesh, point, &simplex);
	host_release(host);
	if (status == ABACUS_END)
		PG_RETURN_NULL();
	PG_RETURN_DATUM(simplex_row_again(simplex_rows(fcinfo), &simplex, cached->dimension));
}

/* abacus_walk(mesh regclass, simplex abacus_simplex, facet int) -> abacus_simplex */
Datum
abacus_sql_walk(PG_FUNCTION_ARGS)
{
	CachedMesh *cached = mesh_cache_get(PG_GETARG_OID(0));
	int32		facet = PG_GETARG_INT32(2);
	SimplexRows *rows = simplex_rows(fcinfo);
	Host	   *host = cached->host;
	int64		ids[ABACUS_MAX_DIMENSION + 1];
	uint64		code;
	abacus_simplex simplex;
	abacus_status status;

	if (facet < 0 || (uint32) facet > cached->dimension)
		ereport(ERROR,
				(errcode(ERRCODE_INVALID_PARAMETER_VALUE),
				 errmsg("facet %d does not exist", facet),
				 errhint("Facets are numbered 0 to %u; facet i is the one opposite vertex i.",
						 cached->dimension)));
	if (!simplex_from_row(PG_GETARG_DATUM(1), rows->row_type, cached->dimension, &code, ids))
		PG_RETURN_NULL();
	status = host_run(host, abacus_mesh_walk, cached->mesh, code, ids, facet, &simplex);
	host_release(host);
	if (status == ABACUS_END)
		PG_RETURN_NULL();
	PG_RETURN_DATUM(simplex_row_again(rows, &simplex, cached->dimension));
}
