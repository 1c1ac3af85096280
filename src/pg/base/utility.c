/*
 * utility.c: CREATE and DROP of what belongs to a mesh.
 *
 * They go the way that all statements go, as the caller: with PostgreSQL's own checks of
 * privileges and names, event triggers, and hooks of other modules.
 */
#include "postgres.h"

#include "access/xact.h"
#include "executor/spi.h"

#include "pg/base/utility.h"

/* What the statement has done is visible afterwards. */
void
utility_run(const char *command)
{
	int			result;

	SPI_connect();
	result = SPI_execute(command, false, 0);
	if (result != SPI_OK_UTILITY)
		elog(ERROR, "could not run \"%s\": %s", command, SPI_result_code_string(result));
	SPI_finish();
	CommandCounterIncrement();
}
