/*
 * truncate.h: cuts the file of a table whose rows are all dead.
 */
#ifndef ABACUS_TRUNCATE_H
#define ABACUS_TRUNCATE_H

extern bool truncate_if_empty(Oid relid);

#endif
