/*
 * lines_table.c: the table of a mesh's lines, found or made.
 *
 * A row is a point of a line: which line, its position there, the id that was given for it, its
 * place, the kind of the line, and the part of the line: neighbours are joined if theirs is the same.
 * It is NULL in lines of one part, where it takes no room. The first lines of a mesh make the table. It stays when the last
 * line goes.
 */
#include "postgres.h"

#include "catalog/pg_class.h"
#include "commands/defrem.h"
#include "miscadmin.h"
#include "utils/acl.h"
#include "utils/builtins.h"
#include "utils/lsyscache.h"

#include "pg/mesh/lines_table.h"
#include "pg/mesh/new_table.h"
#include "pg/port/port.h"

/* The name of the table in SQL, with its schema. */
char *
lines_table_name(Oid table)
{
	return quote_qualified_identifier(get_namespace_name(get_rel_namespace(table)),
									  get_rel_name(table));
}

/*
 * A query for the segments that end at a place, whose coordinates are its arguments: line, x and y of the
 * other end, and whether the line is hard.
 */
char *
lines_table_segments_at(Oid table)
{
	/* the point of the same line that comes before or after, if it is in the same part */
	static const char *const half =
		"SELECT p.line, o.x, o.y, p.kind OPERATOR(pg_catalog.=) 'hard' FROM %1$s AS p, LATERAL ("
		"SELECT n.x, n.y, n.part FROM %1$s AS n WHERE n.line OPERATOR(pg_catalog.=) p.line AND "
		"n.position OPERATOR(pg_catalog.%2$s) p.position ORDER BY n.position %3$s LIMIT 1) AS o "
		"WHERE p.x OPERATOR(pg_catalog.=) $1 AND p.y OPERATOR(pg_catalog.=) $2 AND "
		"COALESCE(o.part, 0) OPERATOR(pg_catalog.=) COALESCE(p.part, 0)";
	char	   *name = lines_table_name(table);

	return psprintf("%s UNION ALL %s", psprintf(half, name, "<", "DESC"), psprintf(half, name, ">", "ASC"));
}

/*
 * The table of the lines of a mesh that gets lines. If there is none, makes it, without the index
 * on places.
 */
Oid
lines_table_make(Relation mesh, bool *is_new)
{
	static const NewSideTable lines = {
		.suffix = LINES_TABLE_SUFFIX,.type = LINE_POINT_TYPE,.columns = LINE_POINT_COLUMNS,
		.options = "point WITH OPTIONS NOT NULL, x WITH OPTIONS NOT NULL, y WITH OPTIONS NOT NULL, "
		"kind WITH OPTIONS NOT NULL, PRIMARY KEY (line, position)",
		.contents = "lines",.maker = "abacus_constrain()",.reader = "abacus_lines()"
	};
	Oid			table = mesh_rows_table(mesh, MESH_LINES, MESH_WRITE);

	*is_new = !OidIsValid(table);
	return *is_new ? side_table_make(mesh, &lines) : table;
}

/* Makes the index on places: of a new table when it has its first rows, which is faster. */
void
lines_table_index(Relation mesh)
{
	Oid			table = mesh_rows_table(mesh, MESH_LINES, MESH_WRITE);

	side_table_create(mesh, psprintf("CREATE INDEX ON %s (x, y)", lines_table_name(table)), get_rel_name(table));
}

/*
 * Makes the index on vertices that lines have made, for a mesh that follows lines: unless it is there,
 * or the user is not the owner. Without it, the least id is found by reading all rows.
 */
void
lines_table_index_made(Relation mesh)
{
	Oid			table = mesh_rows_table(mesh, MESH_LINES, MESH_WRITE);
	char	   *name = makeObjectName(get_rel_name(table), "made", "idx");

	if (object_ownercheck(RelationRelationId, table, GetUserId()) &&
		!OidIsValid(get_relname_relid(name, get_rel_namespace(table))))
		side_table_create(mesh, psprintf("CREATE INDEX %s ON %s (point) WHERE made", quote_identifier(name),
							  lines_table_name(table)), get_rel_name(table));
}

/* The table of the lines of a mesh that has lines, so it must be there. */
Oid
lines_table_require(Relation mesh, MeshAccess access)
{
	Oid			table = mesh_rows_table(mesh, MESH_LINES, access);

	if (!OidIsValid(table))
		ereport(ERROR,
				(errcode(ERRCODE_UNDEFINED_TABLE),
				 errmsg("mesh \"%s\" has lines, but no table of lines", RelationGetRelationName(mesh)),
				 errdetail("There is no table \"%s" LINES_TABLE_SUFFIX "\" of type %s beside it that has its owner.",
						   RelationGetRelationName(mesh), LINE_POINT_TYPE),
				 errhint("After a restore, give the table of lines that name and the owner of the mesh, and call "
						 "abacus_set_srid() with the SRID that the mesh has; if it is lost, restore it from a backup.")));
	return table;
}

/* The table of a mesh with so many lines, which must be there if there are some; InvalidOid if there is none. */
Oid
lines_table_of(Relation mesh, uint64 lines)
{
	return lines > 0 ? lines_table_require(mesh, MESH_WRITE) : mesh_rows_table(mesh, MESH_LINES, MESH_WRITE);
}
