/*
 * new_mesh.c: the tables of a new mesh.
 */
#include "postgres.h"

#include "access/xact.h"
#include "catalog/namespace.h"
#include "miscadmin.h"
#include "utils/builtins.h"
#include "utils/lsyscache.h"
#include "utils/varlena.h"

#include "pg/base/utility.h"
#include "pg/mesh/header.h"
#include "pg/mesh/new_mesh.h"
#include "pg/mesh/new_table.h"

/* CREATE TABLE of one of the extension's row types, through the usual utility path. */
static void
create_table(Oid namespace, const char *name, Oid type_namespace, const char *type,
			 const char *primary_key)
{
	char	   *schema = get_namespace_name(namespace);
	char	   *type_schema = get_namespace_name(type_namespace);

	utility_run(psprintf("CREATE TABLE %s OF %s (page WITH OPTIONS NOT NULL, PRIMARY KEY (%s)) "
						 "USING heap",
						 quote_qualified_identifier(schema, name),
						 quote_qualified_identifier(type_schema, type), primary_key));
}

/*
 * Makes the two tables of a mesh and writes its header. CREATE TABLE runs as
 * the caller and checks what it always checks: privileges, names taken.
 * `command` names the function for messages.
 */
Oid
new_mesh(text *name, Oid extension_namespace, abacus_header *header, const char *command)
{
	RangeVar   *range = makeRangeVarFromNameList(textToQualifiedNameList(name));
	char	   *vertices_name = psprintf("%s" VERTEX_TABLE_SUFFIX, range->relname);
	Oid			namespace;
	Oid			mesh;
	Host	   *host;

	PreventCommandIfReadOnly(command);
	PreventCommandIfParallelMode(command);
	if (strlen(vertices_name) >= NAMEDATALEN)
		ereport(ERROR,
				(errcode(ERRCODE_NAME_TOO_LONG),
				 errmsg("mesh name \"%s\" is too long", range->relname),
				 errdetail("The table \"%s\" stands beside it; names have at most %d bytes.",
						   vertices_name, NAMEDATALEN - 1)));
	namespace = new_table_schema(range);

	create_table(namespace, range->relname, extension_namespace, SIMPLEX_PAGE_TYPE, "code, part");
	create_table(namespace, vertices_name, extension_namespace, VERTEX_PAGE_TYPE, "first, part");
	mesh = new_table_id(namespace, range->relname);
	mesh_bind_vertex_table(mesh, new_table_id(namespace, vertices_name));
	CommandCounterIncrement();

	host = mesh_host_create(CurrentMemoryContext, mesh, MESH_WRITE);
	header_insert(host, header);
	host_release(host);
	host_destroy(host);
	CommandCounterIncrement();
	return mesh;
}
