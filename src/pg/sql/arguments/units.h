/*
 * units.h: coordinates in degrees, and what does not go with them.
 */
#ifndef ABACUS_UNITS_H
#define ABACUS_UNITS_H

#include "abacus/mesh_header.h"

extern void units_tell_slopes(const abacus_header *header);
extern void units_tell_volumes(const abacus_header *header);
extern void units_tell_shading(const abacus_header *header, double exaggeration);
extern void units_tell_window(const abacus_header *header, const double *lower, const double *upper);

#endif
