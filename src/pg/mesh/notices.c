/*
 * notices.c: notices of unexpected things that are not errors: points that equal a vertex, and
 * points that span no simplex.
 */
#include "postgres.h"

#include "pg/mesh/notices.h"

/*
 * Reports points that equal a vertex; `before`: how many there were before the change. `hint`: the
 * caller can choose what happens to them.
 */
void
notice_duplicates(const Writer *writer, uint64 before, bool hint)
{
	const abacus_facts *facts = &writer->header->facts;
	uint64		points;

	if (facts->census.duplicates <= before)
		return;
	points = facts->census.duplicates - before;
	ereport(NOTICE,
			(errmsg_plural(UINT64_FORMAT " point equals a vertex of mesh \"%s\"",
						   UINT64_FORMAT " points equal vertices of mesh \"%s\"",
						   (unsigned long) points, points,
						   RelationGetRelationName(mesh_pages(writer->host)->simplices.heap)),
			 errdetail("A vertex has the id and the attributes of the point that came first; "
					   "the others are kept beside it."),
			 hint ? errhint("Use on_duplicate => 'replace' to take the id and the attributes from "
							"the last point.") : 0));
}

/* Reports points that wait since they span no simplex. */
void
notice_waiting(const Writer *writer)
{
	const abacus_facts *facts = &writer->header->facts;
	uint64		points = facts->census.staged - facts->census.inserted;

	if (facts->census.vertices > 0 || points == 0)
		return;
	ereport(NOTICE,
			(errmsg_plural(UINT64_FORMAT " point of mesh \"%s\" waits: it spans no simplex",
						   UINT64_FORMAT " points of mesh \"%s\" wait: they span no simplex",
						   (unsigned long) points, points,
						   RelationGetRelationName(mesh_pages(writer->host)->simplices.heap)),
			 points <= facts->form.dimension
			 ? errdetail("A %s has %u vertices.", facts->form.dimension == 2 ? "triangle" : "tetrahedron",
						 facts->form.dimension + 1)
			 : facts->form.dimension == 2 ? errdetail("All are on one line.")
			 : errdetail("All are in one plane.")));
}
