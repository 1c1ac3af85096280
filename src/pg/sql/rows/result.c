/*
 * result.c: the results of SQL functions: rows, and rows of figures.
 */
#include "postgres.h"

#include "funcapi.h"
#include "utils/builtins.h"
#include "utils/tuplestore.h"

#include "pg/sql/rows/result.h"

/* Row type of the function's result, blessed, in the current memory context. */
TupleDesc
result_row_type(FunctionCallInfo fcinfo)
{
	TupleDesc	row_type;

	if (get_call_result_type(fcinfo, NULL, &row_type) != TYPEFUNC_COMPOSITE)
		elog(ERROR, "function must return a row");
	return BlessTupleDesc(row_type);
}

/*
 * An error unless a composite type of ours has columns of exactly these types: its owner may have
 * altered it. `attributes` and `hint` are for the message.
 */
void
result_require_type(TupleDesc row_type, const char *name, const Oid *types, int count,
					const char *attributes, const char *hint)
{
	bool		is_ours = row_type->natts == count;

	for (int i = 0; is_ours && i < count; i++)
		is_ours = TupleDescAttr(row_type, i)->atttypid == types[i];
	if (!is_ours)
		ereport(ERROR,
				(errcode(ERRCODE_OBJECT_NOT_IN_PREREQUISITE_STATE),
				 errmsg("type %s has been altered", name),
				 errdetail("Its attributes must be %s.", attributes), errhint("%s", hint)));
}

void
put_figure(const Figures *figures, const char *name, double value, const char *description)
{
	Datum		values[3];
	bool		isnull[3] = {false};

	values[0] = CStringGetTextDatum(psprintf("%s%s", figures->prefix, name));
	values[1] = Float8GetDatum(value);
	values[2] = CStringGetTextDatum(description);
	tuplestore_putvalues(figures->set->setResult, figures->set->setDesc, values, isnull);
}

/* The size of a relation, from one of PostgreSQL's functions. */
double
bytes_of(PGFunction size, Oid relid)
{
	return (double) DatumGetInt64(DirectFunctionCall1(size, ObjectIdGetDatum(relid)));
}
