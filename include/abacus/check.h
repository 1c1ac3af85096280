/*
 * check.h: a mesh verified, and whether its domain fits it.
 */
#ifndef ABACUS_ABACUS_CHECK_H
#define ABACUS_ABACUS_CHECK_H

#include "abacus/facts.h"

#ifdef __cplusplus
extern "C" {
#endif

/*
 * Whether the mesh's domain fits its points, judged by the counts in the header and by a few pages;
 * if not, abacus_build_rekey() helps.
 */
ABACUS_API abacus_status abacus_domain_fits(const abacus_host *host, const abacus_facts *facts,
											int *fits, abacus_error *error);

typedef struct abacus_fault
{
	abacus_key key;       /* page where the fault was seen; vertex page: code = first sequence number */
	const char *kind;     /* a short fixed word, e.g. "orientation" */
	char message[256];
} abacus_fault;

/*
 * Verifies the mesh exactly, once, when opened; then returns the faults (at most `limit`). The
 * header must have been read by abacus_header_decode(): faults that it refuses are not checked
 * again.
 */
typedef struct abacus_check abacus_check;
ABACUS_API abacus_status abacus_check_open(const abacus_host *host, const abacus_facts *facts,
										   size_t cache_bytes, size_t limit, abacus_check **check,
										   abacus_error *error);
ABACUS_API abacus_status abacus_check_next(abacus_check *check, abacus_fault *fault);
/* Simplices whose volume, computed in doubles, is lost in rounding; this is not a fault. */
ABACUS_API uint64_t abacus_check_flat(const abacus_check *check);
/* Edges that are fixed, and soft ones among them: as many as the lines of the mesh have
 * (constrain.h). */
ABACUS_API uint64_t abacus_check_fixed(const abacus_check *check, uint64_t *soft);
ABACUS_API void abacus_check_close(abacus_check *check);

#ifdef __cplusplus
}
#endif

#endif
