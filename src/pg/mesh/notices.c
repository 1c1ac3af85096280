/*
 * notices.c: notices of unexpected things that are not errors: points that equal a vertex, points that span no
 * simplex, and tables with the name of one that the mesh may have.
 */
#include "postgres.h"

#include "utils/lsyscache.h"

#include "pg/mesh/notices.h"

/* Reports points that equal a vertex. `hint`: the caller can choose what happens to them. */
void
notice_equal_points(const char *mesh, uint64 points, bool hint)
{
	if (points == 0)
		return;
	ereport(NOTICE,
			(errmsg_plural(UINT64_FORMAT " point equals a vertex of mesh \"%s\"",
						   UINT64_FORMAT " points equal vertices of mesh \"%s\"",
						   (unsigned long) points, points, mesh),
			 errdetail("A vertex has the id and the attributes of the point that came first; "
					   "the others are kept beside it."),
			 hint ? errhint("Use on_duplicate => 'replace' to take the id and the attributes from "
							"the last point.") : 0));
}

/* Reports points that wait since they span no simplex. */
void
notice_waiting_points(const char *mesh, uint32 dimension, uint64 points)
{
	if (points == 0)
		return;
	ereport(NOTICE,
			(errmsg_plural(UINT64_FORMAT " point of mesh \"%s\" waits: it spans no simplex",
						   UINT64_FORMAT " points of mesh \"%s\" wait: they span no simplex",
						   (unsigned long) points, points, mesh),
			 points <= dimension
			 ? errdetail("A %s has %u vertices.", dimension == 2 ? "triangle" : "tetrahedron", dimension + 1)
			 : dimension == 2 ? errdetail("All are on one line.")
			 : errdetail("All are in one plane.")));
}

static const char *
name_of(const Writer *writer)
{
	return RelationGetRelationName(mesh_pages(writer->host)->simplices.heap);
}

/* Points that equal a vertex; `before`: how many there were before the change. */
void
notice_duplicates(const Writer *writer, uint64 before, bool hint)
{
	uint64		now = writer->header->facts.census.duplicates;

	notice_equal_points(name_of(writer), now - Min(now, before), hint);
}

void
notice_waiting(const Writer *writer)
{
	const abacus_facts *facts = &writer->header->facts;

	if (facts->census.vertices == 0)
		notice_waiting_points(name_of(writer), facts->form.dimension, facts->census.staged - facts->census.inserted);
}

/* Reports a table that may be taken for one of the mesh, and is not; true if there is no such table. */
bool
notice_namesake(Oid mesh, SideRows rows)
{
	Oid			table = mesh_find_namesake(mesh, rows);
	bool		is_own = OidIsValid(table) && mesh_table_owner(table) == mesh_table_owner(mesh);

	if (!OidIsValid(table))
		return true;
	ereport(NOTICE,
			(errmsg("table \"%s\" is not part of mesh \"%s\"", get_rel_name(table), get_rel_name(mesh)),
			 is_own ? errdetail("It was restored alone, or an earlier mesh has left it.")
			 : errdetail("It has another owner."),
			 is_own ? errhint("If it is the mesh's, call abacus_set_srid() with the SRID that the mesh has, which binds it.")
			 : errhint("If it is the mesh's, give it the owner of the mesh. Otherwise rename one of them.")));
	return false;
}
