/*
 * on_duplicate.h: an argument that says what happens to a point at the place of another.
 */
#ifndef ABACUS_ON_DUPLICATE_H
#define ABACUS_ON_DUPLICATE_H

#include "postgres.h"

#include "abacus/build.h"

extern abacus_on_duplicate on_duplicate_argument(text *given);

#endif
