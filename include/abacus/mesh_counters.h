/*
 * mesh_counters.h: what has been done with a mesh or an octree, counted (chapter 5 of the
 * dissertation).
 */
#ifndef ABACUS_ABACUS_MESH_COUNTERS_H
#define ABACUS_ABACUS_MESH_COUNTERS_H

#include <stdint.h>

#ifdef __cplusplus
extern "C" {
#endif

typedef struct abacus_counters
{
	uint64_t insertions;       /* vertices added */
	uint64_t removals;         /* vertices removed */
	uint64_t steps;            /* links followed: walk, cavity, rim */
	uint64_t misses;           /* links that led out of the cache (§4.10) */
	uint64_t link_probes;      /* page look-ups by a stored neighbour key */
	uint64_t quick_probes;     /* §4.10.1 */
	uint64_t ray_probes;       /* §4.10.2 */
	uint64_t concentric_probes;/* §4.10.3 */
	uint64_t incircle_tests;   /* insertions that asked the application cache (§4.12.4) */
	uint64_t incircle_hits;    /* ... and were answered */
	uint64_t walks;            /* point locations by walking */
	uint64_t created;          /* simplices created */
	uint64_t deleted;          /* simplices deleted */
	uint64_t loads;            /* pages read into the cache */
	uint64_t stores;           /* pages written from the cache */
	uint64_t rewrites;         /* ... of them in place of an older version */
	uint64_t splits;           /* blocks split */
	uint64_t merges;           /* blocks dissolved into their neighbours on the curve */
	uint64_t evictions;        /* blocks dropped from the cache */
	uint64_t eviction_batches;
	uint64_t bytes_read;
	uint64_t bytes_written;
	uint64_t translation_ns;   /* time between the two representations, host calls included */
	uint64_t total_ns;         /* time in the core, host calls included */
	uint64_t peak_bytes;       /* largest amount of memory the cache held */
	uint64_t passes;           /* of several threads over points */
	uint64_t put_off;          /* points that a pass left to the next one */
	uint64_t waited_ns;        /* time that threads waited for the session's, of all together */
} abacus_counters;

#ifdef __cplusplus
}
#endif

#endif
