/*
 * settings.h: the extension's settings.
 */
#ifndef ABACUS_SETTINGS_H
#define ABACUS_SETTINGS_H

/* Calls of the host until one fails, as abacus.fail_host_call asks; the host counts it down. */
extern int	setting_calls_to_failure;

extern void settings_define(void);
extern size_t setting_cache_bytes(void);
extern size_t setting_sort_bytes(void);
extern size_t setting_query_sort_bytes(void);
extern int	setting_threads(void);
extern bool setting_tiny_intervals(void);
extern bool setting_vacuum_moves_rows(void);

#endif
