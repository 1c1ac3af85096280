/*
 * tracked_points.c: the points of a table that a mesh follows, and those of the mesh:
 * their columns, and queries for them.
 */
#include "postgres.h"

#include "access/tupdesc.h"
#include "catalog/pg_type.h"
#include "utils/builtins.h"
#include "utils/lsyscache.h"

#include "pg/input/row_packer.h"
#include "pg/mesh/shape.h"
#include "pg/port/port.h"
#include "pg/postgis/catalogue.h"
#include "pg/track/tracked_points.h"

/* The type of a column, InvalidOid if no column has this name. */
static Oid
column_type(Relation table, const char *name)
{
	AttrNumber	number = get_attnum(RelationGetRelid(table), name);

	return number <= 0 ? InvalidOid : TupleDescAttr(RelationGetDescr(table), number - 1)->atttypid;
}

/* The type of the geometry that some columns have instead of coordinates; InvalidOid if none. */
static Oid
geometry_of(Relation table, List *names)
{
	Oid			type = list_length(names) > 1 ? column_type(table, lsecond(names)) : InvalidOid;

	return OidIsValid(type) && geometry_is_type(type) ? type : InvalidOid;
}

/* The number of columns for the place of a point. */
static int
place_columns(Relation table, List *names, int dimension)
{
	return OidIsValid(geometry_of(table, names)) ? 1 : dimension;
}

static List *
given_names(ArrayType *given, const abacus_facts *facts, Relation table)
{
	List	   *names = NIL;
	int			count;
	Datum	   *elements = shape_names(given, "columns", &count);
	int			wanted;

	for (int i = 0; i < count; i++)
		names = lappend(names, TextDatumGetCString(elements[i]));
	wanted = 1 + place_columns(table, names, facts->form.dimension) + facts->columns.attributes;
	if (count != wanted)
		ereport(ERROR,
				(errcode(ERRCODE_ARRAY_SUBSCRIPT_ERROR),
				 errmsg("columns has %d elements, but points of the mesh have %d", count, wanted),
				 errdetail("They are id, coordinates and attributes, as in a source query.")));
	return names;
}

/* The only column of a table that is a geometry; NULL if there is none, or several. */
char *
tracked_only_geometry(Relation table)
{
	TupleDesc	desc = RelationGetDescr(table);
	char	   *found = NULL;

	for (int i = 0; i < desc->natts; i++)
	{
		Form_pg_attribute attribute = TupleDescAttr(desc, i);

		if (attribute->attisdropped || !geometry_is_type(attribute->atttypid))
			continue;
		if (found != NULL)
			return NULL;
		found = pstrdup(NameStr(attribute->attname));
	}
	return found;
}

/* Whether the z of a geometry column can be an attribute: its type says that all have one. */
static bool
has_z(Relation table, const char *geometry)
{
	AttrNumber	number = get_attnum(RelationGetRelid(table), geometry);

	return geometry_typmod_has_z(TupleDescAttr(RelationGetDescr(table), number - 1)->atttypmod);
}

/* The only attribute of a mesh that a table has no column for; NULL if there is none, or several. */
static const char *
only_missing_attribute(abacus_names mesh, Relation table)
{
	const char *missing = NULL;

	for (uint32 i = 0; i < mesh.facts->columns.attributes; i++)
		if (!OidIsValid(column_type(table, mesh.of[i])))
		{
			if (missing != NULL)
				return NULL;
			missing = mesh.of[i];
		}
	return missing;
}

/*
 * The names in the mesh; for a table without x, its geometry replaces the coordinates. In the plane
 * its z is the attribute without a column: the name of the geometry comes again.
 */
static List *
default_names(abacus_names mesh, Relation table)
{
	char	   *geometry = OidIsValid(column_type(table, row_packer_column(mesh, 1))) ? NULL
		: tracked_only_geometry(table);
	const char *in_z = geometry == NULL || mesh.facts->form.dimension > 2 || !has_z(table, geometry)
		? NULL : only_missing_attribute(mesh, table);
	List	   *names = NIL;

	for (int i = 0; i < (int) (1 + mesh.facts->form.dimension + mesh.facts->columns.attributes); i++)
		if (in_z != NULL && i > (int) mesh.facts->form.dimension &&
			strcmp(row_packer_column(mesh, i), in_z) == 0)
			names = lappend(names, geometry);
		else if (geometry == NULL || i == 0 || i > (int) mesh.facts->form.dimension)
			names = lappend(names, pstrdup(row_packer_column(mesh, i)));
		else if (i == 1)
			names = lappend(names, geometry);
	return names;
}

/*
 * A column that is computed when it is read has no value in the rows that triggers get. That would
 * look like NULL, and the row would not count as a point.
 */
void
tracked_check_column(Relation table, AttrNumber number)
{
	Form_pg_attribute attribute = TupleDescAttr(RelationGetDescr(table), number - 1);

	if (attribute->attgenerated == ATTRIBUTE_GENERATED_VIRTUAL)
		ereport(ERROR,
				(errcode(ERRCODE_FEATURE_NOT_SUPPORTED),
				 errmsg("a mesh cannot follow the virtual generated column \"%s\" of table \"%s\"",
						NameStr(attribute->attname), RelationGetRelationName(table)),
				 errdetail("Triggers are not given its values."),
				 errhint("Make it GENERATED ALWAYS AS (...) STORED, or call abacus_untrack() if the mesh "
						 "follows the table already.")));
}

/*
 * The number of a column that a mesh follows; `function` has named it, and may do so again. The column
 * may have been renamed or dropped since.
 */
AttrNumber
tracked_column(Relation table, const char *name, const char *function)
{
	AttrNumber	number = get_attnum(RelationGetRelid(table), name);

	if (number <= 0)
		ereport(ERROR,
				(errcode(ERRCODE_UNDEFINED_COLUMN),
				 errmsg("column \"%s\" of table \"%s\", which a mesh follows, does not exist", name,
						RelationGetRelationName(table)),
				 errhint("Name the columns again with %s, or call abacus_untrack().", function)));
	tracked_check_column(table, number);
	return number;
}

/* The names of a point's columns: as given, or as in the mesh. */
static List *
column_names(ArrayType *given, abacus_names mesh, Relation table)
{
	List	   *names = given != NULL ? given_names(given, mesh.facts, table)
		: default_names(mesh, table);
	ListCell   *cell;

	foreach(cell, names)
	{
		AttrNumber	number = get_attnum(RelationGetRelid(table), lfirst(cell));

		if (number <= 0)
			ereport(ERROR,
					(errcode(ERRCODE_UNDEFINED_COLUMN),
					 errmsg("column \"%s\" of table \"%s\" does not exist",
							(char *) lfirst(cell), RelationGetRelationName(table)),
					 errhint("Name the columns with the argument columns: id, coordinates, "
							 "attributes. A geometry may stand for the coordinates, and once more "
							 "for an attribute, which is then its z.")));
		tracked_check_column(table, number);
	}
	return names;
}

/* Rejects types that the triggers would reject, before there are triggers. */
static void
check_types(List *columns, abacus_names mesh, Relation table)
{
	TupleDesc	point = CreateTemplateTupleDesc(list_length(columns));
	ListCell   *cell;

	foreach(cell, columns)
		TupleDescCopyEntry(point, foreach_current_index(cell) + 1, RelationGetDescr(table),
						   get_attnum(RelationGetRelid(table), lfirst(cell)));
	TupleDescFinalize(point);
	row_packer_create_tracked(point, mesh, 1);
}

/* The names of a point's columns; the table must have them, with readable types. */
List *
tracked_columns(ArrayType *given, abacus_names mesh, Relation table)
{
	List	   *names = column_names(given, mesh, table);

	check_types(names, mesh, table);
	return names;
}

/*
 * A numeric as the row packer reads it (numeric_float8_no_overflow): numbers that round to zero or
 * infinity become that, where the cast would fail. Both bounds are exact: half the least double,
 * and the greatest double plus half a step.
 */
#define NUMERIC_AS_PACKED \
	"CASE WHEN %1$s OPERATOR(pg_catalog.=) 'NaN'::pg_catalog.numeric THEN 'NaN'::pg_catalog.float8 " \
	"WHEN pg_catalog.abs(%1$s) OPERATOR(pg_catalog.>=) (pg_catalog.power(2::pg_catalog.numeric, " \
	"1024::pg_catalog.numeric) OPERATOR(pg_catalog.-) pg_catalog.power(2::pg_catalog.numeric, " \
	"970::pg_catalog.numeric)) THEN pg_catalog.sign(%1$s)::pg_catalog.float8 " \
	"OPERATOR(pg_catalog.*) 'Infinity'::pg_catalog.float8 " \
	"WHEN (pg_catalog.abs(%1$s) OPERATOR(pg_catalog.*) pg_catalog.power(2::pg_catalog.numeric, " \
	"1075::pg_catalog.numeric)) OPERATOR(pg_catalog.<=) 1::pg_catalog.numeric " \
	"THEN 0::pg_catalog.float8 ELSE %1$s::pg_catalog.float8 END"

/* A coordinate or attribute as the row packer reads it, in SQL. */
static char *
as_packed(Relation table, const char *column)
{
	AttrNumber	number = get_attnum(RelationGetRelid(table), column);
	Oid			type = getBaseType(TupleDescAttr(RelationGetDescr(table), number - 1)->atttypid);
	char	   *value = psprintf("t.%s", quote_identifier(column));

	return type == NUMERICOID
		? psprintf(NUMERIC_AS_PACKED, psprintf("%s::pg_catalog.numeric", value))
		: psprintf("%s::pg_catalog.float8", value);
}

/* The coordinates of a geometry. */
static void
append_coordinates(StringInfo query, Oid type, const char *column, int dimension)
{
	static const char *const functions[ABACUS_MAX_DIMENSION] = {"st_x", "st_y", "st_z"};

	for (int i = 0; i < dimension; i++)
		appendStringInfo(query, "%s%s(t.%s)", i > 0 ? ", " : "", geometry_function(type, functions[i]),
						 quote_identifier(column));
}

/* Whether an attribute is the z of the geometry. */
static bool
is_z(Relation table, List *columns, int number)
{
	return number > 1 && OidIsValid(geometry_of(table, columns)) &&
		strcmp(list_nth(columns, number), lsecond(columns)) == 0;
}

static char *
z_of(Relation table, List *columns)
{
	return psprintf("%s(t.%s)", geometry_function(geometry_of(table, columns), "st_z"),
					quote_identifier(lsecond(columns)));
}

/* A column of a point as the mesh stores it. */
static void
append_packed(StringInfo query, Relation table, List *columns, int number, int dimension)
{
	const char *name = list_nth(columns, number);
	Oid			geometry = geometry_of(table, columns);

	if (number == 0)
		appendStringInfo(query, "t.%s::pg_catalog.int8", quote_identifier(name));
	else if (number == 1 && OidIsValid(geometry))
		append_coordinates(query, geometry, name, dimension);
	else if (number <= place_columns(table, columns, dimension))
		appendStringInfoString(query, as_packed(table, name));
	else
		appendStringInfo(query, "CASE WHEN (%1$s) OPERATOR(pg_catalog.<>) "
						 "'NaN'::pg_catalog.float8 THEN %1$s END",
						 is_z(table, columns, number) ? z_of(table, columns) : as_packed(table, name));
}

static char *
table_name(Relation table)
{
	return quote_qualified_identifier(get_namespace_name(RelationGetNamespace(table)),
									  RelationGetRelationName(table));
}

static char *
select_points(Relation table, List *columns, int dimension, bool packed, const char *from)
{
	StringInfoData query;

	initStringInfo(&query);
	for (int i = 0; i < list_length(columns); i++)
	{
		appendStringInfoString(&query, i == 0 ? "SELECT " : ", ");
		if (packed)
			append_packed(&query, table, columns, i, dimension);
		else if (is_z(table, columns, i))
			appendStringInfoString(&query, z_of(table, columns));
		else
			appendStringInfo(&query, "t.%s", quote_identifier(list_nth(columns, i)));
	}
	appendStringInfo(&query, " %s %s AS t WHERE ", from,
					 table_name(table));
	for (int i = 1; i <= place_columns(table, columns, dimension); i++)
		appendStringInfo(&query, "%st.%s IS NOT NULL", i > 1 ? " AND " : "",
						 quote_identifier(list_nth(columns, i)));
	return query.data;
}

/*
 * SELECT of the points of the table, its partitions and children; `packed`: as the mesh stores
 * them, with NULL for a NaN attribute.
 */
char *
tracked_points_of_table(Relation table, List *columns, int dimension, bool packed)
{
	return select_points(table, columns, dimension, packed, "FROM");
}

/*
 * SELECT of the table's points whose geometries have another system than the mesh; NULL if the
 * table has no geometries.
 */
char *
tracked_points_of_other_srid(Relation table, List *columns, const abacus_form *form)
{
	Oid			geometry = geometry_of(table, columns);

	if (!OidIsValid(geometry))
		return NULL;
	return psprintf("%s AND %s(t.%s) OPERATOR(pg_catalog.<>) %u",
					select_points(table, columns, form->dimension, false, "FROM"),
					geometry_function(geometry, "st_srid"), quote_identifier(lsecond(columns)),
					form->srid);
}

/* SELECT of the points of this table only. */
char *
tracked_points_of_one_table(Relation table, List *columns, int dimension)
{
	return select_points(table, columns, dimension, false, "FROM ONLY");
}

/* Refuses a table of points whose ids or places cannot be read any more, as transitions do. */
void
tracked_check_places(Relation table, List *columns)
{
	static const abacus_facts plane = {.form.dimension = 2};
	static const abacus_names names = {.facts = &plane};
	List	   *places;

	tracked_column(table, linitial(columns), "abacus_track()");
	tracked_column(table, lsecond(columns), "abacus_track()");
	places = list_copy_head(columns, 1 + place_columns(table, columns, 2));
	tracked_column(table, llast(places), "abacus_track()");
	check_types(places, names, table);
}

/* SELECT of id, x and y of the table's points that have certain ids; `ids` is a query for them. */
char *
tracked_places(Relation table, List *columns, const char *ids)
{
	StringInfoData query;

	initStringInfo(&query);
	appendStringInfoString(&query, "SELECT DISTINCT ");
	for (int i = 0; i <= place_columns(table, columns, 2); i++)
	{
		appendStringInfoString(&query, i > 0 ? ", " : "");
		append_packed(&query, table, columns, i, 2);
	}
	appendStringInfo(&query, " FROM %s AS t WHERE t.%s IN (%s)", table_name(table),
					 quote_identifier(linitial(columns)), ids);
	for (int i = 1; i <= place_columns(table, columns, 2); i++)
		appendStringInfo(&query, " AND t.%s IS NOT NULL", quote_identifier(list_nth(columns, i)));
	return query.data;
}

/* SELECT of the least id. */
char *
tracked_least_id(Relation table, List *columns)
{
	return psprintf("SELECT min(t.%s)::pg_catalog.int8 FROM %s AS t", quote_identifier(linitial(columns)),
					table_name(table));
}

/*
 * SELECT of the points of the mesh; `lines` is its table of lines in SQL, or NULL: vertices that
 * lines have made are left out.
 */
char *
tracked_points_of_mesh(Oid mesh, const abacus_facts *facts, Oid extension_namespace, const char *lines)
{
	StringInfoData query;

	initStringInfo(&query);
	appendStringInfoString(&query, facts->form.dimension == 2 ? "SELECT v.id, v.x, v.y"
						   : "SELECT v.id, v.x, v.y, v.z");
	for (uint32 i = 1; i <= facts->columns.attributes; i++)
		appendStringInfo(&query, ", v.attributes[%u]", i);
	appendStringInfo(&query, " FROM %s.abacus_vertices(%u::pg_catalog.regclass) AS v",
					 quote_identifier(get_namespace_name(extension_namespace)), mesh);
	if (lines != NULL)
		appendStringInfo(&query, " WHERE NOT EXISTS (SELECT FROM %s AS l WHERE l.made AND l.point OPERATOR(pg_catalog.=) "
						 "v.id AND l.x OPERATOR(pg_catalog.=) v.x AND l.y OPERATOR(pg_catalog.=) v.y)", lines);
	return query.data;
}
