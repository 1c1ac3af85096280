/*
 * mesh_header.h: all that is known of a mesh as a whole: the facts, the names of its columns, and
 * the counters of all its builds. It is a row of its own among the pages. Only what changes
 * meshes needs it whole; reading takes the facts, and looking for a column takes the names.
 */
#ifndef ABACUS_ABACUS_MESH_HEADER_H
#define ABACUS_ABACUS_MESH_HEADER_H

#include <string.h>

#include "abacus/mesh_counters.h"
#include "abacus/facts.h"
#include "abacus/host_functions.h"

#ifdef __cplusplus
extern "C" {
#endif

/* So many names of attributes and labels the header row has room for; more are in rows of names. */
#define ABACUS_HEADER_NAMES 115

/* Copied by abacus_header_copy(): its room for names is much larger than most of them take. */
typedef struct abacus_header
{
	abacus_facts facts;
	uint64_t stamp;        /* never repeats; set by the host at each change */
	abacus_counters counters; /* summed over all builds; peak_bytes: the largest */
	unsigned char types[ABACUS_MAX_NAMES]; /* an abacus_column_type for each of the names */
	char names[ABACUS_MAX_NAMES][ABACUS_NAME_BYTES]; /* of attributes, then of labels */
#ifdef __cplusplus
	abacus_header() = default;
	abacus_header(const abacus_header &other) { copy(other); }
	abacus_header &operator=(const abacus_header &other)
	{
		if (this != &other)
			copy(other);
		return *this;
	}
	operator const abacus_facts &() const { return facts; }

  private:
	void copy(const abacus_header &other);
#endif
} abacus_header;

/* Copies all that matters; names beyond those in use stay as they are. */
static inline void
abacus_header_copy(abacus_header *to, const abacus_header *from)
{
	const abacus_columns *columns = &from->facts.columns;

	if (to != from)
		memcpy((void *) to, (const void *) from,
			   offsetof(abacus_header, names) +
				   (size_t) (columns->attributes + columns->labels) * ABACUS_NAME_BYTES);
}

#ifdef __cplusplus
inline void
abacus_header::copy(const abacus_header &other)
{
	abacus_header_copy(this, &other);
}
#endif

/*
 * The names of columns, with the facts that count them: what looks for a column by its name, or
 * speaks of columns, takes this. It points to both, which need not be those of one header.
 */
typedef struct abacus_names
{
	const abacus_facts *facts;
	const char (*of)[ABACUS_NAME_BYTES]; /* of attributes, then of labels */
} abacus_names;

static inline abacus_names
abacus_names_of(const abacus_header *header)
{
	abacus_names names = {&header->facts, header->names};

	return names;
}

/* Bytes of the header row; `bytes` has room for ABACUS_PAGE_BYTES. Returns the size. */
ABACUS_API size_t abacus_header_encode(const abacus_header *header, unsigned char *bytes);
/*
 * Checks and reads a header row; ABACUS_ERROR (corrupted) if it is not a header, (state) if it has
 * another format, or a column of a type that this version does not know. If it has rows of names
 * beside it, its names are empty, and its types those of doubles, until these are read.
 */
ABACUS_API abacus_status abacus_header_decode(const unsigned char *bytes, size_t size,
											  abacus_header *header, abacus_error *error);

/* Rows of names beside the header row; 0 if this has room for all names. */
ABACUS_API uint32_t abacus_header_name_rows(const abacus_columns *columns);
/* The same of such a row, from 0. */
ABACUS_API size_t abacus_header_encode_names(const abacus_header *header, uint32_t row,
											 unsigned char *bytes);
ABACUS_API abacus_status abacus_header_decode_names(const unsigned char *bytes, size_t size,
													uint32_t row, abacus_header *header,
													abacus_error *error);

#ifdef __cplusplus
}
#endif

#endif
