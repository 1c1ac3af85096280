/*
 * fn_srid.c: abacus_srid and abacus_set_srid, the spatial reference system of a
 * mesh.
 *
 * It is a number in the header. Abacus itself computes with plain coordinates; only
 * geometries of PostGIS must have the same number.
 */
#include "postgres.h"

#include "pg/base/sql_function.h"
#include "pg/mesh/mesh_cache.h"
#include "pg/mesh/mesh_pages.h"
#include "pg/mesh/writer.h"

SQL_FUNCTION(abacus_sql_srid);
SQL_FUNCTION(abacus_sql_set_srid);

/* abacus_srid(mesh regclass) -> int */
Datum
abacus_sql_srid(PG_FUNCTION_ARGS)
{
	PG_RETURN_INT32((int32) mesh_cache_get_any(PG_GETARG_OID(0))->header.facts.form.srid);
}

/* abacus_set_srid(mesh regclass, srid int). The one that the mesh has binds tables that were restored alone. */
Datum
abacus_sql_set_srid(PG_FUNCTION_ARGS)
{
	int32		srid = PG_GETARG_INT32(1);
	Writer		writer;
	abacus_facts *facts;

	if (srid < 0 || srid > ABACUS_MAX_SRID)
		ereport(ERROR,
				(errcode(ERRCODE_INVALID_PARAMETER_VALUE),
				 errmsg("srid must be from 0 to %d, not %d", ABACUS_MAX_SRID, srid),
				 errhint("Use 0 for no spatial reference system.")));
	writer_begin_of(&writer, PG_GETARG_OID(0), ANY_TYPE, "abacus_set_srid()");
	facts = &writer.header->facts;
	if (facts->form.srid == (uint32) srid)
		mesh_adopt(mesh_pages(writer.host)->simplices.heap, facts->census.lines > 0, facts->census.regions > 0);
	facts->form.srid = (uint32) srid;
	writer_end(&writer);
	PG_RETURN_VOID();
}
