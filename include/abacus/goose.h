/*
 * goose.h: an R-tree instead of links (chapter 2 of the dissertation).
 */
#ifndef ABACUS_ABACUS_GOOSE_H
#define ABACUS_ABACUS_GOOSE_H

#include "abacus/build.h"

#ifdef __cplusplus
extern "C" {
#endif

/*
 * A simplex as a separate row, with its box: the part of the domain that contains every point in
 * conflict with it. A box is in the R-tree's unit, coordinates times abacus_goose_figures.unit.
 */
typedef struct abacus_boxed_simplex
{
	abacus_simplex simplex; /* code: 0 */
	double lower[ABACUS_MAX_DIMENSION], upper[ABACUS_MAX_DIMENSION];
	uint64_t location;      /* the host's own mark of the row */
} abacus_boxed_simplex;

/* Rows under an R-tree, as a database has them. Functions are like those of abacus_host. */
typedef struct abacus_rtree
{
	void *context;

	/*
	 * Rows whose boxes contain the point, in any order; they stay valid until the next search. Here
	 * and below, *boxes grows by the number of boxes examined.
	 */
	abacus_host_status (*search)(void *context, const double *point,
								 const abacus_boxed_simplex **found, size_t *count,
								 uint64_t *boxes);
	/*
	 * Removes a row that was found from the tree, which is searched for its box; NONE if it is not
	 * there.
	 */
	abacus_host_status (*unlink)(void *context, const abacus_boxed_simplex *row, uint64_t *boxes);
	/* Then removes the row. */
	abacus_host_status (*erase)(void *context, const abacus_boxed_simplex *row);
	abacus_host_status (*insert)(void *context, const abacus_boxed_simplex *row);
} abacus_rtree;

/* Figure 2.9 and section 2.3.2 of the dissertation. */
typedef struct abacus_goose_figures
{
	double unit;            /* of boxes: a power of two, 1 unless the domain is very small or large */
	uint64_t vertices;
	uint64_t duplicates;
	uint64_t simplices;
	uint64_t ghosts;        /* facets of the hull: rows while the triangulation grows */
	uint64_t created;       /* rows inserted */
	uint64_t deleted;       /* rows removed: true hits of the searches */
	uint64_t searches;
	uint64_t found;         /* rows that searches for points found */
	uint64_t search_boxes;  /* boxes examined by searches for points */
	uint64_t unlink_boxes;  /* boxes examined by searches for rows to be removed */
	uint64_t search_ns;
	uint64_t test_ns;       /* in-sphere tests */
	uint64_t unlink_ns;
	uint64_t erase_ns;
	uint64_t insert_ns;
	uint64_t total_ns;      /* of all insertions; the part not in the times above is other work */
} abacus_goose_figures;

/*
 * Inserts the points of a stage that has ended, in its order, into an R-tree without rows. At the
 * end the tree has a row for each simplex and each ghost; none if the points span no simplex.
 */
ABACUS_API abacus_status abacus_goose_run(const abacus_host *host, const abacus_rtree *rtree,
										  abacus_stage *stage, const abacus_facts *facts,
										  abacus_goose_figures *figures, abacus_error *error);

#ifdef __cplusplus
}
#endif

#endif
