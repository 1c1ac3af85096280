/*
 * answers.h: rows that the core reports one by one, for a function that
 * returns a set.
 */
#ifndef ABACUS_ANSWERS_H
#define ABACUS_ANSWERS_H

#include "nodes/execnodes.h"

#include "pg/host/host.h"

/* What the function that the core reports to needs: the context of the report. */
typedef struct Answers
{
	Host	   *host;
	ReturnSetInfo *set;			/* into whose tuplestore rows go */
	uint32		dimension;		/* of the mesh */
} Answers;

extern abacus_host_status answers_put(const Answers *answers, const Datum *values,
									  const bool *isnull);

#endif
