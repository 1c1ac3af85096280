/*
 * fn_attribute_change.c: abacus_add_attribute and abacus_drop_attribute.
 *
 * What vertices have is written anew, the simplices stay as they are, with their labels. A table that a mesh follows
 * has a column for each attribute, and the columns of a published mesh have the numbers of
 * attributes. So a mesh that follows a table keeps its attributes, and a published one those it has.
 */
#include "postgres.h"

#include "utils/builtins.h"
#include "utils/lsyscache.h"

#include "pg/base/sql_function.h"
#include "pg/mesh/change.h"
#include "pg/mesh/mesh.h"
#include "pg/mesh/names.h"
#include "pg/mesh/shape.h"
#include "pg/track/tracking.h"

SQL_FUNCTION(abacus_sql_add_attribute);
SQL_FUNCTION(abacus_sql_drop_attribute);

/* Opens a mesh that follows no table. */
static Change *
begin(FunctionCallInfo fcinfo, const char *command)
{
	Oid			mesh = PG_GETARG_OID(0);
	Oid			function = tracking_function(get_func_namespace(fcinfo->flinfo->fn_oid));
	Change	   *change = change_begin(mesh, command);
	List	   *triggers = tracking_triggers(function, mesh, InvalidOid);

	if (triggers != NIL)
	{
		const TrackingTrigger *trigger = linitial(triggers);
		const char *table = get_rel_name(tracking_root(trigger->table));

		ereport(ERROR,
				(errcode(ERRCODE_OBJECT_NOT_IN_PREREQUISITE_STATE),
				 errmsg("attributes of mesh \"%s\" are columns of table \"%s\", which it follows",
						get_rel_name(mesh), table),
				 errhint("Call abacus_untrack() before, and afterwards abacus_track() with "
						 "synchronize => true.")));
	}
	return change;
}

/* Gives all points the attributes `source`, the numbers of those they have had. */
static void
end(Change *change, const uint32 *source, uint32 count, const char *added)
{
	Host	   *host = change->writer.host;
	abacus_header *header = change->writer.header;

	change_attributes(change, source, count);
	if (host->names != NULL)
		names_move(header, host->names, source);
	if (added != NULL)
		strlcpy(header->names[count - 1], added, ABACUS_NAME_BYTES);
	change_end(change);
}

/* abacus_add_attribute(mesh regclass, attribute text) */
Datum
abacus_sql_add_attribute(PG_FUNCTION_ARGS)
{
	char	   *name = text_to_cstring(PG_GETARG_TEXT_PP(1));
	Change	   *change;
	const abacus_header *header;
	uint32		count;
	uint32	   *source;

	shape_check_name(name);
	change = begin(fcinfo, "abacus_add_attribute()");
	header = change->writer.header;
	count = header->attributes;
	header_require_new_name(header, name);
	shape_check_room(header);
	source = palloc((count + 1) * sizeof(uint32));
	for (uint32 i = 0; i < count; i++)
		source[i] = i;
	source[count] = ABACUS_NO_ATTRIBUTE;
	end(change, source, count + 1, name);
	PG_RETURN_VOID();
}

/* abacus_drop_attribute(mesh regclass, attribute text) */
Datum
abacus_sql_drop_attribute(PG_FUNCTION_ARGS)
{
	Oid			mesh = PG_GETARG_OID(0);
	char	   *name = text_to_cstring(PG_GETARG_TEXT_PP(1));
	Change	   *change = begin(fcinfo, "abacus_drop_attribute()");
	const abacus_header *header = change->writer.header;
	uint32		dropped = (uint32) header_find_attribute(header, name);
	uint32		count = 0;
	uint32	   *source = palloc(header->attributes * sizeof(uint32));

	if (mesh_is_shown(mesh))
		ereport(ERROR,
				(errcode(ERRCODE_DEPENDENT_OBJECTS_STILL_EXIST),
				 errmsg("cannot drop attribute \"%s\" of mesh \"%s\" because foreign tables show the mesh",
						name, get_rel_name(mesh)),
				 errhint("Call abacus_unpublish() before, and abacus_publish() afterwards.")));
	for (uint32 i = 0; i < header->attributes; i++)
		if (i != dropped)
			source[count++] = i;
	end(change, source, count, NULL);
	PG_RETURN_VOID();
}
