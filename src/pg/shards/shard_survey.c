/*
 * shard_survey.c: a survey of the points of a query before they are dealt out to shards.
 */
#include "postgres.h"

#include "pg/mesh/shape.h"
#include "pg/shards/shard_survey.h"

/* The facts have the shape of the points, and the domain if it is given. */
void
shard_survey_begin(ShardSurvey *survey, const abacus_facts *facts)
{
	survey->host = host_create(CurrentMemoryContext);
	survey->survey = NULL;
	host_run(survey->host, abacus_survey_open, &survey->host->table, facts, &survey->survey);
	host_own(survey->host, survey->survey, (void (*) (void *)) abacus_survey_close);
}

void
shard_survey_end(ShardSurvey *survey)
{
	host_release(survey->host);
	host_destroy(survey->host);
}

/* Names attributes after the columns that follow the coordinates. */
void
shard_survey_name_columns(abacus_header *header, const Source *source)
{
	for (int i = source_first_attribute(source, header->facts.form.dimension); i < source_columns(source); i++)
		shape_attribute(header, source_column_name(source, i));
}

/*
 * Reads all points of a prepared query, and puts them into the room, if there is one. Returns their SRID;
 * below 0: no geometries have come.
 */
int32
shard_survey_read(ShardSurvey *survey, Source *source, abacus_names names, PointRoom *room)
{
	const uint64 *points;
	size_t		count;
	int32		srid;

	source_open(source, names, true);
	while ((count = source_fetch(source, &points)) > 0)
	{
		host_run(survey->host, abacus_survey_add, survey->survey, points, count);
		for (size_t i = 0; i < count && room != NULL; i++)
			point_room_put(room, points + i * room->words);
	}
	srid = source->packer->srid;
	source_close(source);
	return srid;
}
