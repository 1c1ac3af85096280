/*
 * shown.c: the foreign tables and views that show a mesh.
 *
 * Each table has a constraint, and each view a condition in its rule, that names the mesh and depends on it, even after a restore. The table
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
#include "catalog/pg_proc.h"
#include "catalog/pg_rewrite.h"
#include "commands/extension.h"
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

/* The view of ours with this rule, which calls our function; InvalidOid if there is none. */
static Oid
view_of_rule(Oid rule)
{
	Relation	depend = table_open(DependRelationId, AccessShareLock);
	Oid			view = InvalidOid;
	bool		is_ours = false;
	ScanKeyData keys[2];
	SysScanDesc scan;
	HeapTuple	tuple;

	ScanKeyInit(&keys[0], Anum_pg_depend_classid, BTEqualStrategyNumber, F_OIDEQ,
				ObjectIdGetDatum(RewriteRelationId));
	ScanKeyInit(&keys[1], Anum_pg_depend_objid, BTEqualStrategyNumber, F_OIDEQ,
				ObjectIdGetDatum(rule));
	scan = systable_beginscan(depend, DependDependerIndexId, true, NULL, 2, keys);
	while (HeapTupleIsValid(tuple = systable_getnext(scan)))
	{
		Form_pg_depend entry = (Form_pg_depend) GETSTRUCT(tuple);

		if (entry->refclassid == RelationRelationId && entry->deptype == DEPENDENCY_INTERNAL)
			view = entry->refobjid;
		if (entry->refclassid == ProcedureRelationId &&
			strcmp(get_func_name(entry->refobjid), SHOWN_MESH_FUNCTION) == 0 &&
			getExtensionOfObject(ProcedureRelationId, entry->refobjid) == get_extension_oid("abacus", true))
			is_ours = true;
	}
	systable_endscan(scan);
	table_close(depend, AccessShareLock);
	return is_ours && OidIsValid(view) && get_rel_relkind(view) == RELKIND_VIEW ? view : InvalidOid;
}

/* The relations that show a mesh by objects of a class that depend on it. */
static List *
shown_by(Oid mesh, Oid class, Oid (*relation_of) (Oid object))
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
		Oid			table = entry->classid == class ? relation_of(entry->objid) : InvalidOid;

		if (OidIsValid(table))
			tables = list_append_unique_oid(tables, table);
	}
	systable_endscan(scan);
	table_close(depend, AccessShareLock);
	list_sort(tables, list_oid_cmp);
	return tables;
}

/* The foreign tables that show a mesh: their constraints depend on it. */
List *
shown_tables(Oid mesh)
{
	return shown_by(mesh, ConstraintRelationId, table_of_constraint);
}

/* The views that show its lines: their rules depend on it. */
List *
shown_views(Oid mesh)
{
	return shown_by(mesh, RewriteRelationId, view_of_rule);
}

/* Makes DROP of the mesh drop the table or view as well. */
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
