/*
 * geometry.h: geometries of PostGIS, as the core's coordinates.
 */
#ifndef ABACUS_GEOMETRY_H
#define ABACUS_GEOMETRY_H

#include "abacus/header.h"
#include "fmgr.h"

/* Kinds of geometries, as OGC numbers them. */
enum
{
	GEOMETRY_POINT = 1,
	GEOMETRY_LINE,
	GEOMETRY_POLYGON,
	GEOMETRY_MULTIPOINT,
	GEOMETRY_MULTILINE,
	GEOMETRY_MULTIPOLYGON,
	GEOMETRY_COLLECTION,
	GEOMETRY_POLYHEDRAL = 15,
	GEOMETRY_TIN,
	GEOMETRY_TRIANGLE
};

/* How values of the type geometry become bytes and are made of them. */
typedef struct GeometryType
{
	Oid			type;
	FmgrInfo	send;
	FmgrInfo	receive;
} GeometryType;

/* One point. */
typedef struct GeometryPoint
{
	int32		srid;			/* 0: none */
	bool		is_empty;
	bool		has_z;
	double		at[ABACUS_MAX_DIMENSION];
} GeometryPoint;

/* Bytes of a geometry, while they are read; begins with geometry_bytes(). */
typedef struct GeometryBytes
{
	const unsigned char *at;
	const unsigned char *end;
	bool		swaps;			/* its numbers have the other byte order */
} GeometryBytes;

/* What a geometry, or one inside another, begins with. */
typedef struct GeometryHead
{
	uint32		kind;
	int32		srid;			/* 0: none */
	bool		has_z;
	bool		has_m;
} GeometryHead;

extern bool geometry_is_type(Oid type);
extern const char *geometry_type_name(Oid type);
extern char *geometry_function(Oid type, const char *name);
extern void geometry_open(GeometryType *type, Oid oid, MemoryContext memory);
extern const GeometryType *geometry_type(Oid oid);
extern const char *geometry_kind(uint32 kind);

extern GeometryBytes geometry_bytes(const GeometryType *type, Datum geometry);
extern GeometryHead geometry_head(GeometryBytes *bytes);
extern uint32 geometry_count(GeometryBytes *bytes);
extern double geometry_number(GeometryBytes *bytes);
extern void geometry_point(const GeometryType *type, Datum geometry, const char *what,
						   GeometryPoint *point);
extern void geometry_refuse_kind(const char *what, uint32 kind, const char *wanted);
extern void geometry_refuse_srid(const char *what, int32 srid, int32 wanted);

#endif
