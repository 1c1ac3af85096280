/*
 * published.c: a foreign table that shows a mesh.
 *
 * An option would keep the name that the mesh had when the table was made. So a constraint of the
 * table names it as a regclass, CHECK (abacus_published('mesh')), which PostgreSQL stores as an
 * OID: the mesh may be renamed or move to another schema. A dump writes the current name of the
 * mesh, and restores the mesh before the table.
 *
 * An option of a column says what the column holds. So columns may be renamed or dropped. There,
 * attributes have permanent numbers (numbering.c), since they can be renamed and dropped as well. A
 * column with the values of all attributes stores how many had been dropped when it was made. As
 * long as no more are dropped, each value keeps its position.
 */
#include "postgres.h"

#include "catalog/pg_class.h"
#include "catalog/pg_proc.h"
#include "catalog/pg_type.h"
#include "commands/defrem.h"
#include "commands/extension.h"
#include "foreign/fdwapi.h"
#include "foreign/foreign.h"
#include "miscadmin.h"
#include "nodes/primnodes.h"
#include "utils/lsyscache.h"

#include "pg/fdw/published.h"
#include "pg/mesh/mesh.h"
#include "pg/mesh/shown.h"
#include "pg/port/port.h"
#include "pg/postgis/catalogue.h"

/* The content that a word names. */
bool
published_content(const char *word, Content *content)
{
	if (strcmp(word, "cells") == 0)
		*content = CONTENT_CELLS;
	else if (strcmp(word, "points") == 0)
		*content = CONTENT_POINTS;
	else
		return false;
	return true;
}

/* The number that a word is, if it is not less than `least`, otherwise -1. */
static int
figure(const char *word, long least)
{
	char	   *end;
	long		value = strtol(word, &end, 10);

	return end != word && *end == '\0' && value >= least && value <= NUMBERING_LIMIT ? (int) value : -1;
}

/* The number of an attribute, from 0; the word gives it from 1. Negative if it is not valid. */
int
published_number(const char *word)
{
	return figure(word, 1) - 1;
}

/* How many attributes have been dropped, according to a word; negative if it is not valid. */
int
published_dropped(const char *word)
{
	return figure(word, 0);
}

/* The content of a column, according to a word. */
bool
published_holds(const char *word, Column *column)
{
	static const struct
	{
		const char *word;
		Column		column;
	}			words[] = {
		{"code", {HOLDS_CODE, 0}},
		{"v0", {HOLDS_CORNER, 0}},
		{"v1", {HOLDS_CORNER, 1}},
		{"v2", {HOLDS_CORNER, 2}},
		{"v3", {HOLDS_CORNER, 3}},
		{"corners", {HOLDS_CORNERS, 0}},
		{"values", {HOLDS_VALUES, 0}},
		{"id", {HOLDS_ID, 0}},
		{"x", {HOLDS_COORDINATE, 0}},
		{"y", {HOLDS_COORDINATE, 1}},
		{"z", {HOLDS_COORDINATE, 2}},
		{"region", {HOLDS_REGION, 0}},
		{"geometry", {HOLDS_GEOMETRY, -1}},
	};
	static const struct
	{
		const char *word;
		Holds		holds;
	}			numbered[] = {{"attribute ", HOLDS_ATTRIBUTE}, {"label ", HOLDS_LABEL}};

	for (int i = 0; i < lengthof(words); i++)
		if (strcmp(word, words[i].word) == 0)
		{
			*column = words[i].column;
			return true;
		}
	for (int i = 0; i < lengthof(numbered); i++)
		if (strncmp(word, numbered[i].word, strlen(numbered[i].word)) == 0)
		{
			column->holds = numbered[i].holds;
			column->number = published_number(word + strlen(numbered[i].word));
			return column->number >= 0;
		}
	return false;
}

static const char *
option(List *options, const char *name)
{
	ListCell   *cell;

	foreach(cell, options)
	{
		DefElem    *element = lfirst(cell);

		if (strcmp(element->defname, name) == 0)
			return defGetString(element);
	}
	return NULL;
}

/* The type that a column must have. */
static Oid
type_of(const Column *column)
{
	switch (column->holds)
	{
		case HOLDS_CODE:
		case HOLDS_CORNER:
		case HOLDS_ID:
			return INT8OID;
		case HOLDS_CORNERS:
		case HOLDS_VALUES:
			return FLOAT8ARRAYOID;
		case HOLDS_COORDINATE:
		case HOLDS_ATTRIBUTE:
		case HOLDS_LABEL:
			return FLOAT8OID;
		case HOLDS_REGION:
			return TEXTOID;
		default:
			return postgis_geometry();
	}
}

/* Whether cells, or points, have the content of a column. */
static bool
belongs(const Column *column, Content content)
{
	switch (column->holds)
	{
		case HOLDS_CODE:
		case HOLDS_CORNER:
		case HOLDS_CORNERS:
		case HOLDS_VALUES:
		case HOLDS_LABEL:
		case HOLDS_REGION:
			return content == CONTENT_CELLS;
		case HOLDS_ID:
		case HOLDS_COORDINATE:
			return content == CONTENT_POINTS;
		default:
			return true;
	}
}

static void
read_column(Relation table, Content content, Form_pg_attribute attribute, Column *column)
{
	List	   *options = GetForeignColumnOptions(RelationGetRelid(table), attribute->attnum);
	const char *word = option(options, OPTION_HOLDS);
	const char *z = option(options, OPTION_Z);
	const char *dropped = option(options, OPTION_DROPPED);

	if (word == NULL || !published_holds(word, column) || !belongs(column, content))
		ereport(ERROR,
				(errcode(ERRCODE_FDW_INVALID_COLUMN_NAME),
				 errmsg("column \"%s\" of foreign table \"%s\" does not show any part of the mesh",
						NameStr(attribute->attname), RelationGetRelationName(table)),
				 errhint("Drop the column. abacus_publish() makes all columns that the mesh has.")));
	if (attribute->atttypid != type_of(column))
		ereport(ERROR,
				(errcode(ERRCODE_FDW_INVALID_DATA_TYPE),
				 errmsg("column \"%s\" of foreign table \"%s\" has the wrong type",
						NameStr(attribute->attname), RelationGetRelationName(table)),
				 errhint("Unpublish the mesh and publish it again.")));
	if (z != NULL && column->holds == HOLDS_GEOMETRY)
		column->number = published_number(z);
	if (dropped != NULL && column->holds == HOLDS_VALUES)
		column->number = published_dropped(dropped);
}

/* Whether all attributes that a column shows still exist. */
bool
published_has(const Column *column, const Numbering *numbering)
{
	switch (column->holds)
	{
		case HOLDS_ATTRIBUTE:
			return numbering_position(numbering, (uint32) column->number) >= 0;
		case HOLDS_GEOMETRY:
			return column->number < 0 || numbering_position(numbering, (uint32) column->number) >= 0;
		case HOLDS_VALUES:
			return column->number == (int) numbering->dropped;
		default:
			return true;
	}
}

/* The mesh that a constraint names; InvalidOid if the constraint is of another kind. */
static Oid
mesh_of_check(const char *check)
{
	Node	   *expression = stringToNode(check);
	Oid			function;
	Node	   *mesh;

	if (!IsA(expression, FuncExpr) || list_length(((FuncExpr *) expression)->args) != 1)
		return InvalidOid;
	function = ((FuncExpr *) expression)->funcid;
	mesh = linitial(((FuncExpr *) expression)->args);
	if (!IsA(mesh, Const) || ((Const *) mesh)->consttype != REGCLASSOID ||
		((Const *) mesh)->constisnull ||
		getExtensionOfObject(ProcedureRelationId, function) != get_extension_oid("abacus", true) ||
		strcmp(get_func_name(function), FDW_MESH_FUNCTION) != 0)
		return InvalidOid;
	return DatumGetObjectId(((Const *) mesh)->constvalue);
}

/* The mesh that a foreign table shows; InvalidOid if no constraint names it any more. */
Oid
published_mesh(Relation table)
{
	TupleConstr *constraints = RelationGetDescr(table)->constr;
	Oid			mesh = InvalidOid;

	for (int i = 0; constraints != NULL && !OidIsValid(mesh) && i < constraints->num_check; i++)
		mesh = mesh_of_check(constraints->check[i].ccbin);
	return mesh;
}

/* Reads the definition of a foreign table, in the current memory context. */
Published *
published_read(Relation table)
{
	TupleDesc	row = RelationGetDescr(table);
	Published  *published = palloc0(offsetof(Published, columns) + row->natts * sizeof(Column));
	const char *content = option(GetForeignTable(RelationGetRelid(table))->options, OPTION_CONTENT);

	published->table = RelationGetRelid(table);
	published->mesh = published_mesh(table);
	if (!OidIsValid(published->mesh) || content == NULL ||
		!published_content(content, &published->content))
		ereport(ERROR,
				(errcode(ERRCODE_FDW_TABLE_NOT_FOUND),
				 errmsg("foreign table \"%s\" does not show a mesh", RelationGetRelationName(table)),
				 errdetail("A constraint of the table, CHECK (%s(mesh)), names the mesh, and an "
						   "option says what the table shows.", FDW_MESH_FUNCTION),
				 errhint("Drop the table, and make it with abacus_publish().")));
	published->count = row->natts;
	for (int i = 0; i < row->natts; i++)
		if (!TupleDescAttr(row, i)->attisdropped)
			read_column(table, published->content, TupleDescAttr(row, i), &published->columns[i]);
	return published;
}

/*
 * Opens the mesh for reading under the active snapshot, with the rights of a user. *numbering gets
 * the numbers of its attributes, unless it is NULL. Nothing of PostgreSQL stays open.
 */
Reader *
published_open_mesh(const Published *published, Oid user, MemoryContext memory,
					Numbering *numbering)
{
	Reader	   *reader;
	Oid			caller;
	int			context;

	/* after an error the transaction, or the nested one, restores the user */
	GetUserIdAndSecContext(&caller, &context);
	SetUserIdAndSecContext(user, context | SECURITY_LOCAL_USERID_CHANGE);
	reader = reader_open(published->mesh, memory);
	if (numbering != NULL)
		numbering_read(reader->host, &reader->header.facts.columns, numbering);
	SetUserIdAndSecContext(caller, context);
	host_release(reader->host);
	return reader;
}

/* The names of the regions of the mesh, which has been opened, read with the rights of the same user. */
RegionNames *
published_region_names(const Published *published, Oid user, const abacus_facts *facts)
{
	RegionNames *names;
	Oid			caller;
	int			context;

	GetUserIdAndSecContext(&caller, &context);
	SetUserIdAndSecContext(user, context | SECURITY_LOCAL_USERID_CHANGE);
	names = region_names_read(published->mesh, facts);
	SetUserIdAndSecContext(caller, context);
	return names;
}

/* A dump does not carry the entry that drops a table with its mesh: see mesh.c. */
void
published_bind_restored(Relation mesh)
{
	ListCell   *cell;

	foreach(cell, list_concat(shown_tables(RelationGetRelid(mesh)), shown_views(RelationGetRelid(mesh))))
		if (object_ownercheck(RelationRelationId, lfirst_oid(cell), mesh->rd_rel->relowner))
			shown_bind(RelationGetRelid(mesh), lfirst_oid(cell));
}
