/*
 * thinner.h: a mesh that is thinned, step by step.
 */
#ifndef ABACUS_THINNER_H
#define ABACUS_THINNER_H

#include "abacus/thin.h"
#include "pg/mesh/reader.h"
#include "pg/mesh/writer.h"

typedef struct Thinner
{
	Oid			source;
	Oid			mesh;			/* that grows */
	uint64		stamp;			/* of the source */
	const char *command;
	bool		commits;		/* after each step, unless ... */
	bool		holds;			/* ... the steps so far are to be one change */
	abacus_thin_options options;
	Writer		writer;
	/* closed with the writer's host: */
	abacus_thinning *thinning;
	abacus_stage *stage;
	abacus_build *build;
} Thinner;

extern Reader *thinner_source(const Thinner *thinner);
extern void thinner_begin(Thinner *thinner);
extern uint64 thinner_step(Thinner *thinner, abacus_thin_step step);
extern double thinner_greatest(Thinner *thinner, uint64 *without_value);
extern void thinner_end(Thinner *thinner);

#endif
