/*
 * missing.h: explains why an answer about values is empty.
 */
#ifndef ABACUS_MISSING_H
#define ABACUS_MISSING_H

#include "pg/mesh/reader.h"

extern void notice_missing_values(Reader *reader, uint32 attribute);

#endif
