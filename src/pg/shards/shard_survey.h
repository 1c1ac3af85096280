/*
 * shard_survey.h: a survey of points before they are dealt out to shards.
 */
#ifndef ABACUS_SHARD_SURVEY_H
#define ABACUS_SHARD_SURVEY_H

#include "postgres.h"

#include "abacus/shards.h"
#include "pg/host/host.h"
#include "pg/input/source.h"
#include "pg/shards/point_room.h"

typedef struct ShardSurvey
{
	Host	   *host;
	abacus_survey *survey;
} ShardSurvey;

extern void shard_survey_begin(ShardSurvey *survey, const abacus_facts *facts);
extern void shard_survey_end(ShardSurvey *survey);
extern void shard_survey_name_columns(abacus_header *header, const Source *source);
extern int32 shard_survey_read(ShardSurvey *survey, Source *source, abacus_names names, PointRoom *room);

#endif
