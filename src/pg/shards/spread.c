/*
 * spread.c: the first phase of a build over several servers: a plan, and each point to the shard that owns
 * it.
 *
 * A survey comes first, from which domain and borders follow. A query of the coordinator is read twice, in
 * one snapshot: for the survey, and to deal out its rows, of which the coordinator keeps none. A server reads
 * its own query once, and keeps the rows until it is known who owns them. On each server it is one
 * transaction. They are committed one after the other; the coordinator's row follows. If something fails
 * before that, the next call begins the phase anew, and drops what is there.
 *
 * Equal points have the same code, so the same shard owns them. There they arrive in the order of the rows
 * of the query, and of several queries in the order of these. So the first of them becomes the vertex.
 */
#include "postgres.h"

#include "catalog/pg_type.h"
#include "utils/array.h"
#include "utils/builtins.h"

#include "pg/mesh/shape.h"
#include "pg/shards/build_progress.h"
#include "pg/shards/point_bytes.h"
#include "pg/shards/relay.h"
#include "pg/shards/shard_owner.h"
#include "pg/shards/shard_sql.h"
#include "pg/shards/shard_survey.h"
#include "pg/shards/spread.h"

typedef struct Spreading
{
	Generation *generation;
	const ShardSource *source;
	abacus_header header;		/* shape of the points, and names */
	Datum	   *columns;		/* names in the first query of several, as text */
	StringInfoData *bytes;		/* of points for each shard */
	bool		has_srid;		/* geometries have come */
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

/* The points have the SRID of the first geometries. */
static void
take_srid(Spreading *spreading, int32 srid, int query)
{
	abacus_form *form = &spreading->generation->form;

	if (srid < 0)
		return;
	if (spreading->has_srid && srid != (int32) form->srid)
		ereport(ERROR,
				(errcode(ERRCODE_INVALID_PARAMETER_VALUE),
				 errmsg("query %d has geometries of SRID %d, but earlier ones have SRID %u", query + 1, srid, form->srid),
				 errhint("Transform them in the queries: ST_Transform(geom, %u).", form->srid)));
	spreading->has_srid = true;
	form->srid = spreading->header.facts.form.srid = (uint32) srid;
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

/* Says the same to each server, once it has dealt with what was sent before, and waits for all. */
static void
say_to_all(const Generation *generation, ShardLinks *links, char *(*statement) (const Generation *generation, int shard))
{
	for (int i = 0; i < generation->shards; i++)
	{
		link_finish(links, i);
		link_send(links, i, statement(generation, i));
	}
	for (int i = 0; i < generation->shards; i++)
		link_finish(links, i);
}

/* ---- One query, run here -------------------------------------------------------------------- */

static void
deal_out(Spreading *spreading, ShardLinks *links, const ShardOwners *owners, const uint64 *record)
{
	Generation *generation = spreading->generation;
	const double *point = (const double *) (record + 1);
	StringInfo	bytes;
	int			owner = owner_of_point(owners, point);

	for (uint32 i = 0; i < generation->form.dimension; i++)
	{
		/* a query may return other rows than before: it is volatile */
		generation->extent.lower[i] = Min(generation->extent.lower[i], point[i]);
		generation->extent.upper[i] = Max(generation->extent.upper[i], point[i]);
	}
	bytes = &spreading->bytes[owner];
	point_bytes_add(bytes, record, point_words(&spreading->header.facts));
	if (bytes->len >= POINT_BYTES_FULL)
		relay_bytes(links, 0, owner, bytes);
}

static void
spread_query(Spreading *spreading, ShardLinks *links)
{
	Generation *generation = spreading->generation;
	abacus_facts *facts = &spreading->header.facts;
	ShardOwners owners;
	Source		source;
	ShardSurvey survey;
	const uint64 *points;
	size_t		count;

	source_prepare(&source, spreading->source->queries[0]);
	if (generation->attributes == NULL)
		shard_survey_name_columns(&spreading->header, &source);
	take_names(spreading);
	shard_survey_begin(&survey, facts);
	take_srid(spreading, shard_survey_read(&survey, &source, abacus_names_of(&spreading->header), NULL), 0);
	make_plan(spreading, &survey);
	shard_survey_end(&survey);
	say_to_all(generation, links, shard_sql_begin);

	build_progress(SHOWN_SPREADING, 0, generation->points, 0);
	owners = (ShardOwners) {generation->form, generation->borders, generation->shards - 1};
	spreading->bytes = palloc(generation->shards * sizeof(StringInfoData));
	for (int i = 0; i < generation->shards; i++)
		initStringInfo(&spreading->bytes[i]);
	source_open(&source, abacus_names_of(&spreading->header), false);
	while ((count = source_fetch(&source, &points)) > 0)
	{
		for (size_t i = 0; i < count; i++)
			deal_out(spreading, links, &owners, points + i * (size_t) point_words(facts));
		build_progress_add((int64) count);
	}
	source_close(&source);
	for (int i = 0; i < generation->shards; i++)
		relay_bytes(links, 0, i, &spreading->bytes[i]);
	source_finish(&source);
}

/* ---- A query for each shard, run there ------------------------------------------------------ */

/* What a server has found out about its points. */
static const Oid survey_columns[] = {INT8OID, TEXTARRAYOID, FLOAT8ARRAYOID, FLOAT8ARRAYOID, INT4OID, FLOAT8ARRAYOID};

static const double *
numbers_of(Datum array, int *count)
{
	ArrayType  *numbers = DatumGetArrayTypeP(array);

	if (array_contains_nulls(numbers) || ARR_NDIM(numbers) > 1)
		elog(ERROR, "a server returned a survey with NULLs");
	*count = ARR_NDIM(numbers) == 0 ? 0 : ARR_DIMS(numbers)[0];
	return (const double *) ARR_DATA_PTR(numbers);
}

/*
 * Attributes are columns by position. So the queries must have the same ones: as many, and of the same names
 * as those of the first query, after which they are named unless the mesh has names.
 */
static void
merge_names(Spreading *spreading, Datum array, int shard)
{
	int			count;
	Datum	   *names = shape_names(DatumGetArrayTypeP(array), "attributes", &count);
	Generation *generation = spreading->generation;

	if (shard == 0)
	{
		spreading->columns = names;
		for (int i = 0; i < count && generation->attributes == NULL; i++)
			shape_attribute(&spreading->header, TextDatumGetCString(names[i]));
	}
	if (count != (int) spreading->header.facts.columns.attributes)
		ereport(ERROR,
				(errcode(ERRCODE_DATATYPE_MISMATCH),
				 errmsg("query %d has %d columns after the coordinates, but the mesh has %u attributes", shard + 1,
						count, spreading->header.facts.columns.attributes),
				 errhint("Return id, coordinates and the attributes in each query.")));
	for (int i = 0; i < count; i++)
	{
		char	   *name = TextDatumGetCString(names[i]);
		char	   *first = TextDatumGetCString(spreading->columns[i]);

		if (strcmp(name, first) != 0)
			ereport(ERROR,
					(errcode(ERRCODE_DATATYPE_MISMATCH),
					 errmsg("attribute %d is named \"%s\" in query %d, but \"%s\" in query 1", i + 1, name, shard + 1,
							first),
					 errhint("Return the same columns in the same order in each query; AS names them.")));
	}
}

static void
merge_survey(Spreading *spreading, ShardLinks *links, ShardSurvey *survey, int shard)
{
	abacus_box	box;
	LinkRows   *rows = link_rows(links, shard, link_columns(lengthof(survey_columns), survey_columns, NULL));
	int			dimension = (int) spreading->header.facts.form.dimension;
	int			count;
	int32		srid;
	bool		isnull;
	const double *numbers;

	merge_names(spreading, link_value(rows, 0, 2), shard);
	numbers = numbers_of(link_value(rows, 0, 3), &count);
	memcpy(box.lower, numbers, Min(count, dimension) * sizeof(double));
	numbers = numbers_of(link_value(rows, 0, 4), &count);
	memcpy(box.upper, numbers, Min(count, dimension) * sizeof(double));
	srid = DatumGetInt32(link_value_or_null(rows, 0, 5, &isnull));
	take_srid(spreading, isnull ? -1 : srid, shard);
	numbers = numbers_of(link_value(rows, 0, 6), &count);
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
		link_send(links, i, shard_sql_survey(generation, i, spreading->source->queries[i]));
	for (int i = 0; i < generation->shards; i++)
		merge_survey(spreading, links, &survey, i);
	take_names(spreading);
	make_plan(spreading, &survey);
	shard_survey_end(&survey);
}

/* Each server gets what it owns of the queries of others, by way of the coordinator. */
static void
spread_queries(Spreading *spreading, ShardLinks *links)
{
	Generation *generation = spreading->generation;

	survey_queries(spreading, links);
	say_to_all(generation, links, shard_sql_begin);
	build_progress(SHOWN_SPREADING, 0, generation->points, 0);
	if (generation->points > 0)
		say_to_all(generation, links, shard_sql_split);
	for (int i = 0; i < generation->shards; i++)
		relay_split(links, i);
}

void
spread_points(Generation *generation, ShardLinks *links, const ShardSource *source)
{
	Spreading  *spreading = palloc0(sizeof(Spreading));

	build_progress(SHOWN_SPREADING, 0, 0, 0);
	spreading->generation = generation;
	spreading->source = source;
	spreading->memory = CurrentMemoryContext;
	begin_header(spreading);
	say_to_all(generation, links, shard_sql_begin_spread);
	if (source->is_here)
		spread_query(spreading, links);
	else
		spread_queries(spreading, links);
	say_to_all(generation, links, shard_sql_stage);
	for (int i = 0; i < generation->shards; i++)
		link_do(links, i, "COMMIT");
}
