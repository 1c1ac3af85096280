/*
 * reference_system.h: the facts about a spatial reference system, by its number.
 */
#ifndef ABACUS_REFERENCE_SYSTEM_H
#define ABACUS_REFERENCE_SYSTEM_H

extern bool reference_system_is_geographic(int32 srid);

#endif
