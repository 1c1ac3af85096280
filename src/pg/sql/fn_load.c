/*
 * fn_load.c: abacus_load, a triangulation made elsewhere into a new mesh.
 *
 * The vertices are read first, then the simplices; the core keeps both, sorts
 * and checks them within maintenance_work_mem (beyond it in temporary files)
 * and writes the pages.
 */
#include "postgres.h"

#include "utils/builtins.h"
#include "utils/lsyscache.h"

#include "abacus/change.h"
#include "pg/base/settings.h"
#include "pg/base/sql_function.h"
#include "pg/input/source.h"
#include "pg/mesh/new_mesh.h"
#include "pg/mesh/shape.h"
#include "pg/mesh/writer.h"

SQL_FUNCTION(abacus_sql_load);

/* A simplex has as many vertices as its mesh has dimensions, and one more. */
static int
dimension_of(const Source *simplices)
{
	int			columns = source_columns(simplices);

	if (columns < 3 || columns > ABACUS_MAX_DIMENSION + 1)
		ereport(ERROR,
				(errcode(ERRCODE_DATATYPE_MISMATCH),
				 errmsg("simplices query returns %d columns, not 3 or 4", columns),
				 errdetail("Columns go by position: v0, v1, v2 of triangles; v0, v1, v2, v3 of "
						   "tetrahedra.")));
	return columns - 1;
}

/* Loads the rows of two prepared queries into an empty mesh; returns the number of simplices. */
static uint64
load(Oid mesh, Source *vertices, Source *simplices, bool reorient)
{
	Writer		writer;
	Host	   *host;
	abacus_load *loading = NULL;
	const uint64 *records;
	size_t		count;
	uint64		loaded;

	writer_begin(&writer, mesh, MESH_WRITE, "abacus_load()");
	host = writer.host;
	host_run(host, abacus_load_open, &host->table, writer.header, setting_sort_bytes(), reorient,
			 &loading);
	host_own(host, loading, (void (*) (void *)) abacus_load_close);
	source_open(vertices, writer.header);
	while ((count = source_fetch(vertices, &records)) > 0)
		host_run(host, abacus_load_vertices, loading, records, count);
	source_close(vertices);
	source_open_simplices(simplices, writer.header);
	while ((count = source_fetch(simplices, &records)) > 0)
		host_run(host, abacus_load_simplices, loading, (const int64_t *) records, count);
	source_close(simplices);
	host_run(host, abacus_load_finish, loading, writer.header);
	loaded = writer.header->simplices;
	writer_end(&writer);
	return loaded;
}

/*
 * abacus_load(mesh text, vertices text, simplices text, attributes text[],
 * lower float8[], upper float8[], reorient boolean) -> bigint
 */
Datum
abacus_sql_load(PG_FUNCTION_ARGS)
{
	abacus_header *header = palloc0(sizeof(abacus_header));
	Source		vertices;
	Source		simplices;
	Oid			mesh;
	uint64		loaded;

	if (PG_ARGISNULL(0) || PG_ARGISNULL(1) || PG_ARGISNULL(2) || PG_ARGISNULL(6))
		ereport(ERROR,
				(errcode(ERRCODE_NULL_VALUE_NOT_ALLOWED),
				 errmsg("mesh, vertices, simplices and reorient must not be NULL")));
	source_prepare(&vertices, text_to_cstring(PG_GETARG_TEXT_PP(1)));
	source_prepare(&simplices, text_to_cstring(PG_GETARG_TEXT_PP(2)));
	shape_dimension(header, dimension_of(&simplices));
	if (!PG_ARGISNULL(3))
		shape_attributes(header, PG_GETARG_ARRAYTYPE_P(3));
	else
		for (int i = 1 + header->dimension; i < source_columns(&vertices); i++)
			shape_attribute(header, source_column_name(&vertices, i));
	shape_domain(header, PG_ARGISNULL(4) ? NULL : PG_GETARG_ARRAYTYPE_P(4),
				 PG_ARGISNULL(5) ? NULL : PG_GETARG_ARRAYTYPE_P(5));

	mesh = new_mesh(PG_GETARG_TEXT_PP(0), get_func_namespace(fcinfo->flinfo->fn_oid), header,
					"abacus_load()");
	loaded = load(mesh, &vertices, &simplices, PG_GETARG_BOOL(6));
	source_finish(&simplices);
	source_finish(&vertices);
	PG_RETURN_INT64((int64) loaded);
}
