/*
 * area_argument.c: polygons, prepared for questions to a mesh.
 *
 * A function that is called for every row of a query usually gets the same polygon again. So the last
 * one is remembered.
 */
#include "postgres.h"

#include "utils/memutils.h"

#include "pg/host/host.h"
#include "pg/postgis/geometry_errors.h"
#include "pg/sql/arguments/area_argument.h"
#include "pg/geos/area_text.h"

static void
require_mesh(const abacus_form *form, const AreaText *area, const char *mesh)
{
	if (form->dimension != 2)
		ereport(ERROR,
				(errcode(ERRCODE_INVALID_PARAMETER_VALUE),
				 errmsg("within is a polygon, but mesh \"%s\" has dimension %u", mesh, form->dimension),
				 errhint("Polygons are for meshes in the plane.")));
	if (area->srid != 0 && (uint32) area->srid != form->srid)
		geometry_refuse_srid("within", area->srid, (int32) form->srid, "mesh");
}

/* The polygon of a text, for a mesh in the plane; it lives as long as the memory. */
const abacus_area *
area_open(const char *text, const abacus_form *form, const char *mesh, MemoryContext memory)
{
	AreaText	read = area_text_read("within", text);
	Host	   *host;
	abacus_area *area = NULL;

	require_mesh(form, &read, mesh);
	host = host_create(memory);
	host_run(host, abacus_area_open, &host->table, read.points, read.sizes, read.rings, &area);
	host_own(host, area, (void (*) (void *)) abacus_area_close);
	pfree(read.points);
	pfree(read.sizes);
	return area;
}

/* The same, until the next call. */
const abacus_area *
area_remembered(const char *text, const abacus_form *form, const char *mesh)
{
	static struct
	{
		MemoryContext memory;	/* NULL: there is none */
		char	   *text;
		uint32		dimension,
					srid;
		const abacus_area *area;
	}			last;
	MemoryContext memory;
	const abacus_area *area;

	if (last.memory != NULL && last.dimension == form->dimension && last.srid == form->srid &&
		strcmp(last.text, text) == 0)
		return last.area;
	memory = AllocSetContextCreate(CurrentMemoryContext, "Abacus polygon", ALLOCSET_SMALL_SIZES);
	area = area_open(text, form, mesh, memory);
	text = MemoryContextStrdup(memory, text);
	if (last.memory != NULL)
		MemoryContextDelete(last.memory);
	MemoryContextSetParent(memory, TopMemoryContext);
	last.memory = memory;
	last.text = unconstify(char *, text);
	last.dimension = form->dimension;
	last.srid = form->srid;
	last.area = area;
	return area;
}
