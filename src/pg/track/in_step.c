/*
 * in_step.c: checks whether a mesh is what its triggers expect.
 */
#include "postgres.h"

#include "pg/mesh/numbering.h"
#include "pg/postgis/geometry_errors.h"
#include "pg/track/in_step.h"

/* Whether the mesh has exactly the attributes for which the trigger was made. */
void
in_step_check_shape(const Change *change, ExpectedShape expected, const char *trigger)
{
	const abacus_facts *facts = &change->writer.header->facts;
	Numbering  *numbering = palloc(sizeof(Numbering));

	if ((int) facts->form.dimension != expected.dimension ||
		(int) (1 + facts->form.dimension + facts->columns.attributes) != expected.columns)
		ereport(ERROR,
				(errcode(ERRCODE_OBJECT_NOT_IN_PREREQUISITE_STATE),
				 errmsg("trigger \"%s\" was made for another mesh", trigger),
				 errdetail("The mesh has dimension %u and %u attributes.", facts->form.dimension,
						   facts->columns.attributes),
				 errhint("Drop the trigger, and call abacus_track().")));
	numbering_read(change->writer.host, &facts->columns, numbering);
	if (numbering->dropped != expected.dropped)
		ereport(ERROR,
				(errcode(ERRCODE_OBJECT_NOT_IN_PREREQUISITE_STATE),
				 errmsg("trigger \"%s\" was made for other attributes", trigger),
				 errdetail("An attribute of the mesh has been dropped since."),
				 errhint("Drop the trigger, and call abacus_track().")));
	pfree(numbering);
}

/*
 * Whether the geometries read have the mesh's system. If it has none, it takes theirs. srid is 0 if
 * they have none, -1 if there were no geometries.
 */
void
in_step_check_srid(Change *change, int32 srid)
{
	uint32		wanted = change->writer.header->facts.form.srid;

	if (srid > 0 && wanted != 0 && srid != (int32) wanted)
		geometry_refuse_srid("a geometry of the tracked table", srid, (int32) wanted, "mesh");
	change_take_srid(change, srid);
}

/* Whether all points that the table changed were found; `what`: "delete" or "change". */
void
in_step_check_found(const Change *change, const char *table, const char *what, uint64 wanted,
					uint64 found)
{
	if (found != wanted)
		ereport(ERROR,
				(errcode(ERRCODE_OBJECT_NOT_IN_PREREQUISITE_STATE),
				 errmsg("mesh \"%s\" is not in step with table \"%s\"",
						RelationGetRelationName(mesh_pages(change->writer.host)->simplices.heap), table),
				 errdetail("Points to %s: " UINT64_FORMAT "; found: " UINT64_FORMAT ".", what, wanted,
						   found),
				 errhint("Bring it in step with abacus_track(mesh, table, synchronize => true). If "
						 "an AFTER trigger changes the rows of its own statement again, make it a "
						 "BEFORE trigger: such changes cannot be followed.")));
}
