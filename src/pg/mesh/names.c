/*
 * names.c: names of attributes in the encoding in which they are stored.
 *
 * A dump converts texts from the encoding of one database to that of another,
 * but no bytes of pages. So names are stored in UTF-8, whatever the database
 * has. Only in one of SQL_ASCII, where nobody knows what bytes mean, they are
 * left as they are.
 */
#include "postgres.h"

#include "mb/pg_wchar.h"

#include "pg/mesh/names.h"

/* The first name whose bytes are no text; -1 if all are. */
int
names_find_invalid(const abacus_header *header)
{
	if (GetDatabaseEncoding() == PG_SQL_ASCII)
		return -1;
	for (uint32 i = 0; i < header->attributes; i++)
		if (!pg_verify_mbstr(PG_UTF8, header->names[i], strlen(header->names[i]), true))
			return (int) i;
	return -1;
}

static bool
is_converted(void)
{
	return GetDatabaseEncoding() != PG_UTF8 && GetDatabaseEncoding() != PG_SQL_ASCII;
}

/* Puts a converted name in the place of the one that it was made of. */
static void
replace(char *name, const char *converted)
{
	if (strlen(converted) >= ABACUS_NAME_BYTES)
		ereport(ERROR,
				(errcode(ERRCODE_INVALID_NAME),
				 errmsg("the name of an attribute is too long"),
				 errdetail("A name has at most %d bytes, both in UTF-8 and in %s.",
						   ABACUS_NAME_BYTES - 1, GetDatabaseEncodingName())));
	if (converted != name)
		strlcpy(name, converted, ABACUS_NAME_BYTES);
}

/* Names that are valid as stored become those that the database has for them. */
void
names_to_database(abacus_header *header)
{
	if (!is_converted())
		return;
	for (uint32 i = 0; i < header->attributes; i++)
		replace(header->names[i],
				pg_any_to_server(header->names[i], strlen(header->names[i]), PG_UTF8));
}

/* And back. */
void
names_to_storage(abacus_header *header)
{
	if (!is_converted())
		return;
	for (uint32 i = 0; i < header->attributes; i++)
		replace(header->names[i],
				pg_server_to_any(header->names[i], strlen(header->names[i]), PG_UTF8));
}
