/*
 * shortcuts.h: where Abacus does more than PostgreSQL offers to extensions, and the switch that
 * turns all of it off.
 *
 * The shortcuts use functions and structures that PostgreSQL keeps for itself. Each has a plain
 * way beside it, which uses what is offered: the same meshes, more slowly or with more space. They
 * are
 *
 * - heap pages added many at a time by fallocate (PostgreSQL 15; later versions offer it);
 * - a row read from the buffer where it was, past the table of buffers, and buffers mapped ahead;
 * - versions of rows that a transaction has itself replaced, pruned before it ends;
 * - VACUUM, after which rows are moved, by a hook of utility statements.
 *
 * make ABACUS_SHORTCUTS=0 compiles none. The setting abacus.shortcuts tells which build it is.
 */
#ifndef ABACUS_SHORTCUTS_H
#define ABACUS_SHORTCUTS_H

#ifndef ABACUS_SHORTCUTS
#define ABACUS_SHORTCUTS 1
#endif

#endif
