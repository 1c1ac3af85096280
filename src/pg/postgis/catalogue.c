/*
 * catalogue.c: PostGIS as it is found in the catalogues.
 *
 * PostGIS may be missing, or be installed later, in any version and any schema. So this module does
 * not link to it. It finds the type, the functions, and those behind operators, by their names and
 * by their membership in the extension.
 */
#include "postgres.h"

#include "access/genam.h"
#include "access/htup_details.h"
#include "access/table.h"
#include "access/xact.h"
#include "catalog/dependency.h"
#include "catalog/indexing.h"
#include "catalog/pg_extension.h"
#include "catalog/pg_proc.h"
#include "catalog/pg_type.h"
#include "commands/extension.h"
#include "utils/builtins.h"
#include "utils/fmgroids.h"
#include "utils/lsyscache.h"
#include "utils/memutils.h"
#include "utils/syscache.h"

#include "pg/base/extension_type.h"
#include "pg/postgis/catalogue.h"

#define POSTGIS "postgis"
#define GEOMETRY "geometry"

/* ---- The extension ------------------------------------------------------- */

/* Whether an object belongs to PostGIS. */
bool
postgis_owns(Oid catalogue, Oid object)
{
	Oid			extension = getExtensionOfObject(catalogue, object);

	return OidIsValid(extension) && extension == get_extension_oid(POSTGIS, true);
}

bool
postgis_owns_function(Oid function)
{
	return postgis_owns(ProcedureRelationId, function);
}

/* The type geometry; InvalidOid if there is none. */
Oid
postgis_geometry(void)
{
	return extension_type(POSTGIS, GEOMETRY);
}

/* ---- Types --------------------------------------------------------------- */

/* The name of a type, without its schema. */
const char *
geometry_type_name(Oid type)
{
	HeapTuple	tuple = SearchSysCache1(TYPEOID, ObjectIdGetDatum(type));
	const char *name = "";

	if (HeapTupleIsValid(tuple))
	{
		name = pstrdup(NameStr(((Form_pg_type) GETSTRUCT(tuple))->typname));
		ReleaseSysCache(tuple);
	}
	return name;
}

/* Whether a type is geometry of PostGIS, or a domain over it. */
bool
geometry_is_type(Oid type)
{
	Oid			base = getBaseType(type);

	return strcmp(geometry_type_name(base), GEOMETRY) == 0 && postgis_owns(TypeRelationId, base);
}

/* The SQL name of a PostGIS function, in the schema of these values' type geometry. */
char *
geometry_function(Oid type, const char *name)
{
	HeapTuple	tuple = SearchSysCache1(TYPEOID, ObjectIdGetDatum(getBaseType(type)));
	char	   *qualified;

	if (!HeapTupleIsValid(tuple))
		elog(ERROR, "cache lookup failed for type %u", type);
	qualified = quote_qualified_identifier(get_namespace_name(((Form_pg_type) GETSTRUCT(tuple))->typnamespace),
										   name);
	ReleaseSysCache(tuple);
	return qualified;
}

/* Looks up the functions of a type that geometry_is_type() accepts; they stay in `memory`. */
void
geometry_open(GeometryType *type, Oid oid, MemoryContext memory)
{
	Oid			function;
	Oid			parameter;
	bool		varlena;

	type->type = getBaseType(oid);
	getTypeBinaryOutputInfo(type->type, &function, &varlena);
	fmgr_info_cxt(function, &type->send, memory);
	getTypeBinaryInputInfo(type->type, &function, &parameter);
	fmgr_info_cxt(function, &type->receive, memory);
}

/*
 * The same for functions that are called for every row. The result stays valid within a statement.
 */
const GeometryType *
geometry_type(Oid oid)
{
	static GeometryType found;
	static TimestampTz statement;
	static MemoryContext memory = NULL;

	if (oid != found.type || statement != GetCurrentStatementStartTimestamp())
	{
		found.type = InvalidOid;
		if (memory == NULL)
			memory = AllocSetContextCreate(TopMemoryContext, "Abacus geometry",
										   ALLOCSET_SMALL_SIZES);
		MemoryContextReset(memory);
		if (!geometry_is_type(oid))
			elog(ERROR, "type %u is not geometry of PostGIS", oid);
		geometry_open(&found, oid, memory);
		statement = GetCurrentStatementStartTimestamp();
	}
	return &found;
}
