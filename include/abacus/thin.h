/*
 * thin.h: a mesh thinned to a stated error: another one of some of its vertices, such that the
 * others lie within the error of its surface.
 */
#ifndef ABACUS_ABACUS_THIN_H
#define ABACUS_ABACUS_THIN_H

#include "abacus/build.h"

#ifdef __cplusplus
extern "C" {
#endif

/*
 * Both meshes have the same dimension, domain and attributes. The thinned one grows by steps, each
 * of which adds vertices of the other one to a stage; the caller inserts them, and calls
 * abacus_thin_inserted(). What a step adds depends on the two meshes alone.
 */
typedef struct abacus_thinning abacus_thinning;

typedef enum abacus_thin_step
{
	ABACUS_THIN_START,  /* into an empty mesh: corners of the hull that span a simplex */
	ABACUS_THIN_HULL,   /* more corners of the hull; until none is added */
	ABACUS_THIN_BORDER, /* vertices on the border of the other mesh */
	ABACUS_THIN_LINES,  /* vertices of its fixed edges, which all must have values */
	ABACUS_THIN_KEEP,   /* vertices with the ids of abacus_thin_keep() */
	ABACUS_THIN_WORST   /* the worst vertex of each simplex; until none is added */
} abacus_thin_step;

typedef struct abacus_thin_options
{
	uint32_t attribute;  /* the surface; vertices without a finite value are left out */
	double max_error;    /* finite and not negative */
	uint64_t target;     /* vertices at most, as far as the step WORST adds them */
	size_t sort_bytes;   /* for sorting */
	size_t cache_bytes;  /* for simplices of the thinned mesh */
} abacus_thin_options;

/* `facts` are those of the mesh that is thinned; the host lasts as long as the handle. */
ABACUS_API abacus_status abacus_thin_open(const abacus_host *host, const abacus_facts *facts,
										  const abacus_thin_options *options,
										  abacus_thinning **thinning, abacus_error *error);
/*
 * Adds the vertices of a step to a stage for the thinned mesh, which has these facts; *added says
 * how many. ABACUS_ERROR (argument) if the vertices with values span no simplex.
 */
ABACUS_API abacus_status abacus_thin_find(abacus_thinning *thinning, abacus_thin_step step,
										  const abacus_host *source, const abacus_facts *source_facts,
										  const abacus_facts *facts, abacus_stage *stage,
										  uint64_t *added, abacus_error *error);
/* The vertices of the last step are in the mesh now. Only then may a transaction end. */
ABACUS_API abacus_status abacus_thin_inserted(abacus_thinning *thinning, const abacus_facts *facts,
											  abacus_error *error);
/*
 * The greatest error of all vertices with values, rounded to the nearest double, and how many
 * vertices have none.
 */
ABACUS_API abacus_status abacus_thin_greatest(abacus_thinning *thinning, const abacus_host *source,
											  const abacus_facts *source_facts,
											  const abacus_facts *facts, double *greatest,
											  uint64_t *without_value, abacus_error *error);
/* The ids that the steps KEEP from now on are about. */
ABACUS_API abacus_status abacus_thin_keep(abacus_thinning *thinning, const int64_t *ids,
										  size_t count, abacus_error *error);
/* How many of them no vertex of the mesh has: after the step. */
ABACUS_API uint64_t abacus_thin_unknown_ids(const abacus_thinning *thinning);
ABACUS_API void abacus_thin_close(abacus_thinning *thinning);

#ifdef __cplusplus
}
#endif

#endif
