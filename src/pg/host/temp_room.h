/*
 * temp_room.h: whether there is room for temporary files, before they are written.
 */
#ifndef ABACUS_TEMP_ROOM_H
#define ABACUS_TEMP_ROOM_H

extern bool temp_room_has(double bytes);
extern void temp_room_require(double bytes);
extern void temp_room_require_rows(double rows, int bytes_per_row);

#endif
