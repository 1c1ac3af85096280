/*
 * settings.h: the extension's settings.
 */
#ifndef ABACUS_SETTINGS_H
#define ABACUS_SETTINGS_H

/* Host calls until one fails, set by abacus.fail_host_call; the host counts it down. */
extern int	setting_calls_to_failure;

extern void settings_define(void);
extern size_t setting_cache_bytes(void);
extern size_t setting_sort_bytes(void);
extern size_t setting_query_sort_bytes(void);
extern int	setting_threads(void);
extern bool setting_tiny_intervals(void);
extern bool setting_vacuum_moves_rows(void);

#endif
