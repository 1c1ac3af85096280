/*
 * vacuum.h: lets VACUUM of a mesh move its rows before the file is cut.
 */
#ifndef ABACUS_VACUUM_H
#define ABACUS_VACUUM_H

extern void vacuum_init(void);

#endif
