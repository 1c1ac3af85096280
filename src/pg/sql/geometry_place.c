/*
 * geometry_place.c: geometries of PostGIS as arguments: places, paths, areas.
 */
#include "postgres.h"

#include "pg/postgis/geometry_errors.h"
#include "pg/sql/geometry_place.h"

/* The type of an argument that is a geometry, or that of the result: argument -1. */
const GeometryType *
geometry_argument_type(FunctionCallInfo fcinfo, int argument)
{
	return geometry_type(argument < 0 ? get_fn_expr_rettype(fcinfo->flinfo)
						 : get_fn_expr_argtype(fcinfo->flinfo, argument));
}

/* A geometry is of the system of the mesh. */
void
geometry_check_srid(const abacus_header *header, int32 srid)
{
	if (srid != (int32) header->srid)
		geometry_refuse_srid("the geometry", srid, (int32) header->srid, "mesh");
}

/* The coordinates of a point; a z in the plane is passed over. False for an empty one. */
bool
geometry_place(FunctionCallInfo fcinfo, int argument, const char *what,
			   const abacus_header *header, double *place)
{
	GeometryPoint point;

	geometry_point(geometry_argument_type(fcinfo, argument), PG_GETARG_DATUM(argument), what, &point);
	geometry_check_srid(header, point.srid);
	if (point.is_empty)
		return false;
	if (header->dimension > 2 && !point.has_z)
		ereport(ERROR,
				(errcode(ERRCODE_INVALID_PARAMETER_VALUE),
				 errmsg("%s has no z, but the mesh has dimension %u", what, header->dimension),
				 errhint("ST_Force3DZ(geometry, z) gives it one.")));
	memcpy(place, point.at, header->dimension * sizeof(double));
	return true;
}
