/*
 * fn_publish.c: abacus_publish and abacus_unpublish, a mesh as foreign tables, and its lines as views.
 */
#include "postgres.h"

#include "access/xact.h"
#include "catalog/namespace.h"
#include "catalog/pg_class.h"
#include "catalog/pg_type.h"
#include "commands/defrem.h"
#include "lib/stringinfo.h"
#include "miscadmin.h"
#include "utils/array.h"
#include "utils/builtins.h"
#include "utils/lsyscache.h"
#include "utils/snapmgr.h"

#include "pg/base/sql_function.h"
#include "pg/base/utility.h"
#include "pg/fdw/line_views.h"
#include "pg/fdw/published.h"
#include "pg/levels/levels_table.h"
#include "pg/mesh/mesh.h"
#include "pg/mesh/reader.h"
#include "pg/port/port.h"
#include "pg/postgis/catalogue.h"

SQL_FUNCTION(abacus_sql_publish);
SQL_FUNCTION(abacus_sql_unpublish);

enum
{
	PUBLISH_MESH,
	PUBLISH_CELLS,
	PUBLISH_POINTS,
	PUBLISH_SCHEMA,
	PUBLISH_GEOMETRY,
	PUBLISH_SRID,
	PUBLISH_Z,
	PUBLISH_FIXED_EDGES,
	PUBLISH_BREAKLINES
};

/* What to publish, and how. */
typedef struct Publishing
{
	Oid			mesh;
	abacus_names names;
	const Numbering *numbering;
	const char *schema;			/* of the foreign tables */
	const char *functions;		/* schema of ours */
	const char *geometry;		/* type, with its schema; NULL: no such column */
	int			srid;
	int			z;				/* position of an attribute, or -1 */
} Publishing;

/* The definition of a table while it is written. */
typedef struct Definition
{
	StringInfoData text;
	List	   *names;			/* of its columns so far */
} Definition;

static bool
is_named(const Definition *definition, const char *name)
{
	ListCell   *cell;

	foreach(cell, definition->names)
		if (strcmp(lfirst(cell), name) == 0)
			return true;
	return false;
}

/* Adds a column. If its name is taken, it gets a number. */
static void
add_column(Definition *definition, const char *name, const char *type, const char *holds,
		   const char *more)
{
	const char *unique = name;

	for (int i = 2; is_named(definition, unique); i++)
		unique = makeObjectName(name, NULL, psprintf("%d", i));
	definition->names = lappend(definition->names, unconstify(char *, unique));
	appendStringInfo(&definition->text, "%s %s OPTIONS (" OPTION_HOLDS " '%s'%s), ",
					 quote_identifier(unique), type, holds, more);
}

/* Adds columns of ids or of coordinates, named after their content. */
static void
add_named_columns(Definition *definition, const char *const *names, int count, const char *type)
{
	for (int i = 0; i < count; i++)
		add_column(definition, names[i], type, names[i], "");
}

/* The number of an attribute as an option stores it. */
static uint32
attribute_number(const Publishing *publication, uint32 position)
{
	return numbering_number(publication->numbering, position) + 1;
}

static void
add_attributes(Definition *definition, const Publishing *publication)
{
	for (uint32 i = 0; i < publication->names.facts->columns.attributes; i++)
		add_column(definition, publication->names.of[i], "pg_catalog.float8",
				   psprintf("attribute %u", attribute_number(publication, i)), "");
}

/* Labels are never dropped, so their positions are permanent. */
static void
add_labels(Definition *definition, const Publishing *publication)
{
	const abacus_columns *columns = &publication->names.facts->columns;

	for (uint32 i = 0; i < columns->labels; i++)
		add_column(definition, publication->names.of[columns->attributes + i], "pg_catalog.float8",
				   psprintf("label %u", i + 1), "");
}

/* Adds the column with all attributes of the corners. */
static void
add_values(Definition *definition, const Publishing *publication)
{
	uint32		dropped = publication->numbering->dropped;

	add_column(definition, "values", "pg_catalog.float8[]", "values",
			   dropped == 0 ? "" : psprintf(", " OPTION_DROPPED " '%u'", dropped));
}

static void
add_geometry(Definition *definition, const Publishing *publication, Content content)
{
	bool		is_flat = publication->names.facts->form.dimension == 2;
	const char *kind = content == CONTENT_POINTS ? "Point" : is_flat ? "Polygon" : "PolyhedralSurface";
	bool		has_z = !is_flat || publication->z >= 0;

	if (publication->geometry != NULL)
		add_column(definition, "geom",
				   psprintf("%s(%s%s, %d)", publication->geometry, kind, has_z ? "Z" : "",
							publication->srid),
				   "geometry", publication->z < 0 ? ""
				   : psprintf(", " OPTION_Z " '%u'",
							  attribute_number(publication, publication->z)));
}

static void
add_columns(Definition *definition, const Publishing *publication, Content content)
{
	static const char *const ids[] = {"code", "v0", "v1", "v2", "v3"};
	static const char *const axes[] = {"x", "y", "z"};
	int			dimension = (int) publication->names.facts->form.dimension;

	if (content == CONTENT_CELLS)
	{
		add_named_columns(definition, ids, dimension + 2, "pg_catalog.int8");
		add_column(definition, "corners", "pg_catalog.float8[]", "corners", "");
		add_values(definition, publication);
		if (publication->names.facts->census.regions > 0)
			add_column(definition, "region", "pg_catalog.text", "region", "");
	}
	else
	{
		add_column(definition, "id", "pg_catalog.int8", "id", "");
		add_named_columns(definition, axes, dimension, "pg_catalog.float8");
	}
	add_attributes(definition, publication);
	if (content == CONTENT_CELLS)
		add_labels(definition, publication);
	add_geometry(definition, publication, content);
}

/* Makes one foreign table and returns it. */
static Oid
make_table(const Publishing *publication, Content content, const char *name)
{
	Definition	definition = {.names = NIL};
	Oid			table;

	initStringInfo(&definition.text);
	appendStringInfo(&definition.text, "CREATE FOREIGN TABLE %s (",
					 quote_qualified_identifier(publication->schema, name));
	add_columns(&definition, publication, content);
	appendStringInfo(&definition.text,
					 "CONSTRAINT mesh CHECK (%s('%u'::pg_catalog.regclass))) "
					 "SERVER " FDW_SERVER " OPTIONS (" OPTION_CONTENT " '%s')",
					 quote_qualified_identifier(publication->functions, FDW_MESH_FUNCTION),
					 publication->mesh, content == CONTENT_CELLS ? "cells" : "points");
	utility_run(definition.text.data);
	table = get_relname_relid(name, LookupExplicitNamespace(publication->schema, false));
	shown_bind(publication->mesh, table);
	return table;
}

/* The name given for a table, or <mesh>_<what>. */
static const char *
table_name(FunctionCallInfo fcinfo, int argument, Oid mesh, const char *what)
{
	char	   *name;

	if (PG_ARGISNULL(argument))
		return makeObjectName(get_rel_name(mesh), NULL, what);
	name = text_to_cstring(PG_GETARG_TEXT_PP(argument));
	if (name[0] == '\0' || strlen(name) >= NAMEDATALEN)
		ereport(ERROR,
				(errcode(ERRCODE_INVALID_NAME),
				 errmsg("invalid name \"%s\" for a foreign table", name),
				 errhint("Use a name of 1 to %d bytes.", NAMEDATALEN - 1)));
	return name;
}

/* The attribute that becomes Z; -1 if not given. */
static int
z_argument(FunctionCallInfo fcinfo, const Publishing *publication)
{
	if (PG_ARGISNULL(PUBLISH_Z))
		return -1;
	header_require_dimension(&publication->names.facts->form, 2,
							 "Leave out z: geometries of a mesh in space already have a Z.");
	return header_find_attribute(publication->names, text_to_cstring(PG_GETARG_TEXT_PP(PUBLISH_Z)));
}

/* The SRID of the geometries: that of the mesh, or the given one if the mesh has none. */
static int
srid_argument(FunctionCallInfo fcinfo, const Publishing *publication)
{
	if (PG_ARGISNULL(PUBLISH_SRID))
		return (int) publication->names.facts->form.srid;
	header_require_srid(&publication->names.facts->form, PG_GETARG_INT32(PUBLISH_SRID));
	return PG_GETARG_INT32(PUBLISH_SRID);
}

/* Whether and how to publish geometries: by default, if PostGIS is installed. */
static void
geometry_arguments(FunctionCallInfo fcinfo, Publishing *publication)
{
	Oid			type = postgis_geometry();
	bool		is_installed = OidIsValid(type);
	bool		has_srid = !PG_ARGISNULL(PUBLISH_SRID) && PG_GETARG_INT32(PUBLISH_SRID) != 0;
	bool		is_wanted = PG_ARGISNULL(PUBLISH_GEOMETRY) ? is_installed
		: PG_GETARG_BOOL(PUBLISH_GEOMETRY);

	publication->z = z_argument(fcinfo, publication);
	if (!is_wanted && (publication->z >= 0 || has_srid))
		ereport(ERROR,
				(errcode(ERRCODE_INVALID_PARAMETER_VALUE),
				 errmsg("srid and z apply to geometries, but no geometries are published"),
				 errhint(is_installed ? "Leave out geometry => false." :
						 "Install PostGIS with CREATE EXTENSION postgis.")));
	if (is_wanted && !is_installed)
		ereport(ERROR,
				(errcode(ERRCODE_OBJECT_NOT_IN_PREREQUISITE_STATE),
				 errmsg("type \"geometry\" does not exist"),
				 errhint("Install PostGIS with CREATE EXTENSION postgis.")));
	if (!is_wanted)
		return;
	publication->srid = srid_argument(fcinfo, publication);
	publication->geometry = format_type_extended(type, -1, FORMAT_TYPE_FORCE_QUALIFY);
}

static Datum
regclass_array(const List *tables)
{
	int			count = list_length(tables);
	Datum	   *elements = palloc(count * sizeof(Datum));

	for (int i = 0; i < count; i++)
		elements[i] = ObjectIdGetDatum(list_nth_oid(tables, i));
	return PointerGetDatum(construct_array(elements, count, REGCLASSOID, sizeof(Oid), true,
										   TYPALIGN_INT));
}

/*
 * Reads the mesh as it is now. Like any table definition, this one uses the latest state, including
 * the changes of other functions in the same statement.
 */
static Reader *
read_mesh(Publishing *publication)
{
	Numbering  *numbering = palloc(sizeof(Numbering));
	Reader	   *reader;

	CommandCounterIncrement();
	PushActiveSnapshot(GetLatestSnapshot());
	reader = reader_open(publication->mesh, CurrentMemoryContext);
	numbering_read(reader->host, &reader->header.facts.columns, numbering);
	host_release(reader->host);
	PopActiveSnapshot();
	publication->names = abacus_names_of(&reader->header);
	publication->numbering = numbering;
	return reader;
}

/* Makes tables of the cells of the levels that the user may read; returns them. */
static List *
make_level_tables(const Publishing *full, const char *cells)
{
	Level	   *levels;
	int			count = levels_read_if_allowed(full->mesh, &levels);
	List	   *tables = NIL;

	for (int i = 0; i < count; i++)
	{
		Publishing	publication = *full;
		Reader	   *reader;

		publication.mesh = levels[i].mesh;
		reader = read_mesh(&publication);
		if (full->z >= 0)
			publication.z = header_find_attribute(publication.names, full->names.of[full->z]);
		tables = lappend_oid(tables, make_table(&publication, CONTENT_CELLS,
												makeObjectName(cells, NULL, psprintf("%d", levels[i].number))));
		host_destroy(reader->host);
	}
	return tables;
}

/*
 * abacus_publish(mesh regclass, cells text, points text, schema text, geometry boolean,
 * srid integer, z text, fixed_edges text, breaklines text) -> regclass[]
 */
Datum
abacus_sql_publish(PG_FUNCTION_ARGS)
{
	Publishing	publication = {0};
	const char *cells;
	const char *points;
	Reader	   *reader;
	List	   *tables = NIL;
	LineViews	views = {0};

	if (PG_ARGISNULL(PUBLISH_MESH))
		PG_RETURN_NULL();
	publication.mesh = PG_GETARG_OID(PUBLISH_MESH);
	reader = read_mesh(&publication);
	publication.schema = PG_ARGISNULL(PUBLISH_SCHEMA)
		? get_namespace_name(get_rel_namespace(publication.mesh))
		: text_to_cstring(PG_GETARG_TEXT_PP(PUBLISH_SCHEMA));
	publication.functions = get_namespace_name(get_func_namespace(fcinfo->flinfo->fn_oid));
	geometry_arguments(fcinfo, &publication);
	cells = table_name(fcinfo, PUBLISH_CELLS, publication.mesh, "cells");
	points = table_name(fcinfo, PUBLISH_POINTS, publication.mesh, "points");
	tables = lappend_oid(tables, make_table(&publication, CONTENT_CELLS, cells));
	tables = lappend_oid(tables, make_table(&publication, CONTENT_POINTS, points));
	if (publication.names.facts->form.dimension == 2)
	{
		views.mesh = publication.mesh;
		views.schema = publication.schema;
		views.functions = publication.functions;
		views.has_geometry = publication.geometry != NULL;
		views.srid = publication.srid;
		views.z = publication.z >= 0 ? publication.names.of[publication.z] : NULL;
		tables = lappend_oid(tables, line_views_edges(&views, table_name(fcinfo, PUBLISH_FIXED_EDGES, views.mesh,
																		  "fixed_edges")));
		tables = lappend_oid(tables, line_views_lines(&views, table_name(fcinfo, PUBLISH_BREAKLINES, views.mesh,
																		  "breaklines")));
	}
	tables = list_concat(tables, make_level_tables(&publication, cells));
	host_destroy(reader->host);
	PG_RETURN_DATUM(regclass_array(tables));
}

static char *
qualified_name(Oid table)
{
	return quote_qualified_identifier(get_namespace_name(get_rel_namespace(table)),
									  get_rel_name(table));
}

/* Drops those of the relations that the caller owns; returns how many. */
static int
drop(const char *kind, List *relations)
{
	int			dropped = 0;
	StringInfoData command;
	ListCell   *cell;

	initStringInfo(&command);
	foreach(cell, relations)
		if (object_ownercheck(RelationRelationId, lfirst_oid(cell), GetUserId()))
			appendStringInfo(&command, "%s %s", dropped++ == 0 ? kind : ",",
							 qualified_name(lfirst_oid(cell)));
	if (dropped > 0)
		utility_run(command.data);
	return dropped;
}

/* Drops the foreign tables of the levels of a mesh; returns how many. */
static int
drop_level_tables(Oid mesh)
{
	Level	   *levels;
	int			count = levels_read_if_allowed(mesh, &levels);
	int			dropped = 0;

	for (int i = 0; i < count; i++)
		dropped += drop("DROP FOREIGN TABLE", shown_tables(levels[i].mesh));
	return dropped;
}

/*
 * abacus_unpublish(mesh regclass) -> integer: foreign tables and views of the caller that were
 * dropped
 */
Datum
abacus_sql_unpublish(PG_FUNCTION_ARGS)
{
	Oid			mesh = PG_GETARG_OID(0);
	int			others;

	/* as mesh_table_open(), but dropping the tables does not need the right to read the mesh */
	if (mesh_of_table(mesh) != mesh && !mesh_is_sharded(mesh))
		table_close(mesh_table_open(mesh, MESH_READ), NoLock);
	others = drop("DROP VIEW", shown_views(mesh)) + drop_level_tables(mesh);
	PG_RETURN_INT32(others + drop("DROP FOREIGN TABLE", shown_tables(mesh)));
}
