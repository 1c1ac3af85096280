/*
 * geometry_read.c: reads geometries of PostGIS from the bytes that ewkb.h describes.
 */
#include "postgres.h"

#include "port/pg_bswap.h"
#include "utils/builtins.h"

#include "pg/port/port.h"
#include "pg/postgis/geometry_errors.h"
#include "pg/postgis/geometry_read.h"

static void
take(GeometryBytes *bytes, void *value, size_t size)
{
	if (size > (size_t) (bytes->end - bytes->at))
		ereport(ERROR,
				(errcode(ERRCODE_INVALID_BINARY_REPRESENTATION),
				 errmsg("the bytes of a geometry end too early")));
	memcpy(value, bytes->at, size);
	bytes->at += size;
}

/* Reads how many elements follow. */
uint32
geometry_count(GeometryBytes *bytes)
{
	uint32		value;

	take(bytes, &value, sizeof(value));
	return bytes->swaps ? pg_bswap32(value) : value;
}

double
geometry_number(GeometryBytes *bytes)
{
	uint64		bits;
	double		value;

	take(bytes, &bits, sizeof(bits));
	if (bytes->swaps)
		bits = pg_bswap64(bits);
	memcpy(&value, &bits, sizeof(value));
	return value;
}

/* The bytes of a geometry, in the current memory context. */
GeometryBytes
geometry_bytes(const GeometryType *type, Datum geometry)
{
	bytea	   *sent = SendFunctionCall(unconstify(FmgrInfo *, &type->send), geometry);
	GeometryBytes bytes = {(unsigned char *) VARDATA(sent)};

	bytes.end = bytes.at + VARSIZE(sent) - VARHDRSZ;
	return bytes;
}

/* The same in hexadecimal digits, as a text. */
char *
geometry_hex(const GeometryType *type, Datum geometry)
{
	GeometryBytes bytes = geometry_bytes(type, geometry);
	size_t		size = (size_t) (bytes.end - bytes.at);
	char	   *digits = MemoryContextAllocHuge(CurrentMemoryContext, 2 * size + 1);

	digits[hex_encode((const char *) bytes.at, size, digits)] = '\0';
	return digits;
}

/* Reads the head of a geometry. */
GeometryHead
geometry_head(GeometryBytes *bytes)
{
	unsigned char order;
	uint32		word;
	GeometryHead head;

	take(bytes, &order, 1);
	bytes->swaps = (order != 0) != (EWKB_ORDER != 0);
	word = geometry_count(bytes);
	head.kind = word & ~EWKB_FLAGS;
	head.has_z = (word & EWKB_Z) != 0;
	head.has_m = (word & EWKB_M) != 0;
	head.srid = (word & EWKB_SRID) != 0 ? (int32) geometry_count(bytes) : 0;
	return head;
}

/* Reads a place of a geometry: x, y, z, m; 0 stands for missing ones. */
void
geometry_coordinates(GeometryBytes *bytes, const GeometryHead *head, double *at)
{
	at[0] = geometry_number(bytes);
	at[1] = geometry_number(bytes);
	at[2] = head->has_z ? geometry_number(bytes) : 0;
	at[3] = head->has_m ? geometry_number(bytes) : 0;
}

/* Reads a geometry that must be a point; `what` names it for messages. */
void
geometry_point(const GeometryType *type, Datum geometry, const char *what, GeometryPoint *point)
{
	GeometryBytes bytes = geometry_bytes(type, geometry);
	GeometryHead head = geometry_head(&bytes);

	if (head.kind != GEOMETRY_POINT)
		geometry_refuse_kind(what, head.kind, "a Point");
	point->srid = head.srid;
	point->has_z = head.has_z;
	geometry_coordinates(&bytes, &head, point->at);
	point->is_empty = geometry_is_nowhere(point->at);
}
