/*
 * units.c: coordinates in degrees, and calls that do not fit them.
 *
 * Abacus computes with plain coordinates. If the SRID of a mesh, or a window, shows that a result
 * cannot be the intended one, a NOTICE says so: once for each statement, since a function may be
 * called for every row.
 */
#include "postgres.h"

#include <math.h>

#include "access/xact.h"
#include "pg/postgis/reference_system.h"
#include "pg/sql/arguments/units.h"

typedef enum UnitsNote
{
	NOTE_SLOPES = 1,
	NOTE_VOLUMES = 2,
	NOTE_SHADING = 4,
	NOTE_WINDOW = 8
} UnitsNote;

/* Limits of longitude and latitude; longitudes may go from 0 to 360. */
#define MOST_LONGITUDE 360.0
#define MOST_LATITUDE 90.0

/* What this statement has looked up and reported. */
static struct
{
	TimestampTz statement;
	int			said;
	int32		srid;			/* 0: nothing looked up yet */
	bool		is_geographic;
} current;

static void
look_at_statement(void)
{
	if (current.statement == GetCurrentStatementStartTimestamp())
		return;
	current.statement = GetCurrentStatementStartTimestamp();
	current.said = 0;
	current.srid = 0;
	current.is_geographic = false;
}

static bool
is_geographic(const abacus_form *form)
{
	int32		srid = (int32) form->srid;

	if (srid != current.srid)
	{
		current.is_geographic = srid != 0 && reference_system_is_geographic(srid);
		current.srid = srid;
	}
	return current.is_geographic;
}

/* Whether to give a notice: not if this statement has given it already. */
static bool
begins(UnitsNote note)
{
	if ((current.said & note) != 0)
		return false;
	current.said |= note;
	return true;
}

/* Gradients and slopes of a mesh in degrees are useless. */
void
units_tell_slopes(const abacus_form *form)
{
	look_at_statement();
	if (is_geographic(form) && begins(NOTE_SLOPES))
		ereport(NOTICE,
				(errmsg("slopes and gradients are per degree: the coordinates are longitude and latitude"),
				 errdetail("The mesh has SRID %u.", form->srid),
				 errhint("Transform the points to a system in metres before they are triangulated, "
						 "for instance with ST_Transform of PostGIS.")));
}

/* So are areas and volumes. */
void
units_tell_volumes(const abacus_form *form)
{
	look_at_statement();
	if (is_geographic(form) && begins(NOTE_VOLUMES))
		ereport(NOTICE,
				(errmsg("areas and volumes are over square degrees: the coordinates are longitude and latitude"),
				 errdetail("The mesh has SRID %u.", form->srid),
				 errhint("Transform the points to a system in metres before they are triangulated, "
						 "for instance with ST_Transform of PostGIS.")));
}

/* Hill shading with heights in metres over degrees shows only cliffs. */
void
units_tell_shading(const abacus_form *form, double exaggeration)
{
	look_at_statement();
	if (exaggeration > 1e-3 && is_geographic(form) && begins(NOTE_SHADING))
		ereport(NOTICE,
				(errmsg("hills are shaded as if degrees were metres: the coordinates are longitude and latitude"),
				 errdetail("The mesh has SRID %u.", form->srid),
				 errhint("Use exaggeration => 9e-6 to show slopes of heights in metres as they "
						 "are: a degree of latitude has 111,320 m.")));
}

static bool
may_be_degrees(const double *lower, const double *upper)
{
	return lower[0] >= -MOST_LONGITUDE && upper[0] <= MOST_LONGITUDE && lower[1] >= -MOST_LATITUDE &&
		upper[1] <= MOST_LATITUDE;
}

/*
 * The window misses the mesh, and one of the two is in degrees while the other cannot be. In other
 * cases an empty answer needs no explanation.
 */
void
units_tell_window(const abacus_form *form, const double *lower, const double *upper)
{
	bool		meets = true;
	bool		window_may;
	bool		mesh_may;

	if (form->has_domain == 0)
		return;
	for (uint32 i = 0; i < form->dimension; i++)
		meets &= lower[i] <= form->upper[i] && upper[i] >= form->lower[i];
	window_may = may_be_degrees(lower, upper);
	mesh_may = may_be_degrees(form->lower, form->upper);
	if (meets || window_may == mesh_may)
		return;
	look_at_statement();
	if (mesh_may && !is_geographic(form))
		return;
	if (!begins(NOTE_WINDOW))
		return;
	ereport(NOTICE,
			(errmsg("the window does not meet the mesh"),
			 errdetail("The window reaches from (%.9g, %.9g) to (%.9g, %.9g), the domain of the mesh from (%.9g, %.9g) to (%.9g, %.9g).",
					   lower[0], lower[1], upper[0], upper[1], form->lower[0], form->lower[1],
					   form->upper[0], form->upper[1]),
			 window_may ? errhint("The window looks like longitude and latitude, the mesh does not. Transform the "
								  "window to the system of the mesh.")
			 : errhint("The mesh is in longitude and latitude, the window is not. Transform the window.")));
}
