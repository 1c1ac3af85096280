/*
 * new_table.c: what others may do to a table while CREATE TABLE makes it, as a
 * statement of ours: drop its schema before, or itself after, by an event trigger.
 */
#include "postgres.h"

#include "catalog/namespace.h"
#include "utils/lsyscache.h"

#include "pg/mesh/new_table.h"

/* The schema in which it will be, locked: it is still there when a statement names it. */
Oid
new_table_schema(RangeVar *name)
{
	return RangeVarGetAndCheckCreationNamespace(name, NoLock, NULL);
}

/* The table that has just been made there. */
Oid
new_table_id(Oid schema, const char *name)
{
	Oid			table = get_relname_relid(name, schema);

	if (!OidIsValid(table))
		ereport(ERROR,
				(errcode(ERRCODE_UNDEFINED_TABLE),
				 errmsg("table \"%s\" does not exist any more", name),
				 errdetail("It was dropped or renamed as soon as it had been made."),
				 errhint("Look for an event trigger that does so.")));
	return table;
}
