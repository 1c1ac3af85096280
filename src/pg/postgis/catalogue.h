/*
 * catalogue.h: PostGIS as it is found in the catalogues, without its library.
 */
#ifndef ABACUS_POSTGIS_CATALOGUE_H
#define ABACUS_POSTGIS_CATALOGUE_H

#include "fmgr.h"

/* How values of the type geometry are converted to bytes and back. */
typedef struct GeometryType
{
	Oid			type;
	FmgrInfo	send;
	FmgrInfo	receive;
} GeometryType;

extern Oid	postgis_geometry(void);
extern bool postgis_owns(Oid catalogue, Oid object);
extern bool postgis_owns_function(Oid function);

/* Whether a column with this modifier of geometry has only geometries with z. */
static inline bool
geometry_typmod_has_z(int32 typmod)
{
	return typmod >= 0 && (typmod & 2) != 0;
}

extern bool geometry_is_type(Oid type);
extern const char *geometry_type_name(Oid type);
extern char *geometry_function(Oid type, const char *name);
extern void geometry_open(GeometryType *type, Oid oid, MemoryContext memory);
extern const GeometryType *geometry_type(Oid oid);

#endif
