/*
 * geometry.c: geometries of PostGIS, as the core's coordinates.
 *
 * The module is not linked with PostGIS, and works without it. It finds the type geometry by its
 * name among the members of the extension postgis, wherever that has been installed. Values go
 * through the type's own send and receive functions: their bytes are EWKB, which PostGIS documents,
 * while what it stores is its own affair. A geometry is
 *
 *   byte order (0: big-endian, 1: little-endian), kind and flags, SRID if a flag says so, contents
 *
 * The contents of a point are its coordinates, those of a line their number and themselves, those of
 * a polygon the number of its rings and of each what a line has, and those of other kinds the number
 * of geometries and these, each with a head of its own. A point whose coordinates are all NaN is empty.
 */
#include "postgres.h"

#include <math.h>

#include "access/htup_details.h"
#include "access/xact.h"
#include "catalog/pg_type.h"
#include "commands/extension.h"
#include "port/pg_bswap.h"
#include "utils/builtins.h"
#include "utils/lsyscache.h"
#include "utils/memutils.h"
#include "utils/syscache.h"

#include "pg/input/geometry.h"
#include "pg/port/port.h"

#define HAS_Z 0x80000000
#define HAS_M 0x40000000
#define HAS_SRID 0x20000000
#define FLAGS (HAS_Z | HAS_M | HAS_SRID)

/* The name of a type, without its schema. */
const char *
geometry_type_name(Oid type)
{
	HeapTuple	tuple = SearchSysCache1(TYPEOID, ObjectIdGetDatum(type));
	const char *name = "";

	if (HeapTupleIsValid(tuple))
	{
		name = pstrdup(NameStr(((Form_pg_type) GETSTRUCT(tuple))->typname));
		ReleaseSysCache(tuple);
	}
	return name;
}

/* The name of a function of PostGIS in SQL, where the type geometry of these values is. */
char *
geometry_function(Oid type, const char *name)
{
	HeapTuple	tuple = SearchSysCache1(TYPEOID, ObjectIdGetDatum(getBaseType(type)));
	char	   *qualified;

	if (!HeapTupleIsValid(tuple))
		elog(ERROR, "cache lookup failed for type %u", type);
	qualified = quote_qualified_identifier(get_namespace_name(((Form_pg_type) GETSTRUCT(tuple))->typnamespace),
										   name);
	ReleaseSysCache(tuple);
	return qualified;
}

/* Whether a type is geometry of PostGIS, or a domain over it. */
bool
geometry_is_type(Oid type)
{
	Oid			base = getBaseType(type);
	Oid			extension;
	const char *name;

	if (strcmp(geometry_type_name(base), "geometry") != 0)
		return false;
	extension = getExtensionOfObject(TypeRelationId, base);
	name = OidIsValid(extension) ? get_extension_name(extension) : NULL;
	return name != NULL && strcmp(name, "postgis") == 0;
}

/* Looks the functions of a type up, one that geometry_is_type() knows; they stay in `memory`. */
void
geometry_open(GeometryType *type, Oid oid, MemoryContext memory)
{
	Oid			function;
	Oid			parameter;
	bool		varlena;

	type->type = getBaseType(oid);
	getTypeBinaryOutputInfo(type->type, &function, &varlena);
	fmgr_info_cxt(function, &type->send, memory);
	getTypeBinaryInputInfo(type->type, &function, &parameter);
	fmgr_info_cxt(function, &type->receive, memory);
}

/*
 * The same for functions that are called for every row. Within a statement the functions that were
 * found stay good.
 */
const GeometryType *
geometry_type(Oid oid)
{
	static GeometryType found;
	static TimestampTz statement;
	static MemoryContext memory = NULL;

	if (oid != found.type || statement != GetCurrentStatementStartTimestamp())
	{
		found.type = InvalidOid;
		if (memory == NULL)
			memory = AllocSetContextCreate(TopMemoryContext, "Abacus geometry",
										   ALLOCSET_SMALL_SIZES);
		MemoryContextReset(memory);
		if (!geometry_is_type(oid))
			elog(ERROR, "type %u is not geometry of PostGIS", oid);
		geometry_open(&found, oid, memory);
		statement = GetCurrentStatementStartTimestamp();
	}
	return &found;
}

/* What PostGIS calls it. */
const char *
geometry_kind(uint32 kind)
{
	static const char *const names[] = {
		"geometry", "Point", "LineString", "Polygon", "MultiPoint", "MultiLineString", "MultiPolygon",
		"GeometryCollection", "CircularString", "CompoundCurve", "CurvePolygon", "MultiCurve",
		"MultiSurface", "Curve", "Surface", "PolyhedralSurface", "Tin", "Triangle"
	};

	return kind < lengthof(names) ? names[kind] : "geometry of another kind";
}

/* ---- Reading --------------------------------------------------------------- */

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

/* A number of things that follow. */
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

/* What comes next is a geometry: its head. */
GeometryHead
geometry_head(GeometryBytes *bytes)
{
	unsigned char order;
	uint32		word;
	GeometryHead head;

	take(bytes, &order, 1);
#ifdef WORDS_BIGENDIAN
	bytes->swaps = order != 0;
#else
	bytes->swaps = order == 0;
#endif
	word = geometry_count(bytes);
	head.kind = word & ~FLAGS;
	head.has_z = (word & HAS_Z) != 0;
	head.has_m = (word & HAS_M) != 0;
	head.srid = (word & HAS_SRID) != 0 ? (int32) geometry_count(bytes) : 0;
	return head;
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
	point->at[0] = geometry_number(&bytes);
	point->at[1] = geometry_number(&bytes);
	point->at[2] = head.has_z ? geometry_number(&bytes) : 0;
	point->is_empty = isnan(point->at[0]) && isnan(point->at[1]);
}

/* ---- Errors ---------------------------------------------------------------- */

void
geometry_refuse_kind(const char *what, uint32 kind, const char *wanted)
{
	bool		is_curved = kind >= 8 && kind <= 14;
	bool		is_collection = kind >= GEOMETRY_MULTIPOINT && kind <= GEOMETRY_COLLECTION;

	ereport(ERROR,
			(errcode(ERRCODE_INVALID_PARAMETER_VALUE),
			 errmsg("%s is a %s, not %s", what, geometry_kind(kind), wanted),
			 is_curved ? errhint("ST_CurveToLine makes straight lines of curves.") :
			 is_collection ? errhint("ST_Dump gives the parts of a collection.") : 0));
}

/* Of two systems; `wanted` is that of the mesh. */
void
geometry_refuse_srid(const char *what, int32 srid, int32 wanted)
{
	if (wanted == 0)
		ereport(ERROR,
				(errcode(ERRCODE_INVALID_PARAMETER_VALUE),
				 errmsg("%s has SRID %d, but the mesh has none", what, srid),
				 errhint("If the coordinates of the mesh are of that system, say so by "
						 "abacus_set_srid(mesh, %d).", srid)));
	ereport(ERROR,
			(errcode(ERRCODE_INVALID_PARAMETER_VALUE),
			 srid == 0 ? errmsg("%s has no SRID, but the mesh has SRID %d", what, wanted)
			 : errmsg("%s has SRID %d, but the mesh has SRID %d", what, srid, wanted),
			 srid == 0 ? errhint("If its coordinates are of that system, say so by "
								 "ST_SetSRID(geometry, %d).", wanted)
			 : errhint("Transform it by ST_Transform(geometry, %d).", wanted)));
}
