/*
 * on_duplicate.c: an argument that says what happens to a point at the place of another.
 */
#include "postgres.h"

#include "utils/builtins.h"

#include "pg/sql/rows/on_duplicate.h"

abacus_on_duplicate
on_duplicate_argument(text *given)
{
	static const char *const names[] = {
		[ABACUS_KEEP] = "keep", [ABACUS_REPLACE] = "replace", [ABACUS_REFUSE] = "error"
	};
	char	   *name = text_to_cstring(given);

	for (int i = 0; i < lengthof(names); i++)
		if (strcmp(name, names[i]) == 0)
			return (abacus_on_duplicate) i;
	ereport(ERROR,
			(errcode(ERRCODE_INVALID_PARAMETER_VALUE),
			 errmsg("on_duplicate must not be \"%s\"", name),
			 errhint("Use 'keep', 'replace' or 'error'.")));
	return ABACUS_KEEP;			/* not reached */
}
