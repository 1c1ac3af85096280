/*
 * answers.c: rows that the core reports one by one.
 */
#include "postgres.h"

#include "utils/tuplestore.h"

#include "pg/host/guard.h"
#include "pg/sql/answers.h"

/* Adds a row whose values are made; called by the core. */
abacus_host_status
answers_put(const Answers *answers, const Datum *values, const bool *isnull)
{
	GUARD_BEGIN();
	tuplestore_putvalues(answers->set->setResult, answers->set->setDesc,
						 unconstify(Datum *, values), unconstify(bool *, isnull));
	GUARD_END(answers->host);
	return ABACUS_HOST_OK;
}
