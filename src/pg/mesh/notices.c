/*
 * notices.c: notices of what is no error, but unexpected: points that equal a vertex,
 * and points that span no simplex.
 */
#include "postgres.h"

#include "pg/mesh/notices.h"

/*
 * Points that equal a vertex; `before`: as many as there were before the change. `hint`: the caller
 * can choose what becomes of them.
 */
void
notice_duplicates(const Writer *writer, uint64 before, bool hint)
{
	const abacus_header *header = writer->header;
	uint64		points;

	if (header->duplicates <= before)
		return;
	points = header->duplicates - before;
	ereport(NOTICE,
			(errmsg_plural(UINT64_FORMAT " point equals a vertex of mesh \"%s\"",
						   UINT64_FORMAT " points equal vertices of mesh \"%s\"",
						   (unsigned long) points, points,
						   RelationGetRelationName(mesh_pages(writer->host)->simplices.heap)),
			 errdetail("A vertex has the id and the attributes of the point that came first; "
					   "the others are kept beside it."),
			 hint ? errhint("With on_duplicate => 'replace' it gets those of the point that comes "
							"last.") : 0));
}

/* Points that wait since they span no simplex. */
void
notice_waiting(const Writer *writer)
{
	const abacus_header *header = writer->header;
	uint64		points = header->staged - header->inserted;

	if (header->vertices > 0 || points == 0)
		return;
	ereport(NOTICE,
			(errmsg_plural(UINT64_FORMAT " point of mesh \"%s\" waits: it spans no simplex",
						   UINT64_FORMAT " points of mesh \"%s\" wait: they span no simplex",
						   (unsigned long) points, points,
						   RelationGetRelationName(mesh_pages(writer->host)->simplices.heap)),
			 points <= header->dimension
			 ? errdetail("A %s has %u vertices.", header->dimension == 2 ? "triangle" : "tetrahedron",
						 header->dimension + 1)
			 : header->dimension == 2 ? errdetail("All are on one line.")
			 : errdetail("All are in one plane.")));
}
