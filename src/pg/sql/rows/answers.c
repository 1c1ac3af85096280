/*
 * answers.c: rows that the core reports one by one.
 */
#include "postgres.h"

#include "utils/memutils.h"
#include "utils/tuplestore.h"

#include "pg/host/guard.h"
#include "pg/sql/rows/answers.h"
#include "pg/sql/rows/result.h"

/* Prepares for rows with arrays, some of them with this many attributes. */
void
answers_have_arrays(Answers *answers, uint32 attributes)
{
	answers->attributes = attributes;
	answers->row = AllocSetContextCreate(CurrentMemoryContext, "Abacus row", ALLOCSET_DEFAULT_SIZES);
}

/* An array for one row; under the guard of the report. */
Datum
answers_array(const Answers *answers, const double *numbers, uint32 count)
{
	MemoryContext old = MemoryContextSwitchTo(answers->row);
	Datum		array = attribute_array(numbers, (int) count);

	MemoryContextSwitchTo(old);
	return array;
}

/* Adds a row and frees its arrays; under the guard of the report. */
void
answers_add(const Answers *answers, const Datum *values, const bool *isnull)
{
	tuplestore_putvalues(answers->set->setResult, answers->set->setDesc,
						 unconstify(Datum *, values), unconstify(bool *, isnull));
	if (answers->row != NULL)
		MemoryContextReset(answers->row);
}

/* Adds a row from finished values; called by the core. */
abacus_host_status
answers_put(const Answers *answers, const Datum *values, const bool *isnull)
{
	GUARD_BEGIN();
	answers_add(answers, values, isnull);
	GUARD_END(answers->host);
	return ABACUS_HOST_OK;
}

/* Adds the id of a place and an array of its values, or NULL; called by the core. */
abacus_host_status
answers_put_values(void *context, int64_t id, const double *numbers)
{
	Answers    *answers = context;
	Datum		values[2] = {Int64GetDatum(id)};
	bool		isnull[2] = {false, numbers == NULL};

	GUARD_BEGIN();
	if (numbers != NULL)
		values[1] = answers_array(answers, numbers, answers->attributes);
	answers_add(answers, values, isnull);
	GUARD_END(answers->host);
	return ABACUS_HOST_OK;
}
