/*
 * new_table.c: protects a table while a CREATE TABLE of ours makes it. Others may drop its schema
 * before, drop the table after (by an event trigger), or make another one with that name.
 */
#include "postgres.h"

#include "catalog/namespace.h"
#include "catalog/pg_class.h"
#include "commands/comment.h"
#include "utils/builtins.h"
#include "utils/lsyscache.h"
#include "utils/varlena.h"

#include "pg/base/utility.h"
#include "pg/mesh/mesh.h"
#include "pg/mesh/new_table.h"

/* A name as in SQL, perhaps with a schema. */
RangeVar *
new_table_name(text *name)
{
	char	   *given = text_to_cstring(name);
	List	   *parts;

	if (!SplitIdentifierString(pstrdup(given), '.', &parts) || parts == NIL)
		ereport(ERROR,
				(errcode(ERRCODE_INVALID_NAME),
				 errmsg("invalid name \"%s\"", given),
				 strpbrk(given, ".\"") != NULL || given[0] == '\0'
				 ? errhint("Write it as in SQL: schema.name, each part in double quotes unless it "
						   "is a plain identifier.")
				 : errhint("Write it as in SQL, in double quotes unless it is a plain identifier: "
						   "'\"%s\"'.", given)));
	return makeRangeVarFromNameList(textToQualifiedNameList(name));
}

/* The schema of the new table, locked, so that it still exists when a statement names it. */
Oid
new_table_schema(RangeVar *name)
{
	return RangeVarGetAndCheckCreationNamespace(name, NoLock, NULL);
}

/* Checks that the name is free. CREATE TABLE would too, but without a hint. */
void
new_table_check_name(Oid schema, const char *name)
{
	Oid			other = get_relname_relid(name, schema);
	bool		is_mesh;

	if (!OidIsValid(other))
		return;
	is_mesh = mesh_of_table(other) == other;
	ereport(ERROR,
			(errcode(ERRCODE_DUPLICATE_TABLE),
			 is_mesh ? errmsg("mesh \"%s\" already exists", name)
			 : errmsg("relation \"%s\" already exists", name),
			 is_mesh ? errhint("Drop it with DROP TABLE, add points to it with abacus_insert(), or "
							   "choose another name.")
			 : errhint("Choose another name for the mesh, or drop the relation.")));
}

/* Whether an error is about two rows with the same name in a catalogue. */
static bool
is_name_taken(const ErrorData *error)
{
	return error->sqlerrcode == ERRCODE_UNIQUE_VIOLATION && error->constraint_name != NULL &&
		(strcmp(error->constraint_name, "pg_type_typname_nsp_index") == 0 ||
		 strcmp(error->constraint_name, "pg_class_relname_nsp_index") == 0);
}

/* Runs CREATE TABLE. A session that has just committed may have taken the name meanwhile. */
void
new_table_create(const char *command, const char *name)
{
	MemoryContext memory = CurrentMemoryContext;

	PG_TRY();
	{
		utility_run(command);
	}
	PG_CATCH();
	{
		ErrorData  *error;

		MemoryContextSwitchTo(memory);
		error = CopyErrorData();
		if (!is_name_taken(error))
			PG_RE_THROW();
		FlushErrorState();
		ereport(ERROR,
				(errcode(ERRCODE_DUPLICATE_TABLE),
				 errmsg("relation \"%s\" already exists", name),
				 errdetail("Another session has made it at the same time."),
				 errhint("Choose another name, or use the existing relation.")));
	}
	PG_END_TRY();
}

/* The table that was just made. */
Oid
new_table_id(Oid schema, const char *name)
{
	Oid			table = get_relname_relid(name, schema);

	if (!OidIsValid(table))
		ereport(ERROR,
				(errcode(ERRCODE_UNDEFINED_TABLE),
				 errmsg("table \"%s\" no longer exists", name),
				 errdetail("It was dropped or renamed as soon as it had been made."),
				 errhint("Look for an event trigger that does so.")));
	return table;
}

/* Writes comments: that of the table is `what`, those of its columns come from its row type. */
void
new_table_describe(Oid table, const char *what, Oid row, int columns)
{
	CreateComments(table, RelationRelationId, 0, what);
	for (int32 column = 1; column <= columns; column++)
		CreateComments(table, RelationRelationId, column,
					   GetComment(row, RelationRelationId, column));
}
