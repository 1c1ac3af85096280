/*
 * change.h: points and foreign triangulations into a mesh, and points out of
 * it.
 */
#ifndef ABACUS_ABACUS_CHANGE_H
#define ABACUS_ABACUS_CHANGE_H

#include "abacus/header.h"
#include "abacus/read.h"

#ifdef __cplusplus
extern "C" {
#endif

/* ---- Staging --------------------------------------------------------------- */

typedef struct abacus_stage abacus_stage;

/*
 * Opens a stage for points of the header's dimension and attributes. `memory`
 * bounds what it uses for sorting, in bytes (maintenance_work_mem); beyond it
 * points go to spools.
 */
ABACUS_API abacus_status abacus_stage_open(const abacus_host *host, const abacus_header *header,
										   size_t memory, abacus_stage **stage,
										   abacus_error *error);
/*
 * Adds `count` points: each (1 + dimension + attributes) words of 8 bytes: id
 * (int64_t), coordinates (double, finite), attributes (double; NaN = NULL).
 */
ABACUS_API abacus_status abacus_stage_add(abacus_stage *stage, const uint64_t *points,
										  size_t count, abacus_error *error);
/* No more points come. A header without a domain gets theirs. */
ABACUS_API abacus_status abacus_stage_end(abacus_stage *stage, abacus_header *header,
										  abacus_error *error);
/* Ends, orders the points, writes the vertex pages, brings the header up to date. */
ABACUS_API abacus_status abacus_stage_finish(abacus_stage *stage, abacus_header *header,
											 abacus_error *error);
ABACUS_API void abacus_stage_close(abacus_stage *stage);

/* ---- Building --------------------------------------------------------------- */

typedef struct abacus_build abacus_build;

/*
 * Opens a mesh for inserting, with a computational cache of `cache_bytes`. Its domain
 * is the one that the header has now, so for the first points call abacus_stage_end()
 * before.
 */
ABACUS_API abacus_status abacus_build_open(const abacus_host *host, const abacus_header *header,
										   size_t cache_bytes, abacus_build **build,
										   abacus_error *error);
/*
 * The changes below write every changed page and bring the header up to date.
 * One may follow another as long as nobody else changes the mesh or moves its
 * pages.
 *
 * run: inserts staged points that wait, at most `limit` of them (0 = all), and erases
 * their pages. While the points span no simplex they keep waiting.
 */
ABACUS_API abacus_status abacus_build_run(abacus_build *build, uint64_t limit,
										  abacus_header *header, abacus_error *error);
/* What becomes of a point that comes to a place where there are others. */
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
 * delete: inserts what waits, then takes away a point for each point of a stage that has
 * ended: one with the same coordinates, and of several the one with the same id, or else the
 * first. With `exactly`, only a point with the same id and attributes goes; 0 equals -0 then,
 * and a NaN equals any other NaN, and the stage must have the attributes of the mesh. *deleted
 * says how many points there were. What is left is the triangulation of the other points. If
 * they span no simplex they wait again.
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
 * hold: until settle the changes are one for labels of simplices and markers of facets: those of a
 * simplex or facet that was there before, and is there in the end, stay. Whatever comes between.
 */
ABACUS_API abacus_status abacus_build_hold(abacus_build *build, abacus_error *error);
ABACUS_API abacus_status abacus_build_settle(abacus_build *build, abacus_header *header,
											 abacus_error *error);

/*
 * update: inserts what waits, then gives a point for each point of a stage that has ended other
 * values of `count` attributes, whose numbers are `attributes`. It is one with the same coordinates,
 * and of several the one with the same id, or else the first. The stage has values of these
 * attributes only; of several for a point the last one counts. *updated says for how many there was
 * a point; *missing has id and place of the first for which there was none. No simplex changes. A
 * mesh whose attributes are apart is changed in the pages of these attributes alone, unless several
 * points are at a place, or wait. With `exactly` the stage has, behind these values, those of all
 * attributes as they were. A point of the mesh must have them, and where several are at a place the
 * id, too; each is taken once. The mesh needs simplices then: no point that waits is found.
 */
ABACUS_API abacus_status abacus_build_update(abacus_build *build, abacus_stage *stage,
											 const uint32_t *attributes, size_t count, int exactly,
											 abacus_header *header, uint64_t *updated,
											 abacus_named_place *missing, abacus_error *error);
/* An attribute that no point has had. */
#define ABACUS_NO_ATTRIBUTE UINT32_MAX
/*
 * change_attributes: gives all points other attributes, with `memory` bytes for sorting: the i-th
 * of `count` is the one that has the number source[i], or, if that is ABACUS_NO_ATTRIBUTE, one without a
 * value and without a name. If there are as many as before, they must be the same, in their order.
 * Simplices stay as they are. Attributes that are many come to be apart; with those there are this
 * makes a mesh of format 3 one of format 4. The build can only be closed then.
 */
ABACUS_API abacus_status abacus_build_change_attributes(abacus_build *build,
														const uint32_t *source, size_t count,
														size_t memory, abacus_header *header,
														abacus_error *error);
/* clear: takes away all points, waiting ones included, at the cost of erasing their pages. */
ABACUS_API abacus_status abacus_build_clear(abacus_build *build, abacus_header *header,
											uint64_t *deleted, abacus_error *error);
/*
 * rekey: gives a mesh whose domain does not fit many of its points another domain, and all its
 * pages other keys, with `memory` bytes for sorting. The simplices stay the same. *done is 0 if
 * there is no better domain; header->outside is then 0 if that took a look at all points. The
 * insertion of many points does this by itself.
 */
ABACUS_API abacus_status abacus_build_rekey(abacus_build *build, size_t memory,
											abacus_header *header, int *done,
											abacus_error *error);
/*
 * log: from now on the changes keep account of the simplices that they create and remove, within
 * `memory` bytes, beyond it in spools. Before the first change.
 */
ABACUS_API abacus_status abacus_build_log(abacus_build *build, size_t memory,
										  abacus_error *error);
/*
 * Gets a simplex that there was not before (created = 1), or that there is no longer (0).
 * May fail as a host function may.
 */
typedef abacus_host_status (*abacus_change_report)(void *context, int created,
												   const abacus_simplex *simplex);
/*
 * report: reports what the changes since abacus_build_log() have created and removed, all in all:
 * what has come and gone again is not reported. A simplex whose vertex has another id than before
 * counts as another one. Their codes are those of the domain that the mesh has now; in order of
 * these, then of the coordinates and ids of the corners. Once, after the last change.
 */
ABACUS_API abacus_status abacus_build_report(abacus_build *build, abacus_change_report report,
											 void *context, abacus_error *error);
ABACUS_API void abacus_build_close(abacus_build *build);

/* ---- Labels ------------------------------------------------------------------ */

typedef struct abacus_labelling abacus_labelling;

/*
 * Opens the labelling of simplices of a mesh, Delaunay or not. `header` names all labels; the first
 * `known` of them are not new. Each row has values of `count` labels, whose numbers are `labels`.
 * `memory` bounds what it uses for sorting, in bytes.
 */
ABACUS_API abacus_status abacus_labelling_open(const abacus_host *host,
											   const abacus_header *header, uint32_t known,
											   const uint32_t *labels, size_t count, size_t memory,
											   size_t cache_bytes, abacus_labelling **labelling,
											   abacus_error *error);
/*
 * Adds rows of 8-byte words: code and dimension + 1 ids of a simplex, then the values, NaN where
 * there is none. Of several rows for a simplex the last one counts.
 */
ABACUS_API abacus_status abacus_labelling_add(abacus_labelling *labelling, const uint64_t *rows,
											  size_t count, abacus_error *error);
/*
 * No more rows come: gives the simplices their labels and brings the header up to date. ABACUS_ERROR
 * (argument) if the mesh has no such simplex.
 */
ABACUS_API abacus_status abacus_labelling_end(abacus_labelling *labelling, abacus_header *header,
											  abacus_error *error);
ABACUS_API void abacus_labelling_close(abacus_labelling *labelling);

/* ---- Markers of facets ----------------------------------------------------------- */

typedef struct abacus_marking abacus_marking;

/* Opens the marking of facets of a mesh, Delaunay or not; `memory` as for labels. */
ABACUS_API abacus_status abacus_marking_open(const abacus_host *host, const abacus_header *header,
											 size_t memory, size_t cache_bytes,
											 abacus_marking **marking, abacus_error *error);
/*
 * Adds rows of 8-byte words: code and dimension + 1 ids of a simplex, the number of the corner
 * opposite the facet, and the marker, a double that is a 32-bit integer; NaN takes it away.
 */
ABACUS_API abacus_status abacus_marking_add(abacus_marking *marking, const uint64_t *rows,
											size_t count, abacus_error *error);
/*
 * No more rows come: marks the facets, on both of their sides, and brings the header up to date.
 * ABACUS_ERROR (argument) if the mesh has no such simplex.
 */
ABACUS_API abacus_status abacus_marking_end(abacus_marking *marking, abacus_header *header,
											abacus_error *error);
ABACUS_API void abacus_marking_close(abacus_marking *marking);

/* ---- Loading ---------------------------------------------------------------- */

typedef struct abacus_load abacus_load;

/*
 * Opens the loading of a triangulation made elsewhere into a mesh without points.
 * `memory` bounds what it uses, in bytes (maintenance_work_mem); beyond it everything
 * goes to spools. With `reorient` simplices of negative orientation are turned; without,
 * they are refused. With `split_nodes` vertices at one place are told apart by their ids; without,
 * they are refused. No attributes are apart then.
 */
ABACUS_API abacus_status abacus_load_open(const abacus_host *host, const abacus_header *header,
										  size_t memory, int reorient, int split_nodes,
										  abacus_load **load, abacus_error *error);
/* Adds vertices, as abacus_stage_add does points; each id once. */
ABACUS_API abacus_status abacus_load_vertices(abacus_load *load, const uint64_t *points,
											  size_t count, abacus_error *error);
/*
 * After all vertices: adds simplices. Each is dimension + 1 ids of vertices, followed by its labels,
 * which are doubles: as many as the header names, NaN where there is none.
 */
ABACUS_API abacus_status abacus_load_simplices(abacus_load *load, const uint64_t *simplices,
											   size_t count, abacus_error *error);
/*
 * After all simplices, if at all: adds markers of facets. Each is `dimension` ids of vertices, and a
 * double that is a 32-bit integer; NaN is none.
 */
ABACUS_API abacus_status abacus_load_facets(abacus_load *load, const uint64_t *facets, size_t count,
											abacus_error *error);
/*
 * No more simplices come. Checks exactly that they form a complex, and how this is related to
 * the Delaunay triangulation of its vertices. ABACUS_ERROR (argument) names what is wrong: an
 * unknown or repeated vertex, a flat simplex, a facet used too often, an overlap.
 */
ABACUS_API abacus_status abacus_load_check(abacus_load *load, abacus_delaunay *outcome,
										   abacus_error *error);
/* The error's detail in full: it lists up to a hundred faults. Valid as long as the load. */
ABACUS_API const char *abacus_load_detail(const abacus_load *load);
/* After the check: writes the pages and brings the header up to date. */
ABACUS_API abacus_status abacus_load_write(abacus_load *load, abacus_header *header,
										   abacus_error *error);
/* Or instead: adds the vertices of the simplices to a stage, to be triangulated anew. */
ABACUS_API abacus_status abacus_load_stage(abacus_load *load, abacus_stage *stage,
										   abacus_error *error);
ABACUS_API void abacus_load_close(abacus_load *load);

#ifdef __cplusplus
}
#endif

#endif
