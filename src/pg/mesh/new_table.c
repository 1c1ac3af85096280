/*
 * new_table.c: protects a table while a CREATE TABLE of ours makes it. Others may drop its schema
 * before, drop the table after (by an event trigger), or make another one with that name.
 * Tables of lines, regions and steps belong to the owner of their mesh, and are bound to it.
 */
#include "postgres.h"

#include "access/xact.h"
#include "catalog/dependency.h"
#include "catalog/namespace.h"
#include "catalog/pg_class.h"
#include "commands/comment.h"
#include "miscadmin.h"
#include "utils/acl.h"
#include "utils/builtins.h"
#include "utils/lsyscache.h"
#include "utils/varlena.h"

#include "pg/base/utility.h"
#include "pg/mesh/mesh.h"
#include "pg/mesh/new_table.h"
#include "pg/port/port.h"

/* A name as in SQL, perhaps with a schema. */
RangeVar *
new_table_name(text *name)
{
	char	   *given = text_to_cstring(name);
	List	   *parts;

	if (!SplitIdentifierString(pstrdup(given), '.', &parts) || parts == NIL)
		ereport(ERROR,
				(errcode(ERRCODE_INVALID_NAME),
				 errmsg("invalid name \"%s\"", given),
				 strpbrk(given, ".\"") != NULL || given[0] == '\0'
				 ? errhint("Write it as in SQL: schema.name, each part in double quotes unless it "
						   "is a plain identifier.")
				 : errhint("Write it as in SQL, in double quotes unless it is a plain identifier: "
						   "'\"%s\"'.", given)));
	return makeRangeVarFromNameList(textToQualifiedNameList(name));
}

/* The schema of the new table, locked, so that it still exists when a statement names it. */
Oid
new_table_schema(RangeVar *name)
{
	return RangeVarGetAndCheckCreationNamespace(name, NoLock, NULL);
}

/* Checks that the name is free. CREATE TABLE would too, but without a hint. */
void
new_table_check_name(Oid schema, const char *name)
{
	Oid			other = get_relname_relid(name, schema);
	bool		is_mesh;

	if (!OidIsValid(other))
		return;
	is_mesh = mesh_of_table(other) == other;
	ereport(ERROR,
			(errcode(ERRCODE_DUPLICATE_TABLE),
			 is_mesh ? errmsg("mesh \"%s\" already exists", name)
			 : errmsg("relation \"%s\" already exists", name),
			 is_mesh ? errhint("Drop it with DROP TABLE, add points to it with abacus_insert(), or "
							   "choose another name.")
			 : errhint("Choose another name for the mesh, or drop the relation.")));
}

/* Whether an error is about two rows with the same name in a catalogue. */
static bool
is_name_taken(const ErrorData *error)
{
	return error->sqlerrcode == ERRCODE_UNIQUE_VIOLATION && error->constraint_name != NULL &&
		(strcmp(error->constraint_name, "pg_type_typname_nsp_index") == 0 ||
		 strcmp(error->constraint_name, "pg_class_relname_nsp_index") == 0);
}

/* Runs CREATE TABLE. A session that has just committed may have taken the name meanwhile. */
void
new_table_create(const char *command, const char *name)
{
	MemoryContext memory = CurrentMemoryContext;

	PG_TRY();
	{
		utility_run(command);
	}
	PG_CATCH();
	{
		ErrorData  *error;

		MemoryContextSwitchTo(memory);
		error = CopyErrorData();
		if (!is_name_taken(error))
			PG_RE_THROW();
		FlushErrorState();
		ereport(ERROR,
				(errcode(ERRCODE_DUPLICATE_TABLE),
				 errmsg("relation \"%s\" already exists", name),
				 errdetail("Another session has made it at the same time."),
				 errhint("Choose another name, or use the existing relation.")));
	}
	PG_END_TRY();
}

/* The table that was just made. */
Oid
new_table_id(Oid schema, const char *name)
{
	Oid			table = get_relname_relid(name, schema);

	if (!OidIsValid(table))
		ereport(ERROR,
				(errcode(ERRCODE_UNDEFINED_TABLE),
				 errmsg("table \"%s\" no longer exists", name),
				 errdetail("It was dropped or renamed as soon as it had been made."),
				 errhint("Look for an event trigger that does so.")));
	return table;
}

/* Writes comments: that of the table is `what`, those of its columns come from its row type. */
void
new_table_describe(Oid table, const char *what, Oid row, int columns)
{
	CreateComments(table, RelationRelationId, 0, what);
	for (int32 column = 1; column <= columns; column++)
		CreateComments(table, RelationRelationId, column,
					   GetComment(row, RelationRelationId, column));
}

/* ---- Tables beside a mesh -------------------------------------------------------------- */

/* Makes DROP of the mesh drop the object as well. It may have done so before. */
void
mesh_bind_object(Oid class, Oid object, Oid mesh)
{
	ObjectAddress dependent;
	ObjectAddress referenced;

	ObjectAddressSet(dependent, class, object);
	ObjectAddressSet(referenced, RelationRelationId, mesh);
	(void) deleteDependencyRecordsForSpecific(class, object, DEPENDENCY_AUTO, RelationRelationId, mesh);
	recordDependencyOn(&dependent, &referenced, DEPENDENCY_AUTO);
}

void
mesh_bind_table(Oid mesh, Oid table)
{
	mesh_bind_object(RelationRelationId, table, mesh);
}

static void
check_may_make(Relation mesh, const NewSideTable *made, const char *name)
{
	const char *mesh_name = RelationGetRelationName(mesh);

	if (!object_ownercheck(RelationRelationId, RelationGetRelid(mesh), GetUserId()))
		ereport(ERROR,
				(errcode(ERRCODE_INSUFFICIENT_PRIVILEGE),
				 errmsg("must be owner of mesh \"%s\" to give it its first %s", mesh_name, made->contents),
				 errdetail("They make the table \"%s\".", name),
				 errhint("Its owner can call %s, and grant privileges on that table.", made->maker)));
	if (strlen(name) >= NAMEDATALEN)
		ereport(ERROR,
				(errcode(ERRCODE_NAME_TOO_LONG),
				 errmsg("name of mesh \"%s\" is too long for a mesh with %s", mesh_name, made->contents),
				 errdetail("The table \"%s\" would belong to it; names have at most %d bytes.", name,
						   NAMEDATALEN - 1),
				 errhint("Rename the mesh and its vertex table.")));
	if (OidIsValid(get_relname_relid(name, RelationGetNamespace(mesh))))
		ereport(ERROR,
				(errcode(ERRCODE_DUPLICATE_TABLE),
				 errmsg("relation \"%s\" already exists", name),
				 errdetail("It is not part of mesh \"%s\", whose first %s would make a table of that name.", mesh_name, made->contents),
				 errhint("If it was restored alone, the owner of both binds it by abacus_set_srid() with the SRID that the mesh has. "
						 "Otherwise rename or drop it.")));
}

/* Runs CREATE as the owner of the mesh, who will own the table as well. */
void
side_table_create(Relation mesh, const char *command, const char *name)
{
	Oid			user;
	int			security;

	GetUserIdAndSecContext(&user, &security);
	if (mesh->rd_rel->relowner != user)
		SetUserIdAndSecContext(mesh->rd_rel->relowner, security | SECURITY_LOCAL_USERID_CHANGE);
	new_table_create(command, name);
	SetUserIdAndSecContext(user, security);
}

/* Makes the table, which the mesh must not have. */
Oid
side_table_make(Relation mesh, const NewSideTable *made)
{
	Oid			schema = RelationGetNamespace(mesh);
	char	   *name = psprintf("%s%s", RelationGetRelationName(mesh), made->suffix);
	Oid			type_schema = get_rel_namespace(get_typ_typrelid(mesh->rd_rel->reloftype));
	Oid			table;

	check_may_make(mesh, made, name);
	side_table_create(mesh,
					  psprintf("CREATE %sTABLE %s OF %s (%s) %s",
							   mesh->rd_rel->relpersistence == RELPERSISTENCE_UNLOGGED ? "UNLOGGED " : "",
							   quote_qualified_identifier(get_namespace_name(schema), name),
							   quote_qualified_identifier(get_namespace_name(type_schema), made->type),
							   made->options,
							   made->partitioning != NULL ? made->partitioning : "USING heap"),
					  name);
	table = new_table_id(schema, name);
	new_table_describe(table, psprintf("%s of a mesh: see %s", made->contents, made->reader),
					   get_relname_relid(made->type, type_schema), made->columns);
	mesh_bind_table(RelationGetRelid(mesh), table);
	CommandCounterIncrement();
	return table;
}
