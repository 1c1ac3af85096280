/*
 * fn_label.c: abacus_label, abacus_inherit_labels and abacus_labels, labels of simplices of a mesh.
 *
 * Nothing is triangulated, and no simplex page is written. So meshes that are not Delaunay can have
 * labels, too.
 */
#include "postgres.h"

#include "catalog/pg_type.h"
#include "utils/builtins.h"

#include "pg/base/settings.h"
#include "pg/base/sql_function.h"
#include "pg/mesh/change.h"
#include "pg/mesh/mesh_cache.h"
#include "pg/mesh/shape.h"
#include "pg/mesh/writer.h"
#include "pg/sql/rows/result.h"
#include "pg/sql/rows/simplex_row.h"

SQL_FUNCTION(abacus_sql_label);
SQL_FUNCTION(abacus_sql_inherit_labels);
SQL_FUNCTION(abacus_sql_labels);
SQL_FUNCTION(abacus_sql_labels_of);

/*
 * Columns after those of a simplex are labels by name; the mesh gets new ones. Their numbers go to
 * `labels`, which has room for all; returns the shape of the rows.
 */
static abacus_header *
shape_of_rows(const Source *source, abacus_header *header, uint32 *labels)
{
	abacus_header *shape = palloc(sizeof(abacus_header));
	int			first = 2 + (int) header->facts.form.dimension;	/* after code and vertices */
	int			columns = source_columns(source);

	abacus_header_copy(shape, header);
	shape->facts.columns.attributes = shape->facts.columns.labels = 0;
	if (columns <= first)
		ereport(ERROR,
				(errcode(ERRCODE_DATATYPE_MISMATCH),
				 errmsg("source query has no column for a label"),
				 errhint("After the code and the vertices of a simplex, add columns that are named after labels.")));
	for (int i = first; i < columns; i++)
	{
		const char *name = source_column_name(source, i);
		int			number = header_label(abacus_names_of(header), name);

		shape_label(shape, name);
		if (number < 0)
		{
			number = (int) header->facts.columns.labels;
			shape_label(header, name);
		}
		labels[i - first] = (uint32) number;
	}
	return shape;
}

/* Labels the simplices of a prepared query; returns how many rows it had. */
static uint64
label_query(Oid mesh, Source *source)
{
	Change	   *change = change_begin(mesh, "abacus_label()");
	Host	   *host = change->writer.host;
	abacus_header *header = change->writer.header;
	uint32		known = header->facts.columns.labels;
	uint32	   *labels = palloc(source_columns(source) * sizeof(uint32));
	abacus_header *shape = shape_of_rows(source, header, labels);
	const uint64 *rows;
	size_t		count;
	uint64		labelled = 0;

	host_run(host, abacus_labelling_open, &host->table, &header->facts, known, labels,
			 (size_t) shape->facts.columns.labels, setting_sort_bytes(), setting_cache_bytes(),
			 &change->labelling);
	source_open_labels(source, abacus_names_of(shape));
	while ((count = source_fetch(source, &rows)) > 0)
	{
		host_run(host, abacus_labelling_add, change->labelling, rows, count);
		labelled += count;
	}
	source_close(source);
	host_run(host, abacus_labelling_end, change->labelling, header);
	change_end(change);
	return labelled;
}

/* abacus_label(mesh regclass, query text) -> bigint */
Datum
abacus_sql_label(PG_FUNCTION_ARGS)
{
	Source		source;
	uint64		labelled;

	source_prepare(&source, text_to_cstring(PG_GETARG_TEXT_PP(1)));
	labelled = label_query(PG_GETARG_OID(0), &source);
	source_finish(&source);
	PG_RETURN_INT64((int64) labelled);
}

/* abacus_inherit_labels(mesh regclass, inherit boolean) */
Datum
abacus_sql_inherit_labels(PG_FUNCTION_ARGS)
{
	Writer		writer;

	writer_begin_of(&writer, PG_GETARG_OID(0), ABACUS_MESH, "abacus_inherit_labels()");
	if (writer.header->facts.columns.labels == 0)
		ereport(ERROR,
				(errcode(ERRCODE_OBJECT_NOT_IN_PREREQUISITE_STATE),
				 errmsg("mesh has no labels"),
				 errhint("Give some to its simplices first, with abacus_label().")));
	writer.header->facts.columns.inherits = PG_GETARG_BOOL(1) ? 1 : 0;
	writer_end(&writer);
	PG_RETURN_VOID();
}

/* abacus_labels(mesh regclass) -> text[] */
Datum
abacus_sql_labels(PG_FUNCTION_ARGS)
{
	abacus_names names = abacus_names_of(&mesh_cache_get(PG_GETARG_OID(0))->header);
	uint32		count = names.facts->columns.labels;
	Datum	   *labels = palloc(Max(count, 1) * sizeof(Datum));

	for (uint32 i = 0; i < count; i++)
		labels[i] = CStringGetTextDatum(names.of[names.facts->columns.attributes + i]);
	PG_RETURN_ARRAYTYPE_P(construct_array(labels, (int) count, TEXTOID, -1, false,
										  TYPALIGN_INT));
}

/* abacus_labels(mesh regclass, simplex abacus_simplex) -> float8[] */
Datum
abacus_sql_labels_of(PG_FUNCTION_ARGS)
{
	CachedMesh *cached = mesh_cache_get(PG_GETARG_OID(0));
	int64		ids[ABACUS_MAX_DIMENSION + 1];
	uint64		code;
	const double *labels = NULL;

	if (!simplex_from_argument(PG_GETARG_DATUM(1), cached->dimension, &code, ids) ||
		cached->header.facts.columns.labels == 0)
		PG_RETURN_NULL();
	host_run(cached->host, abacus_mesh_labels, cached->mesh, code, ids, &labels);
	host_release(cached->host);
	PG_RETURN_DATUM(attribute_array(labels, (int) cached->header.facts.columns.labels));
}
