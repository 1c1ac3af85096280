/*
 * spool.h: temporary files, written and then read from start to end.
 */
#ifndef ABACUS_SPOOL_H
#define ABACUS_SPOOL_H

extern void *spool_create(MemoryContext memory);
extern void spool_write(void *spool, const void *bytes, size_t size);
extern void spool_rewind(void *spool);
extern bool spool_read(void *spool, void *bytes, size_t size);
extern void spool_close(void *spool);

#endif
