/*
 * geometry_place.c: arguments of functions for PostGIS: places, and arrays of coordinates and values.
 */
#include "postgres.h"

#include "catalog/pg_type.h"

#include "pg/postgis/geometry_errors.h"
#include "pg/sql/postgis/geometry_place.h"

/* The type of an argument that is a geometry; for argument -1, of the result. */
const GeometryType *
geometry_argument_type(FunctionCallInfo fcinfo, int argument)
{
	return geometry_type(argument < 0 ? get_fn_expr_rettype(fcinfo->flinfo)
						 : get_fn_expr_argtype(fcinfo->flinfo, argument));
}

/* An error unless a geometry has the system of the mesh. */
void
geometry_check_srid(const abacus_form *form, int32 srid)
{
	if (srid != (int32) form->srid)
		geometry_refuse_srid("the geometry", srid, (int32) form->srid, "mesh");
}

/* The coordinates of a point; z is ignored in the plane. False for an empty point. */
bool
geometry_place(FunctionCallInfo fcinfo, int argument, const char *what,
			   const abacus_form *form, double *place)
{
	GeometryPoint point;

	geometry_point(geometry_argument_type(fcinfo, argument), PG_GETARG_DATUM(argument), what, &point);
	geometry_check_srid(form, point.srid);
	if (point.is_empty)
		return false;
	if (form->dimension > 2 && !point.has_z)
		ereport(ERROR,
				(errcode(ERRCODE_INVALID_PARAMETER_VALUE),
				 errmsg("%s has no z, but the mesh has dimension %u", what, form->dimension),
				 errhint("Add one with ST_Force3DZ(geometry, z).")));
	memcpy(place, point.at, form->dimension * sizeof(double));
	return true;
}

/* The numbers of a float8[] of any shape; their number is a multiple of `of`, and none is NULL. */
const double *
geometry_numbers(ArrayType *array, int of, size_t *count)
{
	*count = (size_t) ArrayGetNItems(ARR_NDIM(array), ARR_DIMS(array));
	if (array_contains_nulls(array) || *count == 0 || *count % of != 0)
		ereport(ERROR,
				(errcode(ERRCODE_ARRAY_SUBSCRIPT_ERROR),
				 errmsg("the array must have a multiple of %d elements, none of them NULL", of)));
	return (const double *) ARR_DATA_PTR(array);
}

/*
 * The attribute at the three corners of a triangle; its number counts from 1. False if it is
 * missing at a corner.
 */
bool
geometry_corner_values(ArrayType *array, int attribute, double *values)
{
	Datum	   *all;
	bool	   *isnull;
	int			count;

	deconstruct_array(array, FLOAT8OID, sizeof(float8), FLOAT8PASSBYVAL, TYPALIGN_DOUBLE, &all, &isnull,
					  &count);
	if (attribute < 1 || attribute > count / 3)
		ereport(ERROR,
				(errcode(ERRCODE_ARRAY_SUBSCRIPT_ERROR),
				 errmsg("the corners have no attribute %d", attribute)));
	for (int i = 0; i < 3; i++)
	{
		int			at = i * (count / 3) + attribute - 1;

		if (isnull[at])
			return false;
		values[i] = DatumGetFloat8(all[at]);
	}
	return true;
}
