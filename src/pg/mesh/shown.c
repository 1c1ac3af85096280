/*
 * shown.c: the foreign tables that show a mesh.
 *
 * Each has a constraint that names the mesh and depends on it, even after a restore. The table
 * itself depends on the mesh, too, so that it is dropped with it. A dump does not carry that.
 */
#include "postgres.h"

#include "access/genam.h"
#include "access/htup_details.h"
#include "access/table.h"
#include "catalog/dependency.h"
#include "catalog/pg_class.h"
#include "catalog/pg_constraint.h"
#include "catalog/pg_depend.h"
#include "foreign/fdwapi.h"
#include "foreign/foreign.h"
#include "lib/stringinfo.h"
#include "utils/builtins.h"
#include "utils/fmgroids.h"
#include "utils/lsyscache.h"
#include "utils/syscache.h"

#include "pg/mesh/mesh.h"
#include "pg/mesh/shown.h"

/* The foreign table of ours with this constraint; InvalidOid if there is none. */
static Oid
table_of_constraint(Oid constraint)
{
	HeapTuple	tuple = SearchSysCache1(CONSTROID, ObjectIdGetDatum(constraint));
	Oid			table = InvalidOid;

	if (HeapTupleIsValid(tuple))
	{
		table = ((Form_pg_constraint) GETSTRUCT(tuple))->conrelid;
		ReleaseSysCache(tuple);
	}
	if (!OidIsValid(table) || get_rel_relkind(table) != RELKIND_FOREIGN_TABLE ||
		GetForeignServerIdByRelId(table) != get_foreign_server_oid(FDW_SERVER, true))
		return InvalidOid;
	return table;
}

/* The foreign tables that show a mesh: their constraints depend on it. */
List *
shown_tables(Oid mesh)
{
	Relation	depend = table_open(DependRelationId, AccessShareLock);
	List	   *tables = NIL;
	ScanKeyData keys[2];
	SysScanDesc scan;
	HeapTuple	tuple;

	ScanKeyInit(&keys[0], Anum_pg_depend_refclassid, BTEqualStrategyNumber, F_OIDEQ,
				ObjectIdGetDatum(RelationRelationId));
	ScanKeyInit(&keys[1], Anum_pg_depend_refobjid, BTEqualStrategyNumber, F_OIDEQ,
				ObjectIdGetDatum(mesh));
	scan = systable_beginscan(depend, DependReferenceIndexId, true, NULL, 2, keys);
	while (HeapTupleIsValid(tuple = systable_getnext(scan)))
	{
		Form_pg_depend entry = (Form_pg_depend) GETSTRUCT(tuple);
		Oid			table = entry->classid == ConstraintRelationId
			? table_of_constraint(entry->objid) : InvalidOid;

		if (OidIsValid(table))
			tables = list_append_unique_oid(tables, table);
	}
	systable_endscan(scan);
	table_close(depend, AccessShareLock);
	list_sort(tables, list_oid_cmp);
	return tables;
}

/* Makes DROP of the mesh drop the table as well. */
void
shown_bind(Oid mesh, Oid table)
{
	mesh_bind_object(RelationRelationId, table, mesh);
}

/* Their names, for messages. */
char *
shown_names(List *tables)
{
	StringInfoData names;
	ListCell   *cell;

	initStringInfo(&names);
	foreach(cell, tables)
		appendStringInfo(&names, "%s%s", names.len > 0 ? ", " : "",
						 quote_qualified_identifier(get_namespace_name(get_rel_namespace(lfirst_oid(cell))),
													get_rel_name(lfirst_oid(cell))));
	return names.data;
}
