/*
 * names.c: names of attributes and labels in the encoding in which they are stored.
 *
 * A dump converts texts to the encoding of another database, but not the bytes of pages. So names
 * are stored in UTF-8, whatever encoding the database has. Only in a database of SQL_ASCII, where
 * the meaning of bytes is unknown, they are stored unchanged.
 *
 * A mesh may come from a database with other characters. Characters that this one lacks are
 * escaped, as in a string U&'...'. A name that becomes too long is cut and ends with the number of
 * the attribute. Such a name does not determine the stored one. So the stored name is kept, and is
 * stored again unless the attribute gets another name.
 */
#include "postgres.h"

#include "catalog/namespace.h"
#include "lib/stringinfo.h"
#include "mb/pg_wchar.h"

#include "abacus/build.h"
#include "pg/mesh/names.h"

/* The first name whose bytes are not valid text; -1 if all are. */
int
names_find_invalid(const abacus_header *header)
{
	if (GetDatabaseEncoding() == PG_SQL_ASCII)
		return -1;
	for (uint32 i = 0; i < header->facts.columns.attributes + header->facts.columns.labels; i++)
		if (!pg_verify_mbstr(PG_UTF8, header->names[i], strlen(header->names[i]), true))
			return (int) i;
	return -1;
}

/* Whether the database has another encoding than the stored names. */
bool
names_are_converted(void)
{
	return GetDatabaseEncoding() != PG_UTF8 && GetDatabaseEncoding() != PG_SQL_ASCII;
}

/* Appends some characters in the encoding of the database; false if it lacks one of them. */
static bool
append_converted(StringInfo name, Oid conversion, const char *text, int length)
{
	unsigned char converted[ABACUS_NAME_BYTES * MAX_CONVERSION_GROWTH + 1];
	bool		whole;

	whole = OidIsValid(conversion) &&
		pg_do_encoding_conversion_buf(conversion, PG_UTF8, GetDatabaseEncoding(),
									  (unsigned char *) unconstify(char *, text), length,
									  converted, sizeof(converted), true) == length;
	if (whole)
		appendStringInfoString(name, (char *) converted);
	return whole;
}

static void
append_escaped(StringInfo name, Oid conversion, const char *character, int length)
{
	pg_wchar	code = utf8_to_unicode((const unsigned char *) character);

	if (code < 0x80)
		appendStringInfoChar(name, *character);
	else if (!append_converted(name, conversion, character, length))
		appendStringInfo(name, code < 0x10000 ? "\\%04X" : "\\+%06X", code);
}

/* Converts a stored name of the attribute with this number to the database's encoding. */
static void
to_database(const char *stored, uint32 number, char *name)
{
	Oid			conversion = FindDefaultConversionProc(PG_UTF8, GetDatabaseEncoding());
	char	   *end = psprintf("~%u", number);
	int			room = ABACUS_NAME_BYTES - 1 - (int) strlen(end);
	int			fits = -1;		/* length of whole characters, when converting one by one */
	StringInfoData converted;

	initStringInfo(&converted);
	if (!append_converted(&converted, conversion, stored, strlen(stored)))
		for (int length; *stored != '\0'; stored += length)
		{
			length = pg_utf_mblen((const unsigned char *) stored);
			append_escaped(&converted, conversion, stored, length);
			if (converted.len <= room)
				fits = converted.len;
		}
	if (converted.len >= ABACUS_NAME_BYTES)
	{
		converted.len = fits >= 0 ? fits : pg_mbcliplen(converted.data, converted.len, room);
		appendStringInfoString(&converted, end);
	}
	strlcpy(name, converted.data, ABACUS_NAME_BYTES);
	pfree(converted.data);
}

/* Converts stored names, which are valid, to those in the database. */
void
names_to_database(abacus_header *header, StoredNames *stored)
{
	for (uint32 i = 0; i < header->facts.columns.attributes + header->facts.columns.labels; i++)
	{
		strlcpy(stored->names[i], header->names[i], ABACUS_NAME_BYTES);
		to_database(stored->names[i], i + 1, header->names[i]);
	}
	stored->count = header->facts.columns.attributes + header->facts.columns.labels;
}

/*
 * The attributes have changed since the names were read: the i-th is the former one at source[i],
 * or a new one without a name (ABACUS_NO_ATTRIBUTE). The labels are the same.
 */
void
names_move(abacus_header *header, StoredNames *stored, const uint32 *source)
{
	for (uint32 i = 0; i < header->facts.columns.attributes; i++)
		if (source[i] == ABACUS_NO_ATTRIBUTE)
			header->names[i][0] = '\0';
		else
			strlcpy(header->names[i], stored->names[source[i]], ABACUS_NAME_BYTES);
	for (uint32 i = 0; i < header->facts.columns.labels; i++)
		strlcpy(header->names[header->facts.columns.attributes + i],
				stored->names[stored->count - header->facts.columns.labels + i], ABACUS_NAME_BYTES);
	names_to_database(header, stored);
}

static void
to_storage(char *name)
{
	const char *converted = pg_server_to_any(name, strlen(name), PG_UTF8);

	if (strlen(converted) >= ABACUS_NAME_BYTES)
		ereport(ERROR,
				(errcode(ERRCODE_INVALID_NAME),
				 errmsg("the name \"%s\" of an attribute or a label is too long", name),
				 errdetail("A name has at most %d bytes, both in UTF-8 and in %s.",
						   ABACUS_NAME_BYTES - 1, GetDatabaseEncodingName())));
	if (converted != name)
		strlcpy(name, converted, ABACUS_NAME_BYTES);
}

/* Converts back; a name that is the same as before gets its former stored form. */
void
names_to_storage(abacus_header *header, const StoredNames *stored)
{
	char		known[ABACUS_NAME_BYTES];

	for (uint32 i = 0; i < header->facts.columns.attributes + header->facts.columns.labels; i++)
	{
		if (stored != NULL && i < stored->count)
		{
			to_database(stored->names[i], i + 1, known);
			if (strcmp(known, header->names[i]) == 0)
			{
				strlcpy(header->names[i], stored->names[i], ABACUS_NAME_BYTES);
				continue;
			}
		}
		to_storage(header->names[i]);
	}
}
