// A condition that the code around it relies on. It is tested in sanitized and debug builds,
// and not even evaluated in others (NDEBUG). What comes from outside, stored bytes above all,
// is never asserted. It is checked in every build, and what is wrong with it is an Error.
#pragma once

#include <cassert>

#define ABACUS_ASSERT(condition) assert(condition)
