/*
 * result.c: the results of SQL functions: rows, and rows of figures.
 */
#include "postgres.h"

#include "funcapi.h"
#include "utils/builtins.h"
#include "utils/tuplestore.h"

#include "pg/sql/result.h"

/* Row type of the function's result, blessed, in the current memory context. */
TupleDesc
result_row_type(FunctionCallInfo fcinfo)
{
	TupleDesc	row_type;

	if (get_call_result_type(fcinfo, NULL, &row_type) != TYPEFUNC_COMPOSITE)
		elog(ERROR, "function must return a row");
	return BlessTupleDesc(row_type);
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

/* What one of PostgreSQL's functions says of the size of a relation. */
double
bytes_of(PGFunction size, Oid relid)
{
	return (double) DatumGetInt64(DirectFunctionCall1(size, ObjectIdGetDatum(relid)));
}
