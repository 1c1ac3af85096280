/*
 * units.h: coordinates in degrees, and calls that do not fit them.
 */
#ifndef ABACUS_UNITS_H
#define ABACUS_UNITS_H

#include "abacus/facts.h"

extern void units_tell_slopes(const abacus_form *form);
extern void units_tell_volumes(const abacus_form *form);
extern void units_tell_shading(const abacus_form *form, double exaggeration);
extern void units_tell_window(const abacus_form *form, const double *lower, const double *upper);

#endif
