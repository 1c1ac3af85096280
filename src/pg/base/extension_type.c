/*
 * extension_type.c: types of other extensions, which may be missing or in any schema.
 */
#include "postgres.h"

#include "access/genam.h"
#include "access/htup_details.h"
#include "access/table.h"
#include "catalog/dependency.h"
#include "catalog/indexing.h"
#include "catalog/pg_extension.h"
#include "catalog/pg_type.h"
#include "commands/extension.h"
#include "utils/fmgroids.h"
#include "utils/syscache.h"

#include "pg/base/extension_type.h"

/* The schema of an extension; InvalidOid if it is not installed. */
static Oid
schema_of(const char *extension)
{
	Relation	extensions = table_open(ExtensionRelationId, AccessShareLock);
	ScanKeyData key;
	SysScanDesc scan;
	HeapTuple	tuple;
	Oid			schema = InvalidOid;

	ScanKeyInit(&key, Anum_pg_extension_extname, BTEqualStrategyNumber, F_NAMEEQ,
				CStringGetDatum(extension));
	scan = systable_beginscan(extensions, ExtensionNameIndexId, true, NULL, 1, &key);
	tuple = systable_getnext(scan);
	if (HeapTupleIsValid(tuple))
		schema = ((Form_pg_extension) GETSTRUCT(tuple))->extnamespace;
	systable_endscan(scan);
	table_close(extensions, AccessShareLock);
	return schema;
}

/* A type of an extension by its name; InvalidOid if there is none. */
Oid
extension_type(const char *extension, const char *type)
{
	Oid			schema = schema_of(extension);
	Oid			found = !OidIsValid(schema) ? InvalidOid
		: GetSysCacheOid2(TYPENAMENSP, Anum_pg_type_oid, CStringGetDatum(type),
						  ObjectIdGetDatum(schema));

	if (!OidIsValid(found) ||
		getExtensionOfObject(TypeRelationId, found) != get_extension_oid(extension, true))
		return InvalidOid;
	return found;
}
