/*
 * remote_pages.h: the pages of a mesh over several servers as the core's page operations.
 */
#ifndef ABACUS_REMOTE_PAGES_H
#define ABACUS_REMOTE_PAGES_H

extern void remote_pages_init(void);

#endif
