/*
 * spread.c: the first phase of a build over several servers: a plan, and each point to the shard that owns
 * it.
 *
 * The points are read twice, in one snapshot: for the survey, from which domain and borders follow, and to
 * deal them out. So no server keeps more than its own. On each server it is one transaction. They are
 * committed one after the other; the coordinator's row follows. If something fails before that, the next
 * call begins the phase anew, and drops what is there.
 *
 * Equal points have the same code, so the same shard owns them. There they arrive in the order of the rows
 * of the query, and of several queries in the order of these. So the first of them becomes the vertex.
 */
#include "postgres.h"

#include "catalog/pg_type.h"
#include "utils/array.h"
#include "utils/builtins.h"

#include "pg/mesh/shape.h"
#include "pg/shards/relay.h"
#include "pg/shards/shard_sql.h"
#include "pg/shards/shard_survey.h"
#include "pg/shards/spread.h"

typedef struct Spreading
{
	Generation *generation;
	const ShardSource *source;
	abacus_header header;		/* shape of the points, and names */
	PointBatch *batches;		/* for each shard */
	MemoryContext memory;		/* of the generation: reading a query has memory of its own */
} Spreading;

/* The header has the shape that was given when the mesh was created. */
static void
begin_header(Spreading *spreading)
{
	const Generation *generation = spreading->generation;

	spreading->header.facts.form = generation->form;
	for (int i = 0; i < generation->attribute_count; i++)
		shape_attribute(&spreading->header, generation->attributes[i]);
}

/* The generation has the attributes of the header. */
static void
take_names(Spreading *spreading)
{
	Generation *generation = spreading->generation;
	int			count = (int) spreading->header.facts.columns.attributes;
	MemoryContext old = MemoryContextSwitchTo(spreading->memory);

	generation->attributes = palloc(Max(1, count) * sizeof(char *));
	generation->attribute_count = count;
	for (int i = 0; i < count; i++)
		generation->attributes[i] = pstrdup(spreading->header.names[i]);
	MemoryContextSwitchTo(old);
}

/* Domain and borders, from all surveys together. */
static void
make_plan(Spreading *spreading, ShardSurvey *survey)
{
	Generation *generation = spreading->generation;
	uint64		points;
	const double *sample;
	size_t		count;

	host_run(survey->host, abacus_survey_result, survey->survey, &points, &generation->extent, &sample, &count);
	generation->points = (int64) points;
	generation->borders = MemoryContextAllocZero(spreading->memory, generation->shards * sizeof(uint64));
	host_run(survey->host, abacus_survey_plan, survey->survey, (uint32) generation->shards, &generation->form,
			 generation->borders);
	if (points == 0)
		memset(&generation->extent, 0, sizeof(generation->extent));
}

static void
begin_meshes(const Generation *generation, ShardLinks *links)
{
	for (int i = 0; i < generation->shards; i++)
		link_send(links, i, shard_sql_begin(generation, i));
	for (int i = 0; i < generation->shards; i++)
		link_finish(links, i);
}

/* ---- One query, run here -------------------------------------------------------------------- */

static void
deal_out(Spreading *spreading, ShardLinks *links, const uint64 *record)
{
	Generation *generation = spreading->generation;
	const double *point = (const double *) (record + 1);
	int			dimension = (int) generation->form.dimension;
	abacus_error error;
	uint64		code;
	int			owner;

	if (abacus_codes(&generation->form, point, 1, &code, &error) != ABACUS_OK)
		elog(ERROR, "could not compute a code: %s", error.message);
	for (int i = 0; i < dimension; i++)
	{
		/* a query may return other rows than before: it is volatile */
		generation->extent.lower[i] = Min(generation->extent.lower[i], point[i]);
		generation->extent.upper[i] = Max(generation->extent.upper[i], point[i]);
	}
	owner = (int) generation_owner(generation, code);
	point_batch_add(&spreading->batches[owner], (int64) record[0], point, point + dimension);
	if (point_batch_is_full(&spreading->batches[owner]))
		relay_batch(generation, links, 0, owner, &spreading->batches[owner], shard_sql_stage);
}

static void
spread_query(Spreading *spreading, ShardLinks *links)
{
	Generation *generation = spreading->generation;
	abacus_names names = abacus_names_of(&spreading->header);
	int			words;
	Source		source;
	ShardSurvey survey;
	const uint64 *points;
	size_t		count;

	source_prepare(&source, spreading->source->queries[0]);
	if (generation->attributes == NULL)
		shard_survey_name_columns(&spreading->header, &source);
	take_names(spreading);
	words = 1 + (int) generation->form.dimension + generation->attribute_count;
	shard_survey_begin(&survey, names.facts);
	shard_survey_read(&survey, &source, names);
	make_plan(spreading, &survey);
	shard_survey_end(&survey);

	begin_meshes(generation, links);
	spreading->batches = palloc(generation->shards * sizeof(PointBatch));
	for (int i = 0; i < generation->shards; i++)
		point_batch_init(&spreading->batches[i], generation->form.dimension, generation->attribute_count);
	source_open(&source, names, false);
	while ((count = source_fetch(&source, &points)) > 0)
		for (size_t i = 0; i < count; i++)
			deal_out(spreading, links, points + i * words);
	source_close(&source);
	for (int i = 0; i < generation->shards; i++)
		relay_batch(generation, links, 0, i, &spreading->batches[i], shard_sql_stage);
	source_finish(&source);
}

/* ---- A query for each shard, run there ------------------------------------------------------ */

/* What a server has found out about its points. */
static const Oid survey_columns[] = {INT8OID, TEXTARRAYOID, FLOAT8ARRAYOID, FLOAT8ARRAYOID, FLOAT8ARRAYOID};

static const double *
numbers_of(Datum array, int *count)
{
	ArrayType  *numbers = DatumGetArrayTypeP(array);

	if (array_contains_nulls(numbers) || ARR_NDIM(numbers) > 1)
		elog(ERROR, "a server returned a survey with NULLs");
	*count = ARR_NDIM(numbers) == 0 ? 0 : ARR_DIMS(numbers)[0];
	return (const double *) ARR_DATA_PTR(numbers);
}

/* Takes the names of the first query's columns; those of the others must be as many. */
static void
merge_names(Spreading *spreading, Datum array, int shard)
{
	int			count;
	Datum	   *names = shape_names(DatumGetArrayTypeP(array), "attributes", &count);
	Generation *generation = spreading->generation;

	if (shard == 0 && generation->attributes == NULL)
		for (int i = 0; i < count; i++)
			shape_attribute(&spreading->header, TextDatumGetCString(names[i]));
	if (count != (int) spreading->header.facts.columns.attributes)
		ereport(ERROR,
				(errcode(ERRCODE_DATATYPE_MISMATCH),
				 errmsg("query %d has %d columns after the coordinates, but the mesh has %u attributes", shard + 1,
						count, spreading->header.facts.columns.attributes),
				 errhint("Return id, coordinates and the attributes in each query.")));
}

static void
merge_survey(Spreading *spreading, ShardLinks *links, ShardSurvey *survey, int shard)
{
	abacus_box	box;
	LinkRows   *rows = link_rows(links, shard, link_columns(lengthof(survey_columns), survey_columns, NULL));
	int			dimension = (int) spreading->header.facts.form.dimension;
	int			count;
	const double *numbers;

	merge_names(spreading, link_value(rows, 0, 2), shard);
	numbers = numbers_of(link_value(rows, 0, 3), &count);
	memcpy(box.lower, numbers, Min(count, dimension) * sizeof(double));
	numbers = numbers_of(link_value(rows, 0, 4), &count);
	memcpy(box.upper, numbers, Min(count, dimension) * sizeof(double));
	numbers = numbers_of(link_value(rows, 0, 5), &count);
	host_run(survey->host, abacus_survey_merge, survey->survey, (uint64) DatumGetInt64(link_value(rows, 0, 1)),
			 &box, numbers, (size_t) (count / dimension));
	link_rows_free(rows);
}

static void
survey_queries(Spreading *spreading, ShardLinks *links)
{
	Generation *generation = spreading->generation;
	ShardSurvey survey;

	shard_survey_begin(&survey, &spreading->header.facts);
	for (int i = 0; i < generation->shards; i++)
		link_send(links, i, shard_sql_survey(generation, spreading->source->queries[i]));
	for (int i = 0; i < generation->shards; i++)
		merge_survey(spreading, links, &survey, i);
	take_names(spreading);
	make_plan(spreading, &survey);
	shard_survey_end(&survey);
}

/* Each server gets what it owns: from its own query, and, by way of the coordinator, from others. */
static void
spread_queries(Spreading *spreading, ShardLinks *links)
{
	Generation *generation = spreading->generation;
	char	  **queries = spreading->source->queries;

	survey_queries(spreading, links);
	begin_meshes(generation, links);
	for (int i = 0; i < generation->shards; i++)
		link_send(links, i, shard_sql_others(generation, i, queries[i]));
	for (int i = 0; i < generation->shards; i++)
		link_finish(links, i);
	for (int i = 0; i < generation->shards; i++)
		(void) relay_exported(generation, links, i, shard_sql_arrive);
	for (int i = 0; i < generation->shards; i++)
	{
		link_finish(links, i);
		link_send(links, i, shard_sql_stage_arrived(generation, i, queries[i]));
	}
}

void
spread_points(Generation *generation, ShardLinks *links, const ShardSource *source)
{
	Spreading  *spreading = palloc0(sizeof(Spreading));

	spreading->generation = generation;
	spreading->source = source;
	spreading->memory = CurrentMemoryContext;
	begin_header(spreading);
	for (int i = 0; i < generation->shards; i++)
		link_do(links, i, "BEGIN ISOLATION LEVEL REPEATABLE READ");
	if (source->is_here)
		spread_query(spreading, links);
	else
		spread_queries(spreading, links);
	for (int i = 0; i < generation->shards; i++)
		link_finish(links, i);
	for (int i = 0; i < generation->shards; i++)
		link_do(links, i, "COMMIT");
}
