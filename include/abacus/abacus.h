/*
 * abacus.h: the one bridge between PostgreSQL (C) and the Abacus core (C++).
 *
 * The core knows nothing of PostgreSQL. What it needs from a database it asks
 * of an abacus_host: memory, pages found and stored by key, spool files, and
 * a word about interrupts. What it offers is a handful of plain handles:
 *
 *   abacus_stage   points in, vertex pages in insertion order out   (dissertation §4.12.2)
 *   abacus_build   staged points in, simplex pages out              (§4.12.3-5)
 *   abacus_load    vertices and simplices made elsewhere in, simplex pages out
 *   abacus_mesh    locate and walk over stored pages                (§4.11.3)
 *   abacus_places  locate many places at once
 *   abacus_scan, abacus_vertex_scan, abacus_check, abacus_draw      whole-mesh readers
 *
 * Errors travel by return value only. A host function that fails returns
 * ABACUS_HOST_FAILED and keeps its own error; the core unwinds and returns
 * ABACUS_HOST_ERROR, and the caller re-raises what the host kept. An error of
 * the core's own is returned as ABACUS_ERROR with an abacus_error filled in.
 * No exception and no longjmp ever crosses this header. After any failure a
 * handle may only be closed; closing calls nothing of the host but resize().
 *
 * Every handle is bound to one thread and to the host it was opened with,
 * which must stay at its address until the handle is closed.
 */
#ifndef ABACUS_ABACUS_H
#define ABACUS_ABACUS_H

#include <stddef.h>
#include <stdint.h>

#ifdef __cplusplus
extern "C" {
#endif

#define ABACUS_API __attribute__((visibility("default")))

/* Largest dimension a mesh can have. */
#define ABACUS_MAX_DIMENSION 3
/* Largest number of attributes of a vertex: their names share one header page. */
#define ABACUS_MAX_ATTRIBUTES 100
/* Bytes of an attribute name, with its terminating zero (as NAMEDATALEN). */
#define ABACUS_NAME_BYTES 64
/* Largest page the core hands to the host, bytes. */
#define ABACUS_PAGE_BYTES 7936

/* ---- Status and errors ------------------------------------------------- */

typedef enum abacus_status
{
	ABACUS_OK = 0,     /* done; results are filled in */
	ABACUS_END,        /* done; there is no (further) result */
	ABACUS_HOST_ERROR, /* a host function failed; the host holds the error */
	ABACUS_ERROR       /* the core failed; see abacus_error */
} abacus_status;

typedef enum abacus_error_kind
{
	ABACUS_ERROR_INTERNAL = 0,
	ABACUS_ERROR_CORRUPTED, /* stored bytes are not what the core wrote */
	ABACUS_ERROR_MEMORY,    /* resize() returned NULL */
	ABACUS_ERROR_ARGUMENT,  /* a value that the function does not take */
	ABACUS_ERROR_STATE,     /* not possible in the mesh's present state */
	ABACUS_ERROR_LIMIT      /* a limit of the format is exceeded */
} abacus_error_kind;

/* Zero-terminated texts in PostgreSQL's style; detail and hint may be empty. */
typedef struct abacus_error
{
	abacus_error_kind kind;
	char message[256];
	char detail[512];
	char hint[256];
} abacus_error;

/* ---- Keys and pages ---------------------------------------------------- */

/*
 * Key of a simplex and of the page that owns it: `code` is the greatest
 * locational code of the simplex's vertices, their places on a Hilbert curve
 * (31 bits an axis in 2D, 21 in 3D; §4.8), below 2^63; `part` continues it,
 * below 2^63, and counts only where more simplices than fit a page share one
 * code: elsewhere a page's and a link's is 0. Keys are ordered by code, then part.
 */
typedef struct abacus_key
{
	uint64_t code;
	uint64_t part;
} abacus_key;

/* What a page holds. Each kind has keys of its own. */
typedef enum abacus_page_kind
{
	/* Simplices: the interval of their keys from the page's key to that of the next. */
	ABACUS_SIMPLEX_PAGES,
	/* Points that wait to be inserted, in insertion order: {sequence number of the first, 0}. */
	ABACUS_STAGED_PAGES,
	/* Points equal to a vertex: {code, serial number}, an interval as of simplices. */
	ABACUS_REPEATED_PAGES
} abacus_page_kind;

/* One stored page. */
typedef struct abacus_page
{
	abacus_key key;             /* lower end of the page's interval */
	const unsigned char *bytes; /* aligned to 8 */
	size_t size;                /* bytes, at most ABACUS_PAGE_BYTES */
	uint64_t location;          /* the host's own mark of the stored page; 0 = not stored yet */
} abacus_page;

/* ---- Counters (chapter 5 of the dissertation) --------------------------- */

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
} abacus_counters;

/* ---- Progress ------------------------------------------------------------ */

typedef enum abacus_phase
{
	ABACUS_PHASE_READING = 1,  /* the source query */
	ABACUS_PHASE_SORTING,      /* into insertion order */
	ABACUS_PHASE_STAGING,      /* writing vertex pages */
	ABACUS_PHASE_INSERTING,    /* triangulating */
	ABACUS_PHASE_FLUSHING,     /* writing what the cache still holds */
	ABACUS_PHASE_CHECKING,
	ABACUS_PHASE_DELETING,     /* points out of the triangulation */
	ABACUS_PHASE_LOCATING      /* places in the triangulation */
} abacus_phase;

typedef struct abacus_progress
{
	abacus_phase phase;
	uint64_t done;          /* points (checking: pages) done in this phase */
	uint64_t total;         /* 0 = not known */
	uint64_t pages_read;
	uint64_t pages_written;
} abacus_progress;

/* ---- The host: what a database gives the core ---------------------------- */

typedef enum abacus_host_status
{
	ABACUS_HOST_OK = 0,
	ABACUS_HOST_NONE,   /* no such page; end of spool */
	ABACUS_HOST_FAILED  /* the host keeps the error */
} abacus_host_status;

/*
 * Every function gets `context` first. None may longjmp or throw. `bytes`
 * that a function hands out stay valid until the next call of a host function
 * other than resize().
 */
typedef struct abacus_host
{
	void *context;

	/* Like realloc(); size 0 frees and returns NULL; NULL also when out of memory. */
	void *(*resize)(void *context, void *block, size_t size);

	/* The core reads *interrupted often and calls poll() when it is not 0. */
	const volatile int *interrupted;
	abacus_host_status (*poll)(void *context);

	/* Called at most a few hundred times a second, and at each change of phase. */
	abacus_host_status (*progress)(void *context, const abacus_progress *progress);

	/*
	 * Pages of a kind. find: the one with the greatest key <= `key`. next: the
	 * one with the least key > `key` (the first when `key` is NULL). The header
	 * row is never returned. fetch: the one at page->location, which find or
	 * next gave, with its bytes at page->bytes; page->size of them will be read.
	 * If it has been moved since, ABACUS_HOST_NONE, or the one that is there now:
	 * its key tells. put: stores page->bytes under page->key, replacing the
	 * version at page->location unless that is 0, and sets page->location.
	 * erase: removes the version at page->location.
	 */
	abacus_host_status (*find)(void *context, abacus_page_kind kind, abacus_key key,
							   abacus_page *page);
	abacus_host_status (*fetch)(void *context, abacus_page_kind kind, abacus_page *page);
	abacus_host_status (*next)(void *context, abacus_page_kind kind, const abacus_key *key,
							   abacus_page *page);
	abacus_host_status (*put)(void *context, abacus_page_kind kind, abacus_page *page);
	abacus_host_status (*erase)(void *context, abacus_page_kind kind, const abacus_page *page);

	/*
	 * Spools: temporary files, written from start to end, then read from
	 * start to end. `size` bytes are written or read whole; reading at the
	 * end gives ABACUS_HOST_NONE. Open spools go away with the transaction.
	 */
	abacus_host_status (*spool_create)(void *context, void **spool);
	abacus_host_status (*spool_write)(void *context, void *spool, const void *bytes, size_t size);
	abacus_host_status (*spool_rewind)(void *context, void *spool);
	abacus_host_status (*spool_read)(void *context, void *spool, void *bytes, size_t size);
	abacus_host_status (*spool_close)(void *context, void *spool);
} abacus_host;

/* ---- Header of a mesh ----------------------------------------------------- */

typedef struct abacus_header
{
	uint32_t dimension;    /* 2 or 3 */
	uint32_t attributes;   /* number of attributes, 0 to ABACUS_MAX_ATTRIBUTES */
	uint32_t has_domain;   /* 0 until given or taken from the first points */
	double lower[ABACUS_MAX_DIMENSION]; /* domain; used for clustering only */
	double upper[ABACUS_MAX_DIMENSION];
	uint64_t outside;      /* points that have come from outside the domain since it was set */
	uint64_t stamp;        /* never repeats; set by the host at each change */
	uint64_t staged;       /* sequence number of the next staged point */
	uint64_t inserted;     /* ... of the first that waits; those before it are in the mesh */
	uint64_t vertices;     /* of the mesh; 0 while the points span no simplex: then all wait */
	uint64_t duplicates;   /* further points of the mesh, each equal to a vertex */
	uint64_t serials;      /* serial number of the next such point */
	uint64_t simplices;
	uint64_t ghosts;       /* hull facets; facets of the boundary if not_delaunay */
	uint32_t not_delaunay; /* 1: loaded from elsewhere (abacus_load_open), and not the Delaunay
							  triangulation of its vertices: it is read, never changed. Its
							  vertices are listed in staged pages; staged = inserted = vertices */
	abacus_counters counters; /* summed over all builds; peak_bytes: the largest */
	char names[ABACUS_MAX_ATTRIBUTES][ABACUS_NAME_BYTES];
} abacus_header;

/* Bytes of the header row; `bytes` has room for ABACUS_PAGE_BYTES. Returns the size. */
ABACUS_API size_t abacus_header_encode(const abacus_header *header, unsigned char *bytes);
/*
 * Checks and reads a header row; ABACUS_ERROR (corrupted) if it is none, (state) if it is one
 * of another format.
 */
ABACUS_API abacus_status abacus_header_decode(const unsigned char *bytes, size_t size,
											  abacus_header *header, abacus_error *error);

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
/* No more points come: a header without a domain gets theirs. */
ABACUS_API abacus_status abacus_stage_end(abacus_stage *stage, abacus_header *header,
										  abacus_error *error);
/* Ends, orders the points, writes the vertex pages, brings the header up to date. */
ABACUS_API abacus_status abacus_stage_finish(abacus_stage *stage, abacus_header *header,
											 abacus_error *error);
ABACUS_API void abacus_stage_close(abacus_stage *stage);

/* ---- Building --------------------------------------------------------------- */

typedef struct abacus_build abacus_build;

/* Opens a mesh for inserting, with a computational cache of `cache_bytes`. */
ABACUS_API abacus_status abacus_build_open(const abacus_host *host, const abacus_header *header,
										   size_t cache_bytes, abacus_build **build,
										   abacus_error *error);
/*
 * The changes below write every changed page and bring the header up to date.
 * One may follow another as long as nobody else changes the mesh or moves its
 * pages.
 *
 * run: inserts staged points that wait, at most `limit` of them (0 = all), and
 * erases their pages. While the points span no simplex they go on waiting.
 */
ABACUS_API abacus_status abacus_build_run(abacus_build *build, uint64_t limit,
										  abacus_header *header, abacus_error *error);
/*
 * insert: inserts what waits, then the points of a stage that has ended, without
 * vertex pages between; they are staged after all if they span no simplex.
 */
ABACUS_API abacus_status abacus_build_insert(abacus_build *build, abacus_stage *stage,
											 abacus_header *header, abacus_error *error);
/*
 * delete: inserts what waits, then takes away a point for each point of a stage
 * that has ended: one with the same coordinates, and of several the one with the
 * same id, or else the first; `by_id`: only one with the same id. *deleted says
 * how many there were. What is left is the triangulation of the other points; if
 * they span no simplex they wait again.
 */
ABACUS_API abacus_status abacus_build_delete(abacus_build *build, abacus_stage *stage, int by_id,
											 abacus_header *header, uint64_t *deleted,
											 abacus_error *error);
/* clear: takes away all points, those that wait too, at the cost of erasing their pages. */
ABACUS_API abacus_status abacus_build_clear(abacus_build *build, abacus_header *header,
											uint64_t *deleted, abacus_error *error);
/*
 * rekey: gives a mesh many of whose points came from outside its domain one around all of them,
 * and all its pages other keys, with `memory` bytes for sorting; *done is 0 if it had no need
 * to. The simplices are the same. The insertion of many points does so by itself.
 */
ABACUS_API abacus_status abacus_build_rekey(abacus_build *build, size_t memory,
											abacus_header *header, int *done,
											abacus_error *error);
ABACUS_API void abacus_build_close(abacus_build *build);

/* ---- Loading ---------------------------------------------------------------- */

typedef struct abacus_load abacus_load;

/*
 * Opens the loading of a triangulation made elsewhere into a mesh without points.
 * `memory` bounds what it uses, in bytes (maintenance_work_mem); beyond it everything
 * goes to spools. With `reorient` simplices of negative orientation are turned; without,
 * they are refused.
 */
ABACUS_API abacus_status abacus_load_open(const abacus_host *host, const abacus_header *header,
										  size_t memory, int reorient, abacus_load **load,
										  abacus_error *error);
/* Adds vertices, as abacus_stage_add does points; each id once. */
ABACUS_API abacus_status abacus_load_vertices(abacus_load *load, const uint64_t *points,
											  size_t count, abacus_error *error);
/* After all vertices: adds simplices, dimension + 1 ids of vertices each. */
ABACUS_API abacus_status abacus_load_simplices(abacus_load *load, const int64_t *ids,
											   size_t count, abacus_error *error);
/*
 * Checks that the simplices form a complex, exactly, writes the pages and brings the
 * header up to date. ABACUS_ERROR (argument) names the first fault found: an unknown,
 * repeated or unused vertex, a flat simplex, a facet used too often, an overlap.
 */
ABACUS_API abacus_status abacus_load_finish(abacus_load *load, abacus_header *header,
											abacus_error *error);
ABACUS_API void abacus_load_close(abacus_load *load);

/* ---- Reading ------------------------------------------------------------------ */

/*
 * A simplex with its corners a, b, c(, d) in positive orientation (§4.3.1):
 * det(b - a, c - a) > 0, counterclockwise; det(b - a, c - a, d - a) > 0, the
 * right hand around the first three with its thumb to the fourth (Figure 4.4).
 * dimension + 1 of them are set.
 */
typedef struct abacus_simplex
{
	uint64_t code;   /* locational code of the simplex's key */
	int32_t ghost;   /* 1: hull facet; the last corner is the point at infinity and not set */
	int64_t id[ABACUS_MAX_DIMENSION + 1];
	double corner[ABACUS_MAX_DIMENSION + 1][ABACUS_MAX_DIMENSION];
} abacus_simplex;

typedef struct abacus_mesh abacus_mesh;

ABACUS_API abacus_status abacus_mesh_open(const abacus_host *host, const abacus_header *header,
										  size_t cache_bytes, abacus_mesh **mesh,
										  abacus_error *error);
ABACUS_API void abacus_mesh_close(abacus_mesh *mesh);
/*
 * The simplex that contains the point (`dimension` finite doubles); of several
 * (the point lies on a facet) the one with the least code, then least ids, so
 * that the answer depends on the mesh alone. ABACUS_END outside the hull.
 */
ABACUS_API abacus_status abacus_mesh_locate(abacus_mesh *mesh, const double *point,
											abacus_simplex *simplex, abacus_error *error);
/*
 * The neighbour of the simplex with this code and these corner ids across its
 * facet `facet` (the one opposite corner `facet`, 0 to dimension). ABACUS_END at
 * the hull; ABACUS_ERROR (argument) if the mesh has no such simplex.
 */
ABACUS_API abacus_status abacus_mesh_walk(abacus_mesh *mesh, uint64_t code, const int64_t *ids,
										  int facet, abacus_simplex *simplex, abacus_error *error);
ABACUS_API void abacus_mesh_counters(const abacus_mesh *mesh, abacus_counters *counters);

/*
 * Many places at once: sorted along the curve within `memory` bytes, beyond it in
 * spools, then located page by page.
 */
typedef struct abacus_places abacus_places;
ABACUS_API abacus_status abacus_places_open(const abacus_host *host, const abacus_header *header,
											size_t memory, size_t cache_bytes,
											abacus_places **places, abacus_error *error);
/* Adds `count` places: each 1 + dimension words of 8 bytes, as in abacus_stage_add. */
ABACUS_API abacus_status abacus_places_add(abacus_places *places, const uint64_t *records,
										   size_t count, abacus_error *error);
/*
 * Gets the id of a place and the simplex that contains it as abacus_mesh_locate finds it,
 * NULL outside the hull; valid during the call. May fail as a host function may.
 */
typedef abacus_host_status (*abacus_place_report)(void *context, int64_t id,
												  const abacus_simplex *simplex);
/* No more places come: reports each of them, in the order of the curve. Once. */
ABACUS_API abacus_status abacus_places_locate(abacus_places *places, abacus_place_report report,
											  void *context, abacus_error *error);
ABACUS_API void abacus_places_close(abacus_places *places);

/* All simplices, page by page in key order; with `ghosts` the hull facets too. */
typedef struct abacus_scan abacus_scan;
ABACUS_API abacus_status abacus_scan_open(const abacus_host *host, const abacus_header *header,
										  int ghosts, abacus_scan **scan, abacus_error *error);
ABACUS_API abacus_status abacus_scan_next(abacus_scan *scan, abacus_simplex *simplex,
										  abacus_error *error);
ABACUS_API void abacus_scan_close(abacus_scan *scan);

/* A point of a mesh, or one that waits to be. */
typedef struct abacus_vertex
{
	int64_t id;
	double point[ABACUS_MAX_DIMENSION];
	const double *attributes; /* valid until the next call */
	int32_t waits;           /* 1: it is not inserted yet */
	uint64_t sequence;       /* of a point that waits: its place in the insertion order */
	int64_t vertex;          /* of one that does not: id of the vertex that stands for it,
								its own unless an equal point came before it */
} abacus_vertex;

/*
 * All points: the vertices, page by page along the curve; the points equal to a
 * vertex; those that wait, in insertion order.
 */
typedef struct abacus_vertex_scan abacus_vertex_scan;
ABACUS_API abacus_status abacus_vertex_scan_open(const abacus_host *host,
												 const abacus_header *header, size_t cache_bytes,
												 abacus_vertex_scan **scan, abacus_error *error);
ABACUS_API abacus_status abacus_vertex_scan_next(abacus_vertex_scan *scan, abacus_vertex *vertex,
												 abacus_error *error);
ABACUS_API void abacus_vertex_scan_close(abacus_vertex_scan *scan);

/* ---- Goose: an R-tree instead of links (chapter 2) ------------------------------------- */

/*
 * A simplex as a row of its own, with its box: what of the domain holds every point that can be
 * in conflict with it. A box is in the R-tree's unit, coordinates times abacus_goose_figures.unit.
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

	/* Rows whose boxes contain the point, in any order; they stay valid until the next search.
	   Here and below, *boxes grows by the number of boxes that were looked at. */
	abacus_host_status (*search)(void *context, const double *point,
								 const abacus_boxed_simplex **found, size_t *count,
								 uint64_t *boxes);
	/* Takes a row that was found out of the tree, which is searched for its box; NONE if it is
	   not there. */
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
	uint64_t search_boxes;  /* boxes that searches for points looked at */
	uint64_t unlink_boxes;  /* boxes that searches for rows to be removed looked at */
	uint64_t search_ns;
	uint64_t test_ns;       /* in-sphere tests */
	uint64_t unlink_ns;
	uint64_t erase_ns;
	uint64_t insert_ns;
	uint64_t total_ns;      /* of all insertions; what is missing from the sum is other work */
} abacus_goose_figures;

/*
 * Inserts the points of a stage that has ended, in its order, into an R-tree without rows. At the
 * end it has a row for each simplex and each ghost; none if the points span no simplex.
 */
ABACUS_API abacus_status abacus_goose_run(const abacus_host *host, const abacus_rtree *rtree,
										  abacus_stage *stage, const abacus_header *header,
										  abacus_goose_figures *figures, abacus_error *error);

/* ---- Earthquake data sets ----------------------------------------------------------- */

/* A corner of the octree (dissertation §5.1.2), and the ground there. */
typedef struct abacus_quake_point
{
	int64_t id;          /* 1, 2, ... */
	double point[3];     /* metres; z is height, 0 at the surface */
	double vs, vp;       /* velocity of shear and of pressure waves, metres a second */
	double density;      /* kilograms a cubic metre */
} abacus_quake_point;

/*
 * Points for waves of `frequency` Hz, resolved by `points_per_wavelength`, one
 * at a time in Z-order. ABACUS_ERROR (argument) if they are not positive and
 * finite, or too high for the depth of the octree. `host` gives memory, half a
 * megabyte, and interrupts only.
 */
typedef struct abacus_quake abacus_quake;
ABACUS_API abacus_status abacus_quake_open(const abacus_host *host, double frequency,
										   double points_per_wavelength, abacus_quake **quake,
										   abacus_error *error);
ABACUS_API abacus_status abacus_quake_next(abacus_quake *quake, abacus_quake_point *point,
										   abacus_error *error);
ABACUS_API void abacus_quake_close(abacus_quake *quake);

/* ---- Checking -------------------------------------------------------------------- */

typedef struct abacus_fault
{
	abacus_key key;       /* page where the fault was seen; vertex page: code = first sequence number */
	const char *kind;     /* a short fixed word, e.g. "orientation" */
	char message[256];
} abacus_fault;

/* Verifies the mesh exactly, once, when opened; then hands out the faults (at most `limit`). */
typedef struct abacus_check abacus_check;
ABACUS_API abacus_status abacus_check_open(const abacus_host *host, const abacus_header *header,
										   size_t cache_bytes, size_t limit, abacus_check **check,
										   abacus_error *error);
ABACUS_API abacus_status abacus_check_next(abacus_check *check, abacus_fault *fault);
ABACUS_API void abacus_check_close(abacus_check *check);

/* ---- Drawing ---------------------------------------------------------------------- */

typedef struct abacus_drawing
{
	/* Window in mesh coordinates; empty (lower >= upper on an axis) = all there is. In
	   dimension 3 a box: the picture shows the rectangle that just holds the part of the
	   plane within it. */
	double lower[ABACUS_MAX_DIMENSION], upper[ABACUS_MAX_DIMENSION];
	int32_t width, height;     /* pixels, 1 to 16384; height 0 = from the window's shape */
	int32_t attribute;         /* vertex attribute that gives colour and relief; -1 = none */
	int32_t edges;             /* 1: draw the edges of the triangles, or of the section */
	double exaggeration;       /* values are multiplied by this for the hill shading; 0 = no shading */
	double max_edge;           /* leave out simplices with a longer edge; 0 = none */
} abacus_drawing;

/*
 * Draws a mesh of dimension 2 as a PNG. *png comes from host->resize(), which also
 * frees it.
 */
ABACUS_API abacus_status abacus_draw(const abacus_host *host, const abacus_header *header,
									 const abacus_drawing *drawing, unsigned char **png,
									 size_t *size, abacus_error *error);

/*
 * A plane through a mesh of dimension 3. A picture of it has up upwards: z on planes
 * of 45 degrees or steeper, y on flatter ones, which are maps; x, or y where the plane
 * is perpendicular to x, grows to the right. So the sign of the normal does not matter.
 */
typedef struct abacus_section
{
	double through[3];   /* a point of the plane, finite */
	double normal[3];    /* finite, not zero, of any length */
	double exaggeration; /* lengths upwards are multiplied by this, finite, not 0; negative:
							the picture is upside down, for a z that is a depth */
} abacus_section;

/* Draws the section of a mesh of dimension 3 by a plane, as abacus_draw does. */
ABACUS_API abacus_status abacus_draw_section(const abacus_host *host, const abacus_header *header,
											 const abacus_section *section,
											 const abacus_drawing *drawing, unsigned char **png,
											 size_t *size, abacus_error *error);

#ifdef __cplusplus
}
#endif

#endif
