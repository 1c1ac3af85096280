/*
 * host_functions.h: what a database gives the core: memory, pages found and stored by key, spool
 * files, and news of interrupts. It also defines how both report failure and progress.
 */
#ifndef ABACUS_ABACUS_HOST_FUNCTIONS_H
#define ABACUS_ABACUS_HOST_FUNCTIONS_H

#include <stddef.h>
#include <stdint.h>

#ifdef __cplusplus
extern "C" {
#endif

#define ABACUS_API __attribute__((visibility("default")))

/* Largest dimension a mesh can have. */
#define ABACUS_MAX_DIMENSION 3
/* Largest number of attributes of a vertex. */
#define ABACUS_MAX_ATTRIBUTES 1000
/* ... of those in a page with simplices or leaves: the columns of one page. */
#define ABACUS_MAX_PAGE_ATTRIBUTES 100
/* Bytes of an attribute name, with its terminating zero (as NAMEDATALEN). */
#define ABACUS_NAME_BYTES 64
/* Bytes of a full page. */
#define ABACUS_PAGE_BYTES 7936
/* Largest page that the core gives to the host: of one point with this many attributes. */
#define ABACUS_MAX_PAGE_BYTES 8064

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
	ABACUS_ERROR_LIMIT,     /* a limit of the format is exceeded */
	ABACUS_ERROR_DUPLICATE, /* a point equals one that is there */
	ABACUS_ERROR_UNSUPPORTED, /* what the core does not do yet */
	ABACUS_ERROR_CROSSING,  /* lines cross */
	ABACUS_ERROR_RANGE      /* a number is beyond what a format holds */
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
 * below 2^63, and is used only where more simplices than fit a page share one code: elsewhere the
 * part of a page or a link is 0. Keys are ordered by code, then part.
 */
typedef struct abacus_key
{
	uint64_t code;
	uint64_t part;
} abacus_key;

/*
 * The kind of a page's contents, as a number. A data type names its kinds where it describes its
 * pages (page_kinds.h: those of meshes); each is registered with the host before it is used. Each
 * kind has its own keys.
 */
typedef uint32_t abacus_page_kind;

#define ABACUS_MAX_PAGE_KINDS 8

/* One stored page. */
typedef struct abacus_page
{
	abacus_key key;             /* lower end of the page's interval */
	const unsigned char *bytes; /* aligned to 8 */
	size_t size;                /* bytes, at most ABACUS_MAX_PAGE_BYTES */
	uint64_t location;          /* the host's own mark of the stored page; 0 = not stored yet */
} abacus_page;

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
	ABACUS_PHASE_LOCATING,     /* places in the triangulation */
	ABACUS_PHASE_SCANNING      /* pages of the mesh that is read */
} abacus_phase;

typedef struct abacus_progress
{
	abacus_phase phase;
	uint64_t done;          /* points (checking: pages; scanning: simplices) done in this phase */
	uint64_t total;         /* 0 = not known */
	uint64_t pages_read;
	uint64_t pages_written;
	uint32_t threads;       /* at work beside the session's; 0 = only the session's works */
} abacus_progress;

/* ---- The host: what a database gives the core ---------------------------- */

typedef enum abacus_host_status
{
	ABACUS_HOST_OK = 0,
	ABACUS_HOST_NONE,   /* no such page; end of spool */
	ABACUS_HOST_FAILED  /* the host keeps the error */
} abacus_host_status;

/*
 * Four parts: memory, control, pages, spools. Every function gets `context` first. None may longjmp
 * or throw. `bytes` that a function returns stay valid until the next call of a host function other
 * than resize().
 *
 * Threads: every function is for the session's thread alone. Another thread may only
 * read *interrupted, and use memory that the session's thread has reserved for it
 * (src/host/thread_memory.hpp).
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
	 * If it has been moved since, ABACUS_HOST_NONE, or the page that is there now, which its key
	 * shows. put: stores page->bytes under page->key, replacing the version at page->location
	 * unless that is 0, and sets page->location. erase: removes the version at page->location.
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

	/*
	 * Threads that the core may compute with; 0 and 1 mean the session's alone. With tiny_intervals
	 * they share even little work, in many pieces cut at random: for tests.
	 */
	unsigned threads;
	int tiny_intervals;
	/*
	 * Bytes that threads may have in total; 0 = no limit. For tests, to simulate running out of
	 * memory.
	 */
	size_t most_thread_bytes;

	/*
	 * At least `bytes` are about to be written to spools, and will be there at the same time. Fails
	 * if there is no room for them, so that nothing is written in vain.
	 */
	abacus_host_status (*spool_expect)(void *context, double bytes);
	/*
	 * Whether there is room for this many bytes: NONE if not. For data that would have to be
	 * counted first.
	 */
	abacus_host_status (*spool_fits)(void *context, double bytes);
} abacus_host;

/*
 * Stops the threads of the core, even in the middle of a call: for a session that ends without
 * returning from it. Nothing happens if there are none.
 */
ABACUS_API void abacus_stop_threads(void);

#ifdef __cplusplus
}
#endif

#endif
