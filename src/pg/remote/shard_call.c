/*
 * shard_call.c: the call of a function on the coordinator's mesh as a call on a shard's, in SQL.
 *
 * The function has the same name and arguments there. Arguments go as text of their types, after which
 * the server has the same values: doubles are written with all their digits.
 */
#include "postgres.h"

#include "catalog/pg_proc.h"
#include "funcapi.h"
#include "lib/stringinfo.h"
#include "utils/builtins.h"
#include "utils/guc.h"
#include "utils/lsyscache.h"
#include "utils/syscache.h"

#include "pg/remote/shard_call.h"

static char *
argument_literal(FunctionCallInfo fcinfo, int i)
{
	Oid			type = get_fn_expr_argtype(fcinfo->flinfo, i);
	Oid			output;
	bool		is_varlena;

	if (PG_ARGISNULL(i))
		return psprintf("NULL::%s", format_type_be(type));
	getTypeOutputInfo(type, &output, &is_varlena);
	return psprintf("%s::%s", quote_literal_cstr(OidOutputFunctionCall(output, PG_GETARG_DATUM(i))),
					format_type_be(type));
}

/* Doubles of arguments are written with all their digits, whatever the user has set. */
static int
digits_begin(void)
{
	int			level = NewGUCNestLevel();

	(void) set_config_option("extra_float_digits", "1", PGC_USERSET, PGC_S_SESSION, GUC_ACTION_SAVE, true, 0, false);
	return level;
}

/*
 * The call. The first argument is the mesh; `replaced` arguments after it are the given ones, and those
 * behind them are as they came.
 */
char *
shard_call(FunctionCallInfo fcinfo, const char *mesh, int replaced, const char *const *replacements)
{
	StringInfoData call;
	int			level = digits_begin();

	initStringInfo(&call);
	appendStringInfo(&call, "%s('%s'::regclass", get_func_name(fcinfo->flinfo->fn_oid), mesh);
	for (int i = 1; i < PG_NARGS(); i++)
		appendStringInfo(&call, ", %s", i <= replaced ? replacements[i - 1] : argument_literal(fcinfo, i));
	appendStringInfoChar(&call, ')');
	AtEOXact_GUC(true, level);
	return call.data;
}

/* The number of the argument with this name, from 0; -1 if the function has none or it is NULL. */
static int
find_argument(FunctionCallInfo fcinfo, const char *name)
{
	HeapTuple	tuple = SearchSysCache1(PROCOID, ObjectIdGetDatum(fcinfo->flinfo->fn_oid));
	Oid		   *types;
	char	  **names;
	char	   *modes;
	int			count = get_func_arg_info(tuple, &types, &names, &modes);
	int			found = -1;

	for (int i = 0, input = 0; i < count && names != NULL; i++)
	{
		if (modes != NULL && modes[i] != PROARGMODE_IN)
			continue;
		if (strcmp(names[i], name) == 0 && !PG_ARGISNULL(input))
			found = input;
		input++;
	}
	ReleaseSysCache(tuple);
	return found;
}

/* Whether the argument with this name is this text, or NULL, or the function has no such argument. */
bool
shard_call_has_text(FunctionCallInfo fcinfo, const char *name, const char *value)
{
	int			argument = find_argument(fcinfo, name);

	return argument < 0 || strcmp(TextDatumGetCString(PG_GETARG_DATUM(argument)), value) == 0;
}

/* Whether the argument with this name is NULL, or the function has no such argument. */
bool
shard_call_has_null(FunctionCallInfo fcinfo, const char *name)
{
	return find_argument(fcinfo, name) < 0;
}
