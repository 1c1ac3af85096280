/*
 * geometry_write.c: makes geometries of PostGIS from the bytes that ewkb.h describes, in the byte
 * order of the machine.
 *
 * A geometry is received as a column receives it, with the column's type modifier. The modifier
 * gives the SRID for a geometry without one.
 */
#include "postgres.h"

#include "utils/memutils.h"

#include "pg/postgis/geometry_write.h"

void
geometry_put_head(StringInfo bytes, const GeometryHead *head)
{
	uint32		word = head->kind;

	if (head->has_z)
		word |= EWKB_Z;
	if (head->has_m)
		word |= EWKB_M;
	if (head->srid != 0)
		word |= EWKB_SRID;
	appendStringInfoChar(bytes, EWKB_ORDER);
	appendBinaryStringInfo(bytes, (const char *) &word, sizeof(word));
	if (head->srid != 0)
		appendBinaryStringInfo(bytes, (const char *) &head->srid, sizeof(head->srid));
}

void
geometry_put_count(StringInfo bytes, size_t count)
{
	uint32		word = (uint32) count;

	appendBinaryStringInfo(bytes, (const char *) &word, sizeof(word));
}

void
geometry_put_numbers(StringInfo bytes, const double *numbers, size_t count)
{
	size_t		size = count * sizeof(double);

	if (size > MaxAllocSize)
		ereport(ERROR,
				(errcode(ERRCODE_PROGRAM_LIMIT_EXCEEDED),
				 errmsg("a geometry of %zu numbers is larger than a value can be", count)));
	appendBinaryStringInfo(bytes, (const char *) numbers, (int) size);
}

/* Appends a line, or a ring whose first place is repeated at the end. */
void
geometry_put_places(StringInfo bytes, const double *places, size_t count, int dimension, bool closes)
{
	geometry_put_count(bytes, count + closes);
	geometry_put_numbers(bytes, places, count * dimension);
	if (closes)
		geometry_put_numbers(bytes, places, dimension);
}

/* Appends a triangle, or a polygon that is a triangle; with z if the head has it. */
void
geometry_put_triangle(StringInfo bytes, const GeometryHead *head, const double *corners)
{
	geometry_put_head(bytes, head);
	geometry_put_count(bytes, 1);
	geometry_put_places(bytes, corners, 3, 2 + head->has_z, true);
}

/*
 * Appends the closed surface of a tetrahedron: four facets, counterclockwise as seen from outside.
 */
void
geometry_put_tetrahedron(StringInfo bytes, const double *corners, int32 srid)
{
	static const int facets[4][3] = {{1, 2, 3}, {0, 3, 2}, {0, 1, 3}, {0, 2, 1}};
	GeometryHead head = {GEOMETRY_POLYHEDRAL, srid, true};
	GeometryHead facet = {GEOMETRY_POLYGON, 0, true};

	geometry_put_head(bytes, &head);
	geometry_put_count(bytes, lengthof(facets));
	for (int i = 0; i < lengthof(facets); i++)
	{
		double		ring[3 * 3];

		for (int j = 0; j < 3; j++)
			memcpy(ring + j * 3, corners + facets[i][j] * 3, 3 * sizeof(double));
		geometry_put_triangle(bytes, &facet, ring);
	}
}

/* The geometry from these bytes, as a column with this type modifier receives it. */
Datum
geometry_received(const GeometryType *type, StringInfo bytes, int32 modifier)
{
	return ReceiveFunctionCall(unconstify(FmgrInfo *, &type->receive), bytes, type->type, modifier);
}

/* The geometry from these bytes. */
Datum
geometry_made(const GeometryType *type, StringInfo bytes)
{
	return geometry_received(type, bytes, -1);
}
