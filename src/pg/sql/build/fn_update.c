/*
 * fn_update.c: abacus_update, which gives points new attributes without moving them.
 *
 * The simplices stay as they are, too. So nothing is triangulated, and only the pages with
 * attributes are written.
 */
#include "postgres.h"

#include "utils/builtins.h"

#include "pg/base/sql_function.h"
#include "pg/mesh/change.h"
#include "pg/mesh/shape.h"
#include "pg/remote/shard_read.h"
#include "pg/shards/change/shard_change.h"
#include "pg/track/by_hand.h"

SQL_FUNCTION(abacus_sql_update);

/*
 * Columns after the coordinates are attributes by name. Their numbers go to `attributes`, which has
 * room for all; returns the shape of the rows.
 */
static abacus_header *
shape_of_rows(const Source *source, const abacus_header *header, uint32 *attributes)
{
	abacus_header *shape = palloc(sizeof(abacus_header));
	int			first = source_first_attribute(source, header->facts.form.dimension);
	int			columns = source_columns(source);

	abacus_header_copy(shape, header);
	shape->facts.columns.attributes = 0;
	shape->facts.standing = ABACUS_DELAUNAY;	/* of rows, which are in no triangulation */
	source_require_attributes(source, header->facts.form.dimension);
	for (int i = first; i < columns; i++)
	{
		const char *name = source_column_name(source, i);

		attributes[i - first] = (uint32) header_find_attribute(abacus_names_of(header), name);
		shape_attribute(shape, name);
	}
	return shape;
}

/* An error: there is no point at the place of a row. */
static void
refuse_missing(const Change *change, const abacus_named_place *missing)
{
	StringInfoData place;

	initStringInfo(&place);
	for (uint32 i = 0; i < change->writer.header->facts.form.dimension; i++)
		appendStringInfo(&place, "%s%s", i > 0 ? ", " : "",
						 DatumGetCString(DirectFunctionCall1(float8out,
															 Float8GetDatum(missing->point[i]))));
	ereport(ERROR,
			(errcode(ERRCODE_INVALID_PARAMETER_VALUE),
			 errmsg("mesh \"%s\" has no point at the place of point " INT64_FORMAT ", (%s)",
					RelationGetRelationName(mesh_pages(change->writer.host)->simplices.heap),
					missing->id, place.data),
			 change->writer.header->facts.census.split > 0
			 ? errhint("Name vertices by their ids, too: some of the mesh share a place.")
			 : abacus_is_editable(change->writer.header->facts.standing)
			 ? errhint("Points keep their coordinates. Add points with abacus_insert().")
			 : errhint("Points keep their coordinates.")));
}

/* Changes the points of a prepared query; returns how many rows it had. */
static uint64
update_query(Oid mesh, Source *source)
{
	Change	   *change = change_begin(mesh, "abacus_update()");
	const abacus_header *header = change->writer.header;
	uint32	   *attributes = palloc(Max(header->facts.columns.attributes, source_columns(source)) *
								sizeof(uint32));
	abacus_header *shape;
	abacus_named_place missing;
	uint64		points;

	by_hand_refuse_points(change);
	shape = shape_of_rows(source, header, attributes);
	change_read_gone(change, source, abacus_names_of(shape));
	points = change->points;
	if (change_update(change, attributes, shape->facts.columns.attributes, false, &missing) < points)
		refuse_missing(change, &missing);
	change_end(change);
	return points;
}

/* abacus_update(mesh regclass, query text) -> bigint */
Datum
abacus_sql_update(PG_FUNCTION_ARGS)
{
	Source		source;
	uint64		points;

	source_prepare(&source, text_to_cstring(PG_GETARG_TEXT_PP(1)));
	points = is_over_shards(fcinfo) ? shard_update(PG_GETARG_OID(0), &source, "abacus_update()")
		: update_query(PG_GETARG_OID(0), &source);
	source_finish(&source);
	PG_RETURN_INT64((int64) points);
}
