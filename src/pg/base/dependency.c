/*
 * dependency.c: tables that depend on others automatically, by pg_depend.
 */
#include "postgres.h"

#include "access/genam.h"
#include "access/htup_details.h"
#include "access/table.h"
#include "catalog/dependency.h"
#include "catalog/indexing.h"
#include "catalog/pg_class.h"
#include "catalog/pg_depend.h"
#include "utils/fmgroids.h"
#include "utils/rel.h"

#include "pg/base/dependency.h"

/*
 * The first table of the wanted kind that the object automatically depends on
 * (`dependent`), or that depends on it.
 */
Oid
dependency_find(Oid class, Oid object, bool dependent, bool (*wanted) (Oid))
{
	Relation	depend = table_open(DependRelationId, AccessShareLock);
	ScanKeyData keys[2];
	SysScanDesc scan;
	HeapTuple	tuple;
	Oid			found = InvalidOid;

	ScanKeyInit(&keys[0], dependent ? Anum_pg_depend_classid : Anum_pg_depend_refclassid,
				BTEqualStrategyNumber, F_OIDEQ, ObjectIdGetDatum(class));
	ScanKeyInit(&keys[1], dependent ? Anum_pg_depend_objid : Anum_pg_depend_refobjid,
				BTEqualStrategyNumber, F_OIDEQ, ObjectIdGetDatum(object));
	scan = systable_beginscan(depend, dependent ? DependDependerIndexId : DependReferenceIndexId,
							  true, NULL, 2, keys);
	while (!OidIsValid(found) && HeapTupleIsValid(tuple = systable_getnext(scan)))
	{
		Form_pg_depend entry = (Form_pg_depend) GETSTRUCT(tuple);
		Oid			other = dependent ? entry->refobjid : entry->objid;

		if (entry->deptype == DEPENDENCY_AUTO &&
			(dependent || entry->classid == RelationRelationId) &&
			entry->refclassid == RelationRelationId && entry->objsubid == 0 &&
			entry->refobjsubid == 0 && wanted(other))
			found = other;
	}
	systable_endscan(scan);
	table_close(depend, AccessShareLock);
	return found;
}
