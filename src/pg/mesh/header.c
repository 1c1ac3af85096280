/*
 * header.c: the header of a mesh, a row of its simplex table.
 *
 * It stands under the key (-1, 0), below every simplex page. Each change of a mesh rewrites it
 * with a new random stamp. So a stamp names one state of the mesh for ever, even if the
 * transaction that made it is rolled back. A session's cache is good exactly as long as
 * the header that it sees has the stamp it was filled under.
 *
 * The names of many attributes are in rows of their own, under (-1, 1) and so on. They change only
 * with the header, so a reader of the header sees the names that belong to it. Unchanged rows are
 * not written.
 */
#include "postgres.h"

#include "lib/stringinfo.h"
#include "utils/lsyscache.h"

#include "pg/mesh/header.h"
#include "pg/mesh/names.h"
#include "pg/store/page_search.h"
#include "pg/store/page_write.h"

const int64 header_key[PAGE_TABLE_KEYS] = {-1, 0};

static void
new_stamp(abacus_header *header)
{
	if (!pg_strong_random(&header->stamp, sizeof(header->stamp)))
		ereport(ERROR,
				(errcode(ERRCODE_INTERNAL_ERROR), errmsg("could not generate a random number")));
}

/* The key of a row of names, from 0. */
static void
name_key(uint32 row, int64 *key)
{
	key[0] = header_key[0];
	key[1] = header_key[1] + 1 + row;
}

/* Writes the rows of names that have changed, and removes surplus ones. */
static void
store_names(Host *host, const abacus_header *header)
{
	MeshPages  *pages = mesh_pages(host);
	uint32		rows = abacus_header_name_rows(&header->facts.columns);
	unsigned char bytes[ABACUS_PAGE_BYTES];

	for (uint32 i = 0; i < Max(rows, pages->name_rows); i++)
	{
		size_t		size = i < rows ? abacus_header_encode_names(header, i, bytes) : 0;
		int64		key[PAGE_TABLE_KEYS];
		StoredPage	row;
		ItemPointerData tid;

		name_key(i, key);
		if (i >= pages->name_rows || !page_table_get(&pages->simplices, key, &row))
			page_table_insert(&pages->simplices, key, bytes, size, &tid);
		else if (i >= rows || row.size != size || memcmp(row.bytes, bytes, size) != 0)
		{
			tid = row.tid;
			if (i >= rows)
				page_table_delete(&pages->simplices, &tid);
			else
				page_table_update(&pages->simplices, key, bytes, size, &tid);
		}
	}
	pages->name_rows = rows;
}

/* Writes the header over the one at *tid, or, if *tid is not valid, as the header of a new mesh. */
static void
store(Host *host, const abacus_header *header, ItemPointer tid)
{
	abacus_header *converted = NULL;
	unsigned char bytes[ABACUS_PAGE_BYTES];
	size_t		size;

	if (names_are_converted())
	{
		converted = palloc(sizeof(abacus_header));
		abacus_header_copy(converted, header);
		names_to_storage(converted, host->names);
		header = converted;
	}
	size = abacus_header_encode(header, bytes);
	if (ItemPointerIsValid(tid))
		page_table_update(&mesh_pages(host)->simplices, header_key, bytes, size, tid);
	else
		page_table_insert(&mesh_pages(host)->simplices, header_key, bytes, size, tid);
	store_names(host, header);
	if (converted != NULL)
		pfree(converted);
}

/* Writes the header of a new mesh. */
void
header_insert(Host *host, abacus_header *header)
{
	ItemPointerData tid;

	new_stamp(header);
	ItemPointerSetInvalid(&tid);
	store(host, header, &tid);
}

/* The header row as the active snapshot sees it. */
bool
header_find(Host *host, StoredPage *row)
{
	if (page_table_get(&mesh_pages(host)->simplices, header_key, row))
		return true;
	page_table_refuse_newer(&mesh_pages(host)->simplices);
	return false;
}

/*
 * Locks and checks the vertex table. If the header counts rows there, the snapshot
 * must see them.
 */
void
header_open_vertices(Host *host, const abacus_facts *facts)
{
	MeshPages  *pages = mesh_pages(host);
	bool		found = true;

	if (pages->remote != NULL)
		return;
	mesh_pages_vertex_table(pages);
	if (facts->census.duplicates > 0)
		found = mesh_pages_any(pages, ABACUS_REPEATED_PAGES);
	else if (facts->census.inserted < facts->census.staged || abacus_lists_vertices(facts->standing))
		found = mesh_pages_any(pages, ABACUS_STAGED_PAGES);
	if (!found)
		page_table_refuse_newer(&pages->vertices);
}

/* Reads the rows of names beside a header. */
static abacus_status
try_decode_names(Host *host, abacus_header *header)
{
	MeshPages  *pages = mesh_pages(host);
	abacus_status status = ABACUS_OK;

	pages->name_rows = abacus_header_name_rows(&header->facts.columns);
	for (uint32 i = 0; i < pages->name_rows && status == ABACUS_OK; i++)
	{
		static const StoredPage missing;
		int64		key[PAGE_TABLE_KEYS];
		StoredPage	row;

		name_key(i, key);
		if (!page_table_get(&pages->simplices, key, &row))
			row = missing;
		status = abacus_header_decode_names(row.bytes, row.size, i, header, &host->failure);
	}
	return status;
}

/* Decodes the header, with the names beside it; an error goes to host->failure. */
abacus_status
header_try_decode(Host *host, const StoredPage *row, abacus_header *header)
{
	abacus_status status = abacus_header_decode(row->bytes, row->size, header, &host->failure);
	int			invalid;

	if (status == ABACUS_OK)
		status = try_decode_names(host, header);
	invalid = status == ABACUS_OK ? names_find_invalid(header) : -1;
	if (invalid >= 0)
	{
		const char *name = type_name(header->facts.form.type);

		MemSet(&host->failure, 0, sizeof(host->failure));
		host->failure.kind = ABACUS_ERROR_CORRUPTED;
		snprintf(host->failure.message, sizeof(host->failure.message), "%s is corrupted", name);
		snprintf(host->failure.detail, sizeof(host->failure.detail),
				 "The name of %s %d is not valid in UTF-8.",
				 invalid < (int) header->facts.columns.attributes ? "attribute" : "label",
				 invalid < (int) header->facts.columns.attributes ? invalid + 1
				 : invalid - (int) header->facts.columns.attributes + 1);
		snprintf(host->failure.hint, sizeof(host->failure.hint),
				 "Restore the %s from a backup or build it anew.", name);
		return ABACUS_ERROR;
	}
	if (status == ABACUS_OK && names_are_converted())
	{
		if (host->names == NULL)
			host->names = MemoryContextAlloc(host->home, sizeof(StoredNames));
		names_to_database(header, host->names);
	}
	return status;
}

void
header_decode(Host *host, const StoredPage *row, abacus_header *header)
{
	host_check(host, header_try_decode(host, row, header));
}

/* An error if the pages are not of the type that the caller expects. */
void
header_require_type(Host *host, const abacus_form *form)
{
	const MeshPages *pages = mesh_pages(host);
	const char *name;

	if (pages->type == ANY_TYPE || pages->type == form->type)
		return;
	name = get_rel_name(pages->mesh);
	if (form->type == ABACUS_OCTREE)
		ereport(ERROR,
				(errcode(ERRCODE_WRONG_OBJECT_TYPE),
				 errmsg("\"%s\" is an octree, not a mesh", name),
				 errhint("Use abacus_octants() or a function whose name begins with abacus_octree_.")));
	ereport(ERROR,
			(errcode(ERRCODE_WRONG_OBJECT_TYPE),
			 errmsg("\"%s\" is a mesh, not an octree", name),
			 errhint("Make an octree with abacus_octree_create().")));
}

/* Finds and decodes the header, which must exist; *tid gets its place, unless tid is NULL. */
void
header_read(Host *host, abacus_header *header, ItemPointer tid)
{
	StoredPage	row;

	if (mesh_pages(host)->remote != NULL)
	{
		mesh_pages_read_remote_header(mesh_pages(host), header);
		header_require_type(host, &header->facts.form);
		return;
	}
	if (!header_find(host, &row))
		ereport(ERROR,
				(errcode(ERRCODE_DATA_CORRUPTED),
				 errmsg("%s \"%s\" has no header", type_name(mesh_pages(host)->type),
						RelationGetRelationName(mesh_pages(host)->simplices.heap)),
				 errdetail("The row (%d, %d) of the table is missing.", (int) header_key[0],
						   (int) header_key[1]),
				 errhint("Restore the %s from a backup, or drop it and make it anew.",
						 type_name(mesh_pages(host)->type))));
	if (tid != NULL)
		*tid = row.tid;
	header_decode(host, &row, header);
	header_require_type(host, &header->facts.form);
}

/*
 * Rewrites the header at *tid, which the caller has locked: the mesh is the same, but its rows lie
 * elsewhere. Sessions may keep their cached data of the mesh. A writer with an older snapshot finds
 * the header changed, and cannot continue.
 */
void
header_rewrite(Host *host, const abacus_header *header, ItemPointer tid)
{
	store(host, header, tid);
}

/* Replaces the header at *tid, which the caller has locked. */
void
header_update(Host *host, abacus_header *header, ItemPointer tid)
{
	new_stamp(header);
	header_rewrite(host, header, tid);
}

/* An error if the mesh has another dimension, with a hint for the user. */
void
header_require_dimension(const abacus_form *form, uint32 dimension, const char *hint)
{
	if (form->dimension != dimension)
		ereport(ERROR,
				(errcode(ERRCODE_INVALID_PARAMETER_VALUE),
				 errmsg("%s has dimension %u, not %u", type_name(form->type), form->dimension,
						dimension),
				 errhint("%s%s", hint,
						 dimension == 3 ? " To make one in space, use dimension => 3." : "")));
}

/* Checks an SRID given for a mesh: an error if the mesh has another one. */
void
header_require_srid(const abacus_form *form, int32 srid)
{
	if (form->srid != 0 && srid != (int32) form->srid)
		ereport(ERROR,
				(errcode(ERRCODE_INVALID_PARAMETER_VALUE),
				 errmsg("srid is %d, but the mesh has SRID %u", srid, form->srid),
				 errhint("Leave out srid. If the mesh is in another system, say so with "
						 "abacus_set_srid(mesh, %d).", srid)));
}

/* Number of the attribute with this name, -1 if there is none. */
int
header_attribute(abacus_names names, const char *name)
{
	for (uint32 i = 0; i < names.facts->columns.attributes; i++)
		if (strcmp(names.of[i], name) == 0)
			return (int) i;
	return -1;
}

/* Number of the label with this name, -1 if there is none. */
int
header_label(abacus_names names, const char *name)
{
	const abacus_columns *columns = &names.facts->columns;

	for (uint32 i = 0; i < columns->labels; i++)
		if (strcmp(names.of[columns->attributes + i], name) == 0)
			return (int) i;
	return -1;
}

/* An error if an attribute or a label has this name. */
void
header_require_new_name(abacus_names names, const char *name)
{
	bool		is_attribute = header_attribute(names, name) >= 0;

	if (is_attribute || header_label(names, name) >= 0)
		ereport(ERROR,
				(errcode(ERRCODE_DUPLICATE_COLUMN),
				 is_attribute ? errmsg("%s already has an attribute \"%s\"",
									   type_name(names.facts->form.type), name)
				 : errmsg("mesh already has a label \"%s\"", name)));
}

/* Some of the names, for messages. */
static char *
list_names(abacus_names names, uint32 first, uint32 count)
{
	StringInfoData list;

	initStringInfo(&list);
	for (uint32 i = 0; i < count; i++)
		appendStringInfo(&list, "%s\"%s\"", i > 0 ? ", " : "", names.of[first + i]);
	return list.data;
}

/* What has the attributes, for messages. */
static const char *
holder(const abacus_facts *facts)
{
	return facts->columns.by_id ? "step" : type_name(facts->form.type);
}

/* Number of the attribute with this name, which must exist. */
int
header_find_attribute(abacus_names names, const char *name)
{
	const abacus_columns *columns = &names.facts->columns;
	int			number = header_attribute(names, name);

	if (number < 0)
		ereport(ERROR,
				(errcode(ERRCODE_UNDEFINED_COLUMN),
				 errmsg("%s has no attribute \"%s\"", holder(names.facts), name),
				 columns->attributes == 0 ? errdetail("It has no attributes.")
				 : errdetail("Its attributes are %s.", list_names(names, 0, columns->attributes))));
	return number;
}

/* Number of the label with this name, which must exist. */
int
header_find_label(abacus_names names, const char *name)
{
	const abacus_columns *columns = &names.facts->columns;
	int			number = header_label(names, name);

	if (number < 0)
		ereport(ERROR,
				(errcode(ERRCODE_UNDEFINED_COLUMN),
				 errmsg("mesh has no label \"%s\"", name),
				 columns->labels == 0 ? errdetail("It has no labels.")
				 : errdetail("Its labels are %s.",
							 list_names(names, columns->attributes, columns->labels))));
	return number;
}

/* An error if the mesh has no attributes. */
void
header_require_attributes(const abacus_facts *facts)
{
	if (facts->columns.attributes == 0)
		ereport(ERROR,
				(errcode(ERRCODE_OBJECT_NOT_IN_PREREQUISITE_STATE),
				 errmsg("%s has no attributes", holder(facts)),
				 facts->columns.by_id ? errhint("Give values to abacus_store(), as columns after the id.") :
				 facts->form.type == ABACUS_OCTREE ? errhint("Name them in abacus_octree_create().")
				 : errhint("Add attributes as columns after the coordinates in the query of "
						   "abacus_triangulate().")));
}

/* Number of the only attribute, for calls without a name. */
int
header_only_attribute(abacus_names names)
{
	const abacus_columns *columns = &names.facts->columns;

	header_require_attributes(names.facts);
	if (columns->attributes > 1)
		ereport(ERROR,
				(errcode(ERRCODE_AMBIGUOUS_COLUMN),
				 errmsg("%s has %u attributes, and none is named",
						holder(names.facts), columns->attributes),
				 errdetail("Its attributes are %s.", list_names(names, 0, columns->attributes)),
				 errhint("Name one with the argument attribute.")));
	return 0;
}
