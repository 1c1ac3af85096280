/*
 * extension_type.h: types of other extensions.
 */
#ifndef ABACUS_EXTENSION_TYPE_H
#define ABACUS_EXTENSION_TYPE_H

extern Oid	extension_type(const char *extension, const char *type);

#endif
