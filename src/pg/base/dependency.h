/*
 * dependency.h: tables that depend on others automatically, by pg_depend.
 */
#ifndef ABACUS_DEPENDENCY_H
#define ABACUS_DEPENDENCY_H

extern Oid	dependency_find(Oid class, Oid object, bool dependent, bool (*wanted) (Oid));

#endif
