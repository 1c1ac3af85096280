/*
 * vacuum.h: VACUUM of a mesh moves its rows before it cuts the file.
 */
#ifndef ABACUS_VACUUM_H
#define ABACUS_VACUUM_H

extern void vacuum_init(void);

#endif
