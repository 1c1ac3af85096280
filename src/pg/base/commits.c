/*
 * commits.c: whether a procedure may end its transaction.
 */
#include "postgres.h"

#include "access/xact.h"
#include "nodes/parsenodes.h"

#include "pg/base/commits.h"

/*
 * Refuses a call of a procedure that may not commit, before SPI_commit() would find that it may not. `step` is
 * what it commits; `function` does the same in one transaction, if there is one.
 */
void
require_commits(FunctionCallInfo fcinfo, const char *procedure, const char *step, const char *function)
{
	bool		atomic = fcinfo->context == NULL || !IsA(fcinfo->context, CallContext) ||
		castNode(CallContext, fcinfo->context)->atomic || IsSubTransaction();

	if (atomic)
		ereport(ERROR,
				(errcode(ERRCODE_INVALID_TRANSACTION_TERMINATION),
				 errmsg("%s() cannot commit here", procedure),
				 errdetail("It ends a transaction after each %s.", step),
				 function == NULL
				 ? errhint("CALL it outside transaction blocks, functions and exception blocks.")
				 : errhint("CALL it outside transaction blocks, functions and exception blocks, or "
						   "use %s().", function)));
}
