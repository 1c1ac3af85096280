/*
 * names.h: names of attributes in the encoding in which they are stored.
 */
#ifndef ABACUS_NAMES_H
#define ABACUS_NAMES_H

#include "abacus/header.h"

extern int	names_find_invalid(const abacus_header *header);
extern void names_to_database(abacus_header *header);
extern void names_to_storage(abacus_header *header);

#endif
