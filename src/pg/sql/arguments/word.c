/*
 * word.c: an argument that is one of a few words.
 *
 * NULL means the same as the first of them. Functions of one place are called for every row, so
 * words are compared in place.
 */
#include "postgres.h"

#include "utils/builtins.h"

#include "pg/port/port.h"
#include "pg/sql/arguments/word.h"

/* The number of the given word; 0, the first, if it is NULL. */
int
word_argument(FunctionCallInfo fcinfo, int argument, const char *const *words, const char *name,
			  const char *hint)
{
	text	   *given;

	if (PG_ARGISNULL(argument))
		return 0;
	given = PG_GETARG_TEXT_PP(argument);
	for (int i = 0; words[i] != NULL; i++)
		if (strlen(words[i]) == VARSIZE_ANY_EXHDR(given) &&
			memcmp(words[i], VARDATA_ANY(given), VARSIZE_ANY_EXHDR(given)) == 0)
			return i;
	ereport(ERROR,
			(errcode(ERRCODE_INVALID_PARAMETER_VALUE),
			 errmsg("%s \"%s\" is not known", name, text_to_cstring(given)),
			 errhint("%s", hint)));
}
