/*
 * fn_shard_survey.c: abacus_shard_survey and abacus_shard_owner, with which a server deals out the rows of
 * its own query. The rows are kept (point_room.h), so the query runs once.
 */
#include "postgres.h"

#include <math.h>

#include "catalog/pg_type.h"
#include "executor/spi.h"
#include "funcapi.h"
#include "utils/array.h"
#include "utils/builtins.h"

#include "pg/base/sql_function.h"
#include "pg/mesh/shape.h"
#include "pg/shards/shard_owner.h"
#include "pg/shards/shard_survey.h"
#include "pg/sql/rows/result.h"

SQL_FUNCTION(abacus_sql_shard_survey);
SQL_FUNCTION(abacus_sql_shard_owner);

/* Columns of a survey */
enum
{
	SURVEY_POINTS,
	SURVEY_ATTRIBUTES,
	SURVEY_LEAST,
	SURVEY_GREATEST,
	SURVEY_SRID,
	SURVEY_SAMPLE,
	SURVEY_COLUMNS
};

static void
domain_arguments(FunctionCallInfo fcinfo, int lower, abacus_form *form)
{
	if (PG_ARGISNULL(lower) || PG_ARGISNULL(lower + 1))
		return;
	shape_point(form, PG_GETARG_ARRAYTYPE_P(lower), "lower", form->lower);
	shape_point(form, PG_GETARG_ARRAYTYPE_P(lower + 1), "upper", form->upper);
	form->has_domain = 1;
}

static Datum
name_array(const abacus_header *header)
{
	int			count = (int) header->facts.columns.attributes;
	Datum	   *names = palloc(Max(1, count) * sizeof(Datum));

	for (int i = 0; i < count; i++)
		names[i] = CStringGetTextDatum(header->names[i]);
	return PointerGetDatum(construct_array(names, count, TEXTOID, -1, false, TYPALIGN_INT));
}

/*
 * abacus_shard_survey(query text, dimension int, own int, lower float8[], upper float8[])
 *     -> points, attributes, least, greatest, srid, sample
 */
Datum
abacus_sql_shard_survey(PG_FUNCTION_ARGS)
{
	abacus_header *header = palloc0(sizeof(abacus_header));
	Datum		values[SURVEY_COLUMNS];
	bool		isnull[SURVEY_COLUMNS] = {false};
	TupleDesc	desc = result_row_type(fcinfo);
	MemoryContext memory = CurrentMemoryContext;
	MemoryContext old;
	ShardSurvey survey;
	PointRoom	room;
	Source		source;
	uint64		points;
	int32		srid;
	abacus_box	box;
	const double *sample;
	size_t		count;

	if (PG_ARGISNULL(0) || PG_ARGISNULL(1) || PG_ARGISNULL(2))
		ereport(ERROR,
				(errcode(ERRCODE_NULL_VALUE_NOT_ALLOWED),
				 errmsg("query, dimension and own must not be NULL")));
	shape_dimension(&header->facts.form, PG_GETARG_INT32(1));
	domain_arguments(fcinfo, 3, &header->facts.form);
	source_prepare(&source, text_to_cstring(PG_GETARG_TEXT_PP(0)));
	shard_survey_name_columns(header, &source);
	shard_survey_begin(&survey, &header->facts);
	point_room_open(&room, PG_GETARG_INT32(2), -1, point_words(&header->facts));
	srid = shard_survey_read(&survey, &source, abacus_names_of(header), &room);
	point_room_close(&room);
	host_run(survey.host, abacus_survey_result, survey.survey, &points, &box, &sample, &count);
	old = MemoryContextSwitchTo(memory);
	values[SURVEY_POINTS] = Int64GetDatum((int64) points);
	values[SURVEY_ATTRIBUTES] = name_array(header);
	values[SURVEY_LEAST] = attribute_array(box.lower, (int) header->facts.form.dimension);
	values[SURVEY_GREATEST] = attribute_array(box.upper, (int) header->facts.form.dimension);
	values[SURVEY_SRID] = Int32GetDatum(srid);
	isnull[SURVEY_SRID] = srid < 0;
	values[SURVEY_SAMPLE] = attribute_array(sample, (int) (count * header->facts.form.dimension));
	MemoryContextSwitchTo(old);
	shard_survey_end(&survey);
	source_finish(&source);
	PG_RETURN_DATUM(HeapTupleGetDatum(heap_form_tuple(desc, values, isnull)));
}

/* abacus_shard_owner(lower float8[], upper float8[], borders bigint[], place float8[]) -> int */
Datum
abacus_sql_shard_owner(PG_FUNCTION_ARGS)
{
	ArrayType  *borders = PG_GETARG_ARRAYTYPE_P(2);
	ArrayType  *place = PG_GETARG_ARRAYTYPE_P(3);
	abacus_form form = {.dimension = ARR_NDIM(place) == 1 ? (uint32) ARR_DIMS(place)[0] : 0};
	double		point[ABACUS_MAX_DIMENSION];
	ShardOwners owners;

	shape_dimension(&form, (int32) form.dimension);
	domain_arguments(fcinfo, 0, &form);
	shape_point(&form, place, "place", point);
	for (uint32 i = 0; i < form.dimension; i++)
		if (!isfinite(point[i]))
			ereport(ERROR,
					(errcode(ERRCODE_INVALID_PARAMETER_VALUE),
					 errmsg("a point has a coordinate that is not a finite number"),
					 errhint("Leave such points out in the source query.")));
	if (ARR_NDIM(borders) > 1 || array_contains_nulls(borders))
		ereport(ERROR,
				(errcode(ERRCODE_INVALID_PARAMETER_VALUE),
				 errmsg("borders must be a one-dimensional array without NULLs")));
	owners = (ShardOwners) {form, (const uint64 *) ARR_DATA_PTR(borders), ARR_NDIM(borders) == 0 ? 0 : ARR_DIMS(borders)[0]};
	PG_RETURN_INT32(owner_of_point(&owners, point));
}
