/*
 * page_kinds.h: the kinds of pages that a mesh and an octree have.
 */
#ifndef ABACUS_ABACUS_PAGE_KINDS_H
#define ABACUS_ABACUS_PAGE_KINDS_H

#ifdef __cplusplus
extern "C" {
#endif

enum
{
	/* Simplices: the interval of their keys from the page's key to that of the next. */
	ABACUS_SIMPLEX_PAGES = 0,
	/* Points that wait to be inserted, in insertion order: {sequence number of the first, 0}. */
	ABACUS_STAGED_PAGES,
	/* Points equal to a vertex: {code, serial number}, an interval as of simplices. */
	ABACUS_REPEATED_PAGES,
	/*
	 * Attributes of vertices, if they are apart, labels of simplices, markers of facets: intervals of
	 * keys of their own, group by group.
	 */
	ABACUS_ATTRIBUTE_PAGES,
	/*
	 * Values of vertices at a step of a solution: rows of an id and so many doubles. These can only be
	 * found, by {id as unsigned, 0}: a page has the row of this id first, and rows stored beside it.
	 * Without the row there is none, or one that begins with another.
	 */
	ABACUS_STEP_PAGES
};

/* Leaves of an octree: in the place of the simplices of a mesh, which an octree does not have. */
#define ABACUS_OCTANT_PAGES ABACUS_SIMPLEX_PAGES

#ifdef __cplusplus
}
#endif

#endif
