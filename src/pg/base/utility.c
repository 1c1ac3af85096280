/*
 * utility.c: CREATE and DROP of objects that belong to a mesh.
 *
 * They run like any statement of the caller, with PostgreSQL's own checks of privileges and names,
 * event triggers, and hooks of other modules. The user has not written them, so errors do not quote
 * them.
 */
#include "postgres.h"

#include "access/xact.h"
#include "parser/parser.h"
#include "tcop/utility.h"
#include "utils/snapmgr.h"

#include "pg/base/utility.h"

/* An error's position in this statement would be shown as a position in the user's. */
static void
forget_position(void *unused)
{
	if (geterrposition() > 0)
		errposition(0);
}

static void
run(const char *command)
{
	RawStmt    *parsed = linitial_node(RawStmt, raw_parser(command, RAW_PARSE_DEFAULT));
	PlannedStmt *statement = makeNode(PlannedStmt);

	statement->commandType = CMD_UTILITY;
	statement->utilityStmt = parsed->stmt;
	PushActiveSnapshot(GetTransactionSnapshot());
	ProcessUtility(statement, command, false, PROCESS_UTILITY_QUERY, NULL, NULL, None_Receiver,
				   NULL);
	PopActiveSnapshot();
}

/* The effects of the statement are visible afterwards. */
void
utility_run(const char *command)
{
	ErrorContextCallback context = {error_context_stack, forget_position, NULL};

	error_context_stack = &context;
	run(command);
	error_context_stack = context.previous;
	CommandCounterIncrement();
}
