/*
 * side_table.c: makes a table of rows beside the pages of a mesh, for its lines or its regions. It
 * belongs to the owner of the mesh, and is bound to it.
 */
#include "postgres.h"

#include "access/xact.h"
#include "catalog/pg_class.h"
#include "miscadmin.h"
#include "utils/acl.h"
#include "utils/builtins.h"
#include "utils/lsyscache.h"

#include "pg/mesh/mesh.h"
#include "pg/mesh/new_table.h"
#include "pg/mesh/side_table.h"
#include "pg/port/port.h"

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
	new_table_check_name(RelationGetNamespace(mesh), name);
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
					  psprintf("CREATE %sTABLE %s OF %s (%s) USING heap",
							   mesh->rd_rel->relpersistence == RELPERSISTENCE_UNLOGGED ? "UNLOGGED " : "",
							   quote_qualified_identifier(get_namespace_name(schema), name),
							   quote_qualified_identifier(get_namespace_name(type_schema), made->type),
							   made->options),
					  name);
	table = new_table_id(schema, name);
	new_table_describe(table, psprintf("%s of a mesh: see %s", made->contents, made->reader),
					   get_relname_relid(made->type, type_schema), made->columns);
	mesh_bind_table(RelationGetRelid(mesh), table);
	CommandCounterIncrement();
	return table;
}
