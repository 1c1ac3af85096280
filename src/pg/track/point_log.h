/*
 * point_log.h: points in the order in which they came; it can be cut off at any place.
 */
#ifndef ABACUS_POINT_LOG_H
#define ABACUS_POINT_LOG_H

typedef struct PointLog PointLog;

extern PointLog *point_log_create(MemoryContext memory);
extern void point_log_close(PointLog *log);
extern void point_log_write(PointLog *log, uint64 at, const void *bytes, size_t size);
extern void point_log_read(PointLog *log, uint64 at, void *bytes, size_t size);

#endif
