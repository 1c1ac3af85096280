/*
 * new_mesh.c: the tables of a new mesh.
 */
#include "postgres.h"

#include "access/xact.h"
#include "miscadmin.h"
#include "utils/builtins.h"
#include "utils/lsyscache.h"

#include "abacus/octree.h"
#include "pg/mesh/header.h"
#include "pg/mesh/new_mesh.h"
#include "pg/mesh/new_table.h"

/* Runs CREATE TABLE for one of the extension's row types, through the usual utility path. */
static void
create_table(Oid namespace, const char *name, Oid type_namespace, const char *type,
			 const char *primary_key)
{
	char	   *schema = get_namespace_name(namespace);
	char	   *type_schema = get_namespace_name(type_namespace);

	new_table_create(psprintf("CREATE TABLE %s OF %s (page WITH OPTIONS NOT NULL, PRIMARY KEY (%s)) "
							  "USING heap",
							  quote_qualified_identifier(schema, name),
							  quote_qualified_identifier(type_schema, type), primary_key),
					 name);
}

/*
 * Makes the two tables of a mesh, or of an octree, and writes its header. CREATE TABLE runs as the
 * caller with its usual checks: privileges, names taken. `command` names the function for messages.
 */
Oid
new_mesh(text *name, Oid extension_namespace, abacus_header *header, const char *command)
{
	RangeVar   *range = new_table_name(name);
	char	   *vertices_name = psprintf("%s" VERTEX_TABLE_SUFFIX, range->relname);
	Oid			namespace;
	Oid			mesh;
	Oid			vertices;
	bool		is_octree = header->facts.form.type == ABACUS_OCTREE;
	Host	   *host;

	if (!is_octree)
		header->facts.columns.apart = abacus_are_apart(header->facts.form.dimension,
													   header->facts.columns.attributes);
	PreventCommandIfReadOnly(command);
	PreventCommandIfParallelMode(command);
	if (strlen(vertices_name) >= NAMEDATALEN)
		ereport(ERROR,
				(errcode(ERRCODE_NAME_TOO_LONG),
				 errmsg("%s name \"%s\" is too long", type_name(header->facts.form.type), range->relname),
				 errdetail("The table \"%s\" belongs to it; names have at most %d bytes.",
						   vertices_name, NAMEDATALEN - 1)));
	namespace = new_table_schema(range);
	new_table_check_name(namespace, range->relname);
	new_table_check_name(namespace, vertices_name);

	create_table(namespace, range->relname, extension_namespace, SIMPLEX_PAGE_TYPE, "code, part");
	create_table(namespace, vertices_name, extension_namespace, VERTEX_PAGE_TYPE, "first, part");
	mesh = new_table_id(namespace, range->relname);
	vertices = new_table_id(namespace, vertices_name);
	new_table_describe(mesh, is_octree ? "pages of an octree: see abacus_octants()"
					   : "pages of a mesh: see abacus_simplices()",
					   get_relname_relid(SIMPLEX_PAGE_TYPE, extension_namespace), PAGE_TABLE_KEYS + 1);
	new_table_describe(vertices, is_octree ? "no pages: it belongs to an octree"
					   : "points of a mesh that wait or are repeated: see abacus_vertices()",
					   get_relname_relid(VERTEX_PAGE_TYPE, extension_namespace), PAGE_TABLE_KEYS + 1);
	mesh_bind_table(mesh, vertices);
	CommandCounterIncrement();

	host = mesh_host_create(CurrentMemoryContext, mesh, MESH_WRITE);
	if (is_octree)
		host_run(host, abacus_octree_root, &host->table, header);
	header_insert(host, header);
	host_release(host);
	host_destroy(host);
	CommandCounterIncrement();
	return mesh;
}
