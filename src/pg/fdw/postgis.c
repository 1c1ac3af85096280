/*
 * postgis.c: PostGIS as it is found in the catalogues.
 *
 * PostGIS may be missing, or be installed later, in any version. So nothing of it is linked.
 * The type is found by its name in the schema of the extension. Operators and functions are
 * known by their names and by belonging to the extension.
 */
#include "postgres.h"

#include "access/genam.h"
#include "access/htup_details.h"
#include "access/table.h"
#include "catalog/dependency.h"
#include "catalog/indexing.h"
#include "catalog/pg_extension.h"
#include "catalog/pg_proc.h"
#include "catalog/pg_type.h"
#include "commands/extension.h"
#include "utils/builtins.h"
#include "utils/fmgroids.h"
#include "utils/syscache.h"

#include "pg/fdw/postgis.h"

#define POSTGIS "postgis"
#define GEOMETRY "geometry"

/* The schema of the extension; InvalidOid if it is not installed. */
static Oid
schema_of_postgis(void)
{
	Relation	extensions = table_open(ExtensionRelationId, AccessShareLock);
	ScanKeyData key;
	SysScanDesc scan;
	HeapTuple	tuple;
	Oid			schema = InvalidOid;

	ScanKeyInit(&key, Anum_pg_extension_extname, BTEqualStrategyNumber, F_NAMEEQ,
				CStringGetDatum(POSTGIS));
	scan = systable_beginscan(extensions, ExtensionNameIndexId, true, NULL, 1, &key);
	tuple = systable_getnext(scan);
	if (HeapTupleIsValid(tuple))
		schema = ((Form_pg_extension) GETSTRUCT(tuple))->extnamespace;
	systable_endscan(scan);
	table_close(extensions, AccessShareLock);
	return schema;
}

/* The type geometry; InvalidOid if there is none. */
Oid
postgis_geometry(void)
{
	Oid			schema = schema_of_postgis();

	if (!OidIsValid(schema))
		return InvalidOid;
	return GetSysCacheOid2(TYPENAMENSP, Anum_pg_type_oid, CStringGetDatum(GEOMETRY),
						   ObjectIdGetDatum(schema));
}

/* Its name, and its schema. */
const char *
postgis_type_name(Oid *schema)
{
	*schema = schema_of_postgis();
	return GEOMETRY;
}

bool
postgis_owns_function(Oid function)
{
	Oid			extension = getExtensionOfObject(ProcedureRelationId, function);

	return OidIsValid(extension) && extension == get_extension_oid(POSTGIS, true);
}
