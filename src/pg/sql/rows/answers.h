/*
 * answers.h: rows that the core reports one by one, for a function that
 * returns a set.
 */
#ifndef ABACUS_ANSWERS_H
#define ABACUS_ANSWERS_H

#include "nodes/execnodes.h"

#include "abacus/facts.h"
#include "pg/host/host.h"

/* The context of the core's reports. */
typedef struct Answers
{
	Host	   *host;
	ReturnSetInfo *set;			/* its tuplestore gets the rows */
	const abacus_facts *facts;	/* of the mesh or the octree */
	uint32		dimension;		/* of the mesh or the octree */
	uint32		attributes;		/* of a row */
	MemoryContext row;			/* for arrays of a row; NULL: there are none */
} Answers;

extern void answers_have_arrays(Answers *answers, uint32 attributes);
extern Datum answers_array(const Answers *answers, const double *numbers, uint32 count);
extern void answers_add(const Answers *answers, const Datum *values, const bool *isnull);
extern abacus_host_status answers_put(const Answers *answers, const Datum *values,
									  const bool *isnull);
extern abacus_host_status answers_put_values(void *answers, int64_t id, const double *numbers);

#endif
