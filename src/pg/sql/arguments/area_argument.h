/*
 * area_argument.h: polygons, prepared for questions.
 */
#ifndef ABACUS_AREA_ARGUMENT_H
#define ABACUS_AREA_ARGUMENT_H

#include "abacus/area.h"
#include "abacus/facts.h"

extern const abacus_area *area_open(const char *text, const abacus_form *form, const char *mesh,
									MemoryContext memory);
extern const abacus_area *area_remembered(const char *text, const abacus_form *form, const char *mesh);

#endif
