/*
 * fn_attribute_change.c: abacus_add_attribute and abacus_drop_attribute.
 *
 * The attributes of vertices are rewritten; the simplices stay as they are, with their labels. So
 * loaded meshes that are not Delaunay can have other attributes, too. A
 * table that a mesh follows has a column for each attribute, so such a mesh keeps its attributes.
 * So does a mesh that its owner, or the caller, has published. Foreign tables of others do not
 * prevent dropping an attribute: they report that it is gone when they are read.
 */
#include "postgres.h"

#include "miscadmin.h"
#include "utils/builtins.h"
#include "utils/lsyscache.h"

#include "pg/base/sql_function.h"
#include "pg/mesh/change.h"
#include "pg/mesh/mesh.h"
#include "pg/mesh/names.h"
#include "pg/mesh/numbering.h"
#include "pg/mesh/shape.h"
#include "pg/mesh/shown.h"
#include "pg/track/by_hand.h"

SQL_FUNCTION(abacus_sql_add_attribute);
SQL_FUNCTION(abacus_sql_drop_attribute);

/* Opens a mesh; an error if it follows a table. */
static Change *
begin(FunctionCallInfo fcinfo, const char *command)
{
	Change	   *change = change_begin(PG_GETARG_OID(0), command);

	by_hand_refuse_attributes(change);
	return change;
}

/* Gives all points the attributes `source`, the numbers of their former ones. */
static void
end(Change *change, const uint32 *source, uint32 count, const char *added)
{
	Host	   *host = change->writer.host;
	abacus_header *header = change->writer.header;

	numbering_change(host, &header->facts.columns, source, count);
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
	abacus_names names;
	uint32		count;
	uint32	   *source;

	shape_check_name(name);
	change = begin(fcinfo, "abacus_add_attribute()");
	names = abacus_names_of(change->writer.header);
	count = names.facts->columns.attributes;
	header_require_new_name(names, name);
	shape_check_room(names.facts);
	if (names.facts->census.split > 0)
		shape_check_split(count + 1);
	source = palloc((count + 1) * sizeof(uint32));
	for (uint32 i = 0; i < count; i++)
		source[i] = i;
	source[count] = ABACUS_NO_ATTRIBUTE;
	end(change, source, count + 1, name);
	PG_RETURN_VOID();
}

/* The tables among some that belong to the mesh's owner or to the user; or the other ones. */
static List *
tables_of(List *tables, Oid mesh, bool own)
{
	Oid			owner = mesh_table_owner(mesh);
	List	   *found = NIL;
	ListCell   *cell;

	foreach(cell, tables)
	{
		Oid			other = mesh_table_owner(lfirst_oid(cell));

		if ((other == owner || other == GetUserId()) == own)
			found = lappend_oid(found, lfirst_oid(cell));
	}
	return found;
}

/*
 * Foreign tables that show the mesh: an error if some belong to the owner or the user, who can
 * unpublish them. If others own them, a notice says what happens to them.
 */
static void
check_shown(Oid mesh, const char *attribute)
{
	List	   *tables = shown_tables(mesh);
	List	   *own = tables_of(tables, mesh, true);
	List	   *of_others = tables_of(tables, mesh, false);

	if (own != NIL)
		ereport(ERROR,
				(errcode(ERRCODE_DEPENDENT_OBJECTS_STILL_EXIST),
				 errmsg("cannot drop attribute \"%s\" of mesh \"%s\" because foreign tables show the mesh",
						attribute, get_rel_name(mesh)),
				 errdetail("The foreign tables are %s.", shown_names(own)),
				 errhint("Call abacus_unpublish() first, and abacus_publish() afterwards.")));
	if (of_others != NIL)
		ereport(NOTICE,
				(errmsg("foreign tables of other users, which show mesh \"%s\", can no longer show attribute \"%s\"",
						get_rel_name(mesh), attribute),
				 errdetail("The foreign tables are %s.", shown_names(of_others)),
				 errhint("Ask their owners to unpublish the mesh and publish it again.")));
}

/* The attributes after this one move up, which users do not see who read them by position. */
static void
tell_of_moved(abacus_names names, uint32 dropped)
{
	if (dropped + 1 < names.facts->columns.attributes)
		ereport(NOTICE,
				(errmsg("attributes after \"%s\" move up by one position", names.of[dropped]),
				 errdetail("Expressions that take values by position, such as attributes[%u], now "
						   "get another attribute.", dropped + 2)));
}

/* abacus_drop_attribute(mesh regclass, attribute text) */
Datum
abacus_sql_drop_attribute(PG_FUNCTION_ARGS)
{
	Oid			mesh = PG_GETARG_OID(0);
	char	   *name = text_to_cstring(PG_GETARG_TEXT_PP(1));
	Change	   *change = begin(fcinfo, "abacus_drop_attribute()");
	abacus_names names = abacus_names_of(change->writer.header);
	uint32		dropped = (uint32) header_find_attribute(names, name);
	uint32		count = 0;
	uint32	   *source = palloc(names.facts->columns.attributes * sizeof(uint32));

	check_shown(mesh, name);
	tell_of_moved(names, dropped);
	for (uint32 i = 0; i < names.facts->columns.attributes; i++)
		if (i != dropped)
			source[count++] = i;
	end(change, source, count, NULL);
	PG_RETURN_VOID();
}
