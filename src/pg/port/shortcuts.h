/*
 * shortcuts.h: the places where Abacus does more than PostgreSQL offers to extensions, and the
 * switch that turns all of it off.
 *
 * The shortcuts use functions and structures that PostgreSQL keeps for itself. Each has a plain
 * alternative, which uses only what PostgreSQL offers: the same meshes, but slower or with more
 * space. They are
 *
 * - heap pages added many at a time by fallocate (PostgreSQL 15; later versions offer it);
 * - a row read from the buffer where it was, without the table of buffers; buffers mapped ahead;
 * - versions of rows that a transaction has itself replaced, pruned before it ends;
 * - moving rows after VACUUM, by a hook of utility statements.
 *
 * make ABACUS_SHORTCUTS=0 compiles none of them. The setting abacus.shortcuts shows which build it
 * is.
 */
#ifndef ABACUS_SHORTCUTS_H
#define ABACUS_SHORTCUTS_H

#ifndef ABACUS_SHORTCUTS
#define ABACUS_SHORTCUTS 1
#endif

#endif
