/*
 * build.h: points into a mesh, and out of it: staging, and changes of what is stored.
 */
#ifndef ABACUS_ABACUS_BUILD_H
#define ABACUS_ABACUS_BUILD_H

#include "abacus/mesh_header.h"
#include "abacus/simplex.h"

#ifdef __cplusplus
extern "C" {
#endif

/* ---- Staging --------------------------------------------------------------- */

typedef struct abacus_stage abacus_stage;

/*
 * Opens a stage for points of the dimension and the attributes in `facts`. `memory`
 * bounds what it uses for sorting, in bytes (maintenance_work_mem); beyond it
 * points go to spools.
 */
ABACUS_API abacus_status abacus_stage_open(const abacus_host *host, const abacus_facts *facts,
										   size_t memory, abacus_stage **stage,
										   abacus_error *error);
/*
 * Adds `count` points: each (1 + dimension + attributes) words of 8 bytes: id
 * (int64_t), coordinates (double, finite), attributes (double; NaN = NULL).
 */
ABACUS_API abacus_status abacus_stage_add(abacus_stage *stage, const uint64_t *points,
										  size_t count, abacus_error *error);
/* No more points come. A mesh without a domain gets theirs. */
ABACUS_API abacus_status abacus_stage_end(abacus_stage *stage, abacus_facts *facts,
										  abacus_error *error);
/* Ends, orders the points, writes the vertex pages, brings the facts up to date. */
ABACUS_API abacus_status abacus_stage_finish(abacus_stage *stage, abacus_facts *facts,
											 abacus_error *error);
ABACUS_API void abacus_stage_close(abacus_stage *stage);

/* ---- Building --------------------------------------------------------------- */

typedef struct abacus_build abacus_build;

/*
 * Opens a mesh for inserting, with a computational cache of `cache_bytes`. Its domain
 * is the one that `facts` has now, so for the first points call abacus_stage_end()
 * before.
 */
ABACUS_API abacus_status abacus_build_open(const abacus_host *host, const abacus_facts *facts,
										   size_t cache_bytes, abacus_build **build,
										   abacus_error *error);
/*
 * The changes below write every changed page and bring the header up to date.
 * Several changes may follow one another as long as nobody else changes the mesh or moves its
 * pages.
 *
 * run: inserts staged points that wait, at most `limit` of them (0 = all), and erases
 * their pages. While the points span no simplex they keep waiting.
 */
ABACUS_API abacus_status abacus_build_run(abacus_build *build, uint64_t limit,
										  abacus_header *header, abacus_error *error);
/* What happens to a point at a place where there are others. */
typedef enum abacus_on_duplicate
{
	ABACUS_KEEP = 0,  /* it stays beside them */
	ABACUS_REPLACE,   /* it takes the place of all of them */
	ABACUS_REFUSE     /* ABACUS_ERROR (duplicate) */
} abacus_on_duplicate;

/*
 * insert: inserts what waits, then the points of a stage that has ended, without vertex
 * pages between. If the points span no simplex, they are staged.
 */
ABACUS_API abacus_status abacus_build_insert(abacus_build *build, abacus_stage *stage,
											 abacus_on_duplicate on_duplicate,
											 abacus_header *header, abacus_error *error);
/*
 * delete: inserts what waits, then removes a point for each point of a stage that has ended: one
 * with the same coordinates; of several, the one with the same id, or else the first. With
 * `exactly`, only a point with the same id and attributes is removed; 0 then equals -0, a NaN
 * equals any other NaN, and the stage must have the attributes of the mesh. *deleted says how many
 * points there were. The result is the triangulation of the other points. If they span no simplex
 * they wait again.
 */
ABACUS_API abacus_status abacus_build_delete(abacus_build *build, abacus_stage *stage, int exactly,
											 abacus_header *header, uint64_t *deleted,
											 abacus_error *error);
/* A point by id and place. */
typedef struct abacus_named_place
{
	int64_t id;
	double point[ABACUS_MAX_DIMENSION];
} abacus_named_place;

/*
 * hold: until settle all changes count as one for labels of simplices and markers of facets: a
 * simplex or facet that was there before and is there in the end keeps its own, whatever happens in
 * between.
 */
ABACUS_API abacus_status abacus_build_hold(abacus_build *build, abacus_error *error);
ABACUS_API abacus_status abacus_build_settle(abacus_build *build, abacus_header *header,
											 abacus_error *error);
/* Simplices with labels that changes have removed so far, whether or not others have inherited them. */
ABACUS_API uint64_t abacus_build_lost_labels(const abacus_build *build);

/*
 * update: inserts what waits, then, for each point of a stage that has ended, gives a point of the
 * mesh new values of `count` attributes, whose numbers are `attributes`: one with the same
 * coordinates; of several, the one with the same id, or else the first. The stage has values of
 * these attributes only; if several are for one point, the last one counts. *updated says how many
 * had a point in the mesh; *missing has id and place of the first that had none. No simplex
 * changes. In a mesh whose attributes are apart, only the pages of these attributes change, unless
 * several points are at a place, or wait. With `exactly` the stage has, behind the new values, the
 * old values of all attributes. A point of the mesh must have them, and where several are at a
 * place also the id; each is taken once. The mesh then needs simplices: points that wait are not
 * found.
 */
ABACUS_API abacus_status abacus_build_update(abacus_build *build, abacus_stage *stage,
											 const uint32_t *attributes, size_t count, int exactly,
											 abacus_header *header, uint64_t *updated,
											 abacus_named_place *missing, abacus_error *error);
/* A new attribute, which no point had before. */
#define ABACUS_NO_ATTRIBUTE UINT32_MAX
/*
 * change_attributes: gives all points other attributes, with `memory` bytes for sorting: the i-th
 * of `count` is the former attribute source[i] or, if that is ABACUS_NO_ATTRIBUTE, one without a
 * value and without a name. If there are as many as before, they must be the same, in the same
 * order. Simplices stay as they are. Many attributes are put apart; applied to the existing ones,
 * this turns a mesh of format 3 into one of format 4. After this the build can only be closed.
 */
ABACUS_API abacus_status abacus_build_change_attributes(abacus_build *build,
														const uint32_t *source, size_t count,
														size_t memory, abacus_header *header,
														abacus_error *error);
/* clear: removes all points, waiting ones included, at the cost of erasing their pages. */
ABACUS_API abacus_status abacus_build_clear(abacus_build *build, abacus_header *header,
											uint64_t *deleted, abacus_error *error);
/*
 * rekey: gives a mesh whose domain does not fit many of its points another domain, and all its
 * pages other keys, with `memory` bytes for sorting. The simplices stay the same. *done is 0 if
 * there is no better domain; the census counts no points as outside then, if that took a look at all
 * points. The insertion of many points does this by itself.
 */
ABACUS_API abacus_status abacus_build_rekey(abacus_build *build, size_t memory,
											abacus_header *header, int *done,
											abacus_error *error);
/*
 * log: from now on changes log the simplices that they create and remove, within `memory` bytes,
 * beyond it in spools. To be called before the first change.
 */
ABACUS_API abacus_status abacus_build_log(abacus_build *build, size_t memory,
										  abacus_error *error);
/*
 * Gets a simplex that is new (created = 1), or that no longer exists (0). May fail as a host
 * function may.
 */
typedef abacus_host_status (*abacus_change_report)(void *context, int created,
												   const abacus_simplex *simplex);
/*
 * report: reports the simplices that the changes since abacus_build_log() have created and removed
 * in total: a simplex that was created and removed again is not reported. A simplex whose vertex
 * has another id than before counts as a different one. Codes are those of the mesh's present
 * domain; the order is by code, then by the coordinates and ids of the corners. Once, after the
 * last change.
 */
ABACUS_API abacus_status abacus_build_report(abacus_build *build, abacus_change_report report,
											 void *context, abacus_error *error);
ABACUS_API void abacus_build_close(abacus_build *build);

#ifdef __cplusplus
}
#endif

#endif
