/*
 * shards.h: one mesh over several servers: which server owns a place, and what they send each other.
 */
#ifndef ABACUS_ABACUS_SHARDS_H
#define ABACUS_ABACUS_SHARDS_H

#include "abacus/facts.h"
#include "abacus/simplex.h"

#ifdef __cplusplus
extern "C" {
#endif

/* A box; empty where lower is above upper. */
typedef struct abacus_box
{
	double lower[ABACUS_MAX_DIMENSION];
	double upper[ABACUS_MAX_DIMENSION];
} abacus_box;

/* ---- The plan ---------------------------------------------------------------- */

/* How many points a survey has at most in its sample. */
#define ABACUS_SURVEY_POINTS 16384

/*
 * A survey of points, which becomes the plan for all shards. The facts have the shape of the points,
 * and the domain if it is given.
 */
typedef struct abacus_survey abacus_survey;
ABACUS_API abacus_status abacus_survey_open(const abacus_host *host, const abacus_facts *facts,
											abacus_survey **survey, abacus_error *error);
/* Adds `count` points as in abacus_stage_add. */
ABACUS_API abacus_status abacus_survey_add(abacus_survey *survey, const uint64_t *points,
										   size_t count, abacus_error *error);
/* Adds the result of another survey: `count` points of its sample, `dimension` doubles each. */
ABACUS_API abacus_status abacus_survey_merge(abacus_survey *survey, uint64_t points,
											 const abacus_box *box, const double *sample,
											 size_t count, abacus_error *error);
/*
 * The result: the number of points, their box, and the sample, `count` points of `dimension` doubles,
 * valid until the next call.
 */
ABACUS_API abacus_status abacus_survey_result(abacus_survey *survey, uint64_t *points,
											  abacus_box *box, const double **sample, size_t *count,
											  abacus_error *error);
/*
 * The plan: gives the form the domain that a mesh of all these points would get (none without
 * points), and writes shards - 1 borders, codes that ascend. Shard i owns the codes from border i - 1
 * on, up to border i.
 */
ABACUS_API abacus_status abacus_survey_plan(abacus_survey *survey, uint32_t shards,
											abacus_form *form, uint64_t *borders,
											abacus_error *error);
ABACUS_API void abacus_survey_close(abacus_survey *survey);

/* The codes of `count` points, `dimension` doubles each, over the domain of a mesh, which has one. */
ABACUS_API abacus_status abacus_codes(const abacus_form *form, const double *points, size_t count,
									  uint64_t *codes, abacus_error *error);

/*
 * *order is below 0 if point a is nearer to a place than b is, above 0 if it is farther away; compared
 * exactly, and of points equally far the one with the lexicographically least coordinates comes first.
 */
ABACUS_API abacus_status abacus_compare_nearness(uint32_t dimension, const double *place,
												 const double *a, const double *b, int *order,
												 abacus_error *error);

/* ---- The exchange ------------------------------------------------------------ */

/*
 * The vertices of a shard's mesh that other shards need. `extent` contains all points of all shards.
 * When no shard has anything to send that its receiver does not have, each simplex with a corner of
 * the shard's own is one of the triangulation of all points; the shard owns those whose code it owns.
 */
typedef struct abacus_exports abacus_exports;
ABACUS_API abacus_status abacus_exports_open(const abacus_host *host, const abacus_facts *facts,
											 const uint64_t *borders, size_t count, uint32_t shard,
											 const abacus_box *extent, abacus_exports **exports,
											 abacus_error *error);
/*
 * The next one, and the shard that needs it; ABACUS_END after the last. The same one may come
 * several times.
 */
ABACUS_API abacus_status abacus_exports_next(abacus_exports *exports, uint32_t *shard,
											 abacus_vertex *vertex, abacus_error *error);
/* In place of all of them: how many simplices of the mesh the shard owns. */
ABACUS_API abacus_status abacus_exports_count(abacus_exports *exports, uint64_t *owned,
											  abacus_error *error);
/*
 * Gets a vertex that simplices around a place say, and the shard that needs it. May fail as a host
 * function may.
 */
typedef abacus_host_status (*abacus_export_report)(void *context, uint32_t shard,
												   const abacus_vertex *vertex);
/*
 * The same for the simplices with a vertex at a place (`dimension` finite doubles). After a change
 * it is enough to ask about the places of new vertices, and of all that had a simplex with one that
 * has gone, if the mesh had simplices before and has some now; else abacus_exports_next says what
 * is to be sent.
 */
ABACUS_API abacus_status abacus_exports_around(abacus_exports *exports, const double *place,
											   abacus_export_report report, void *context,
											   abacus_error *error);
ABACUS_API void abacus_exports_close(abacus_exports *exports);

/* ---- A shard's part of the mesh ---------------------------------------------- */

/*
 * What a shard has of the mesh of all shards, as pages of a kind (simplices or attributes): of the
 * codes from `first` to `last`, none if last < first. They begin with the page that owns `from`;
 * those of attributes end with its group. The pages of all shards together are those of one mesh.
 */
typedef struct abacus_own_pages abacus_own_pages;
ABACUS_API abacus_status abacus_own_pages_open(const abacus_host *host, const abacus_facts *facts,
											   abacus_page_kind kind, uint64_t first, uint64_t last,
											   const abacus_key *from, abacus_own_pages **pages,
											   abacus_error *error);
/* The next one, valid until the next call; ABACUS_END after the last. */
ABACUS_API abacus_status abacus_own_pages_next(abacus_own_pages *pages, abacus_page *page,
											   abacus_error *error);
/* The key at which they end. */
ABACUS_API abacus_key abacus_own_pages_end(const abacus_own_pages *pages);
ABACUS_API void abacus_own_pages_close(abacus_own_pages *pages);
/* The code in the key of a page of this kind: it says which shard has the page. */
ABACUS_API uint64_t abacus_key_code(abacus_page_kind kind, const abacus_key *key);
/* How many simplices and ghosts it owns. */
ABACUS_API abacus_status abacus_own_count(const abacus_host *host, const abacus_facts *facts,
										  uint64_t first, uint64_t last, uint64_t *simplices,
										  uint64_t *ghosts, abacus_error *error);

#ifdef __cplusplus
}
#endif

#endif
