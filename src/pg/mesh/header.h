/*
 * header.h: the header of a mesh, a row of its simplex table.
 */
#ifndef ABACUS_HEADER_H
#define ABACUS_HEADER_H

#include "abacus/mesh_header.h"
#include "pg/mesh/mesh_pages.h"

/* The key of its row. */
extern const int64 header_key[PAGE_TABLE_KEYS];

extern void header_insert(Host *host, abacus_header *header);
extern bool header_find(Host *host, StoredPage *row);
extern void header_open_vertices(Host *host, const abacus_facts *facts);
extern abacus_status header_try_decode(Host *host, const StoredPage *row, abacus_header *header);
extern void header_decode(Host *host, const StoredPage *row, abacus_header *header);
extern void header_read(Host *host, abacus_header *header, ItemPointer tid);
extern void header_rewrite(Host *host, const abacus_header *header, ItemPointer tid);
extern void header_update(Host *host, abacus_header *header, ItemPointer tid);

extern void header_require_type(Host *host, const abacus_form *form);
extern void header_require_dimension(const abacus_form *form, uint32 dimension,
									 const char *hint);
extern void header_require_srid(const abacus_form *form, int32 srid);
extern int	header_attribute(abacus_names names, const char *name);
extern int	header_label(abacus_names names, const char *name);
extern void header_require_new_name(abacus_names names, const char *name);
extern int	header_find_attribute(abacus_names names, const char *name);
extern int	header_find_label(abacus_names names, const char *name);
extern void header_require_attributes(const abacus_facts *facts);
extern int	header_only_attribute(abacus_names names);

#endif
