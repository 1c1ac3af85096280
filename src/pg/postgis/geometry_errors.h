/*
 * geometry_errors.h: errors about geometries, with hints.
 */
#ifndef ABACUS_POSTGIS_GEOMETRY_ERRORS_H
#define ABACUS_POSTGIS_GEOMETRY_ERRORS_H

extern void geometry_refuse_kind(const char *what, uint32 kind, const char *wanted);
extern void geometry_refuse_coordinate(const char *what);
extern void geometry_refuse_srid(const char *what, int32 srid, int32 wanted, const char *whole);

#endif
