/*
 * generation.c: the rows of the coordinator's table of a mesh over several servers.
 *
 * The phase of a row changes by one UPDATE. So a mesh is published by one row, and a reader has it as it
 * was made by one build or by another. The meshes on the servers have the number of their generation in
 * their names: those of the published generation stay as they are while the next one is built.
 */
#include "postgres.h"

#include "catalog/pg_type.h"
#include "executor/spi.h"
#include "utils/array.h"
#include "utils/builtins.h"
#include "utils/lsyscache.h"

#include "pg/lines/named_rows.h"
#include "pg/mesh/lines_table.h"
#include "pg/mesh/mesh.h"
#include "pg/shards/generation.h"
#include "pg/shards/shard_owner.h"

#define LONGEST_TOKEN 32

/* Columns of type abacus_shard_generation */
enum
{
	GENERATION_NUMBER,
	GENERATION_PHASE,
	GENERATION_SOURCE,
	GENERATION_TOKEN,
	GENERATION_SERVERS,
	GENERATION_DIMENSION,
	GENERATION_ATTRIBUTES,
	GENERATION_LOWER,
	GENERATION_UPPER,
	GENERATION_LEAST,
	GENERATION_GREATEST,
	GENERATION_BORDERS,
	GENERATION_POINTS,
	GENERATION_ROUNDS,
	GENERATION_SENT,
	GENERATION_SIMPLICES,
	GENERATION_NAMES_GIVEN,
	GENERATION_DOMAIN_GIVEN,
	GENERATION_SRID,
	GENERATION_VERSIONS,
	GENERATION_COLUMNS
};
StaticAssertDecl(GENERATION_COLUMNS == SHARD_GENERATION_COLUMNS, "the columns of abacus_shard_generation");

static Oid column_types[GENERATION_COLUMNS] = {
	INT8OID, TEXTOID, TEXTOID, TEXTOID, TEXTARRAYOID, INT4OID, TEXTARRAYOID, FLOAT8ARRAYOID, FLOAT8ARRAYOID,
	FLOAT8ARRAYOID, FLOAT8ARRAYOID, INT8ARRAYOID, INT8OID, INT4OID, INT8OID, INT8OID, BOOLOID, BOOLOID, INT4OID,
	INT8ARRAYOID
};

static const char *const phase_names[] = {
	[SHARDS_NEW] = "new", [SHARDS_SPREAD] = "spread", [SHARDS_TRIANGULATED] = "triangulated",
	[SHARDS_PUBLISHED] = "published"
};

const char *
phase_name(ShardPhase phase)
{
	return phase_names[phase];
}

/* ---- From a row ----------------------------------------------------------------------------- */

/* The user can write the table: so nothing in it is taken for granted. */
static void
refuse_row(Oid relid, const char *why)
{
	ereport(ERROR,
			(errcode(ERRCODE_DATA_CORRUPTED),
			 errmsg("the table of mesh \"%s\" is damaged", get_rel_name(relid)),
			 errdetail("%s", why),
			 errhint("Build the mesh again with abacus_shard_build().")));
}

static Datum *
elements(Oid relid, Datum array, Oid type, int *count)
{
	ArrayType  *given = DatumGetArrayTypeP(array);
	Datum	   *values;
	int16		length;
	bool		by_value;
	char		align;

	if (ARR_NDIM(given) > 1 || array_contains_nulls(given))
		refuse_row(relid, "An array has NULLs or several dimensions.");
	get_typlenbyvalalign(type, &length, &by_value, &align);
	deconstruct_array(given, type, length, by_value, align, &values, NULL, count);
	return values;
}

static char **
texts(Oid relid, Datum array, int *count)
{
	Datum	   *values = elements(relid, array, TEXTOID, count);
	char	  **result = palloc(Max(1, *count) * sizeof(char *));

	for (int i = 0; i < *count; i++)
		result[i] = TextDatumGetCString(values[i]);
	return result;
}

static void
read_point(const Generation *generation, Datum array, double *point)
{
	int			count;
	Datum	   *values = elements(generation->relid, array, FLOAT8OID, &count);

	if (count != (int) generation->form.dimension)
		refuse_row(generation->relid, "A point has another number of coordinates than the mesh.");
	for (int i = 0; i < count; i++)
		point[i] = DatumGetFloat8(values[i]);
}

static ShardPhase
read_phase(Oid relid, const char *name)
{
	for (int i = 0; i < lengthof(phase_names); i++)
		if (strcmp(phase_names[i], name) == 0)
			return (ShardPhase) i;
	refuse_row(relid, psprintf("There is no phase \"%s\".", name));
	return SHARDS_NEW;			/* not reached */
}

static void
read_borders(Generation *generation, Datum array)
{
	int			count;
	Datum	   *values = elements(generation->relid, array, INT8OID, &count);

	if (count != generation->shards - 1)
		refuse_row(generation->relid, "There must be one border less than servers.");
	generation->borders = palloc(Max(1, count) * sizeof(uint64));
	for (int i = 0; i < count; i++)
	{
		generation->borders[i] = (uint64) DatumGetInt64(values[i]);
		if (DatumGetInt64(values[i]) < 0 || (i > 0 && generation->borders[i] < generation->borders[i - 1]))
			refuse_row(generation->relid, "The borders do not ascend.");
	}
}

static void
read_versions(Generation *generation, Datum array)
{
	int			count;
	Datum	   *values = elements(generation->relid, array, INT8OID, &count);

	if (count != generation->shards)
		refuse_row(generation->relid, "There must be a version of each shard.");
	for (int i = 0; i < count; i++)
		generation->versions[i] = DatumGetInt64(values[i]);
}

static void
read_row(Generation *generation, const Datum *values, const bool *isnull)
{
	int32		dimension = isnull[GENERATION_DIMENSION] ? 0 : DatumGetInt32(values[GENERATION_DIMENSION]);
	int32		srid;

	if (isnull[GENERATION_PHASE] || isnull[GENERATION_TOKEN] || isnull[GENERATION_SERVERS] ||
		(dimension != 2 && dimension != 3))
		refuse_row(generation->relid, "A phase, token, servers or dimension is missing.");
	generation->number = DatumGetInt64(values[GENERATION_NUMBER]);
	generation->phase = read_phase(generation->relid, TextDatumGetCString(values[GENERATION_PHASE]));
	generation->source = isnull[GENERATION_SOURCE] ? NULL : TextDatumGetCString(values[GENERATION_SOURCE]);
	generation->token = TextDatumGetCString(values[GENERATION_TOKEN]);
	if (strspn(generation->token, "0123456789abcdef") != strlen(generation->token) ||
		strlen(generation->token) > LONGEST_TOKEN)
		refuse_row(generation->relid, "The token is not a hexadecimal number.");
	generation->servers = texts(generation->relid, values[GENERATION_SERVERS], &generation->shards);
	if (generation->shards < 1)
		refuse_row(generation->relid, "There are no servers.");
	generation->form.dimension = (uint32) dimension;
	if (!isnull[GENERATION_ATTRIBUTES])
		generation->attributes = texts(generation->relid, values[GENERATION_ATTRIBUTES], &generation->attribute_count);
	generation->form.has_domain = !isnull[GENERATION_LOWER] && !isnull[GENERATION_UPPER];
	if (generation->form.has_domain)
	{
		read_point(generation, values[GENERATION_LOWER], generation->form.lower);
		read_point(generation, values[GENERATION_UPPER], generation->form.upper);
	}
	if (!isnull[GENERATION_LEAST] && !isnull[GENERATION_GREATEST])
	{
		read_point(generation, values[GENERATION_LEAST], generation->extent.lower);
		read_point(generation, values[GENERATION_GREATEST], generation->extent.upper);
	}
	if (!isnull[GENERATION_BORDERS])
		read_borders(generation, values[GENERATION_BORDERS]);
	else if (generation->phase > SHARDS_NEW)
		refuse_row(generation->relid, "There are no borders.");
	generation->versions = palloc0(generation->shards * sizeof(int64));
	if (!isnull[GENERATION_VERSIONS])
		read_versions(generation, values[GENERATION_VERSIONS]);
	generation->points = isnull[GENERATION_POINTS] ? 0 : DatumGetInt64(values[GENERATION_POINTS]);
	generation->rounds = isnull[GENERATION_ROUNDS] ? 0 : DatumGetInt32(values[GENERATION_ROUNDS]);
	generation->sent = isnull[GENERATION_SENT] ? 0 : DatumGetInt64(values[GENERATION_SENT]);
	generation->simplices = isnull[GENERATION_SIMPLICES] ? 0 : DatumGetInt64(values[GENERATION_SIMPLICES]);
	generation->names_given = !isnull[GENERATION_NAMES_GIVEN] && DatumGetBool(values[GENERATION_NAMES_GIVEN]);
	generation->domain_given = !isnull[GENERATION_DOMAIN_GIVEN] && DatumGetBool(values[GENERATION_DOMAIN_GIVEN]);
	srid = isnull[GENERATION_SRID] ? 0 : DatumGetInt32(values[GENERATION_SRID]);
	if (srid < 0 || srid > ABACUS_MAX_SRID)
		refuse_row(generation->relid, psprintf("There is no SRID %d.", srid));
	generation->form.srid = (uint32) srid;
}

#define ALL_COLUMNS \
	"generation, phase, source, token, servers, dimension, attributes, lower, upper, least, greatest, borders, " \
	"points, rounds, sent, simplices, names_given, domain_given, srid, versions"

/* The first row of those chosen; false if there is none. SPI must be connected. */
static bool
read_first(Oid relid, const char *chosen, Generation *generation)
{
	Datum		values[GENERATION_COLUMNS];
	bool		isnull[GENERATION_COLUMNS];

	memset(generation, 0, sizeof(*generation));
	generation->relid = relid;
	if (!query_first(psprintf("SELECT " ALL_COLUMNS " FROM %s %s LIMIT 1", lines_table_name(relid), chosen),
					 values, isnull, GENERATION_COLUMNS))
		return false;
	read_row(generation, values, isnull);
	return true;
}

/* Reads the newest generation, or the newest that is published. */
bool
generation_read(Oid relid, bool published, Generation *generation)
{
	return read_first(relid, published
					  ? "WHERE phase OPERATOR(pg_catalog.=) 'published' ORDER BY generation DESC"
					  : "ORDER BY generation DESC", generation);
}

/* Reads the first one after the generation with this number. */
bool
generation_read_after(Oid relid, int64 number, Generation *generation)
{
	return read_first(relid, psprintf("WHERE generation OPERATOR(pg_catalog.>) '" INT64_FORMAT "' ORDER BY generation",
									  number), generation);
}

/* Reads the one with this number. */
bool
generation_read_numbered(Oid relid, int64 number, Generation *generation)
{
	return read_first(relid, psprintf("WHERE generation OPERATOR(pg_catalog.=) '" INT64_FORMAT "'", number), generation);
}

/* The generation that readers see, or an error. */
void
generation_require_published(Oid relid, Generation *generation)
{
	if (!generation_read(relid, true, generation))
		ereport(ERROR,
				(errcode(ERRCODE_OBJECT_NOT_IN_PREREQUISITE_STATE),
				 errmsg("mesh \"%s\" has not been built", get_rel_name(relid)),
				 errhint("CALL abacus_shard_build for it.")));
}

static char **
copy_texts(char **texts, int count)
{
	char	  **copy = palloc(Max(1, count) * sizeof(char *));

	for (int i = 0; i < count; i++)
		copy[i] = pstrdup(texts[i]);
	return copy;
}

/* A copy in the current memory context, to outlive the connection of SPI. */
void
generation_copy(Generation *to, const Generation *from)
{
	*to = *from;
	to->source = from->source == NULL ? NULL : pstrdup(from->source);
	to->token = pstrdup(from->token);
	to->servers = copy_texts(from->servers, from->shards);
	to->attributes = copy_texts(from->attributes, from->attribute_count);
	to->borders = palloc(from->shards * sizeof(uint64));
	memcpy(to->borders, from->borders, (from->shards - 1) * sizeof(uint64));
	to->versions = palloc(from->shards * sizeof(int64));
	memcpy(to->versions, from->versions, from->shards * sizeof(int64));
}

/* ---- To a row ------------------------------------------------------------------------------- */

static Datum
text_array(char **texts, int count)
{
	Datum	   *values = palloc(Max(1, count) * sizeof(Datum));

	for (int i = 0; i < count; i++)
		values[i] = CStringGetTextDatum(texts[i]);
	return PointerGetDatum(construct_array(values, count, TEXTOID, -1, false, TYPALIGN_INT));
}

static Datum
point_array(const double *point, uint32 dimension)
{
	Datum		values[ABACUS_MAX_DIMENSION];

	for (uint32 i = 0; i < dimension; i++)
		values[i] = Float8GetDatum(point[i]);
	return PointerGetDatum(construct_array(values, (int) dimension, FLOAT8OID, sizeof(float8), FLOAT8PASSBYVAL,
										   TYPALIGN_DOUBLE));
}

static Datum
number_array(const int64 *numbers, int count)
{
	Datum	   *values = palloc(Max(1, count) * sizeof(Datum));

	for (int i = 0; i < count; i++)
		values[i] = Int64GetDatum(numbers[i]);
	return PointerGetDatum(construct_array(values, count, INT8OID, sizeof(int64), FLOAT8PASSBYVAL, TYPALIGN_DOUBLE));
}

/* The row; nulls as SPI takes them. */
static void
make_row(const Generation *generation, Datum *values, char *nulls)
{
	const abacus_form *form = &generation->form;
	bool		has_extent = generation->phase >= SHARDS_SPREAD;

	memset(nulls, ' ', GENERATION_COLUMNS);
	values[GENERATION_NUMBER] = Int64GetDatum(generation->number);
	values[GENERATION_PHASE] = CStringGetTextDatum(phase_name(generation->phase));
	values[GENERATION_TOKEN] = CStringGetTextDatum(generation->token);
	values[GENERATION_SERVERS] = text_array(generation->servers, generation->shards);
	values[GENERATION_DIMENSION] = Int32GetDatum((int32) form->dimension);
	values[GENERATION_POINTS] = Int64GetDatum(generation->points);
	values[GENERATION_ROUNDS] = Int32GetDatum(generation->rounds);
	values[GENERATION_SENT] = Int64GetDatum(generation->sent);
	values[GENERATION_SIMPLICES] = Int64GetDatum(generation->simplices);
	values[GENERATION_NAMES_GIVEN] = BoolGetDatum(generation->names_given);
	values[GENERATION_DOMAIN_GIVEN] = BoolGetDatum(generation->domain_given);
	values[GENERATION_SRID] = Int32GetDatum((int32) form->srid);
	if (generation->source == NULL)
		nulls[GENERATION_SOURCE] = 'n';
	else
		values[GENERATION_SOURCE] = CStringGetTextDatum(generation->source);
	if (generation->attributes == NULL)
		nulls[GENERATION_ATTRIBUTES] = 'n';
	else
		values[GENERATION_ATTRIBUTES] = text_array(generation->attributes, generation->attribute_count);
	nulls[GENERATION_LOWER] = nulls[GENERATION_UPPER] = form->has_domain ? ' ' : 'n';
	values[GENERATION_LOWER] = point_array(form->lower, form->dimension);
	values[GENERATION_UPPER] = point_array(form->upper, form->dimension);
	nulls[GENERATION_LEAST] = nulls[GENERATION_GREATEST] = has_extent ? ' ' : 'n';
	values[GENERATION_LEAST] = point_array(generation->extent.lower, form->dimension);
	values[GENERATION_GREATEST] = point_array(generation->extent.upper, form->dimension);
	if (generation->borders == NULL)
		nulls[GENERATION_BORDERS] = 'n';
	else
		values[GENERATION_BORDERS] = number_array((const int64 *) generation->borders, generation->shards - 1);
	if (generation->versions == NULL)
		nulls[GENERATION_VERSIONS] = 'n';
	else
		values[GENERATION_VERSIONS] = number_array(generation->versions, generation->shards);
}

static void
change_row(const Generation *generation, const char *statement)
{
	Datum		values[GENERATION_COLUMNS] = {0};
	char		nulls[GENERATION_COLUMNS];
	int			status;

	make_row(generation, values, nulls);
	status = SPI_execute_with_args(statement, GENERATION_COLUMNS, column_types, values, nulls,
								   false, 0);
	if (status < 0 || SPI_processed != 1)
		ereport(ERROR,
				(errcode(ERRCODE_OBJECT_NOT_IN_PREREQUISITE_STATE),
				 errmsg("the table of mesh \"%s\" was changed by others", get_rel_name(generation->relid)),
				 errhint("Call abacus_shard_build() again.")));
}

void
generation_insert(const Generation *generation)
{
	change_row(generation,
			   psprintf("INSERT INTO %s (" ALL_COLUMNS ") VALUES ($1, $2, $3, $4, $5, $6, $7, $8, $9, $10, $11, "
						"$12, $13, $14, $15, $16, $17, $18, $19, $20)", lines_table_name(generation->relid)));
}

void
generation_update(const Generation *generation)
{
	change_row(generation,
			   psprintf("UPDATE %s SET (" ALL_COLUMNS ") = ROW ($1, $2, $3, $4, $5, $6, $7, $8, $9, $10, $11, "
						"$12, $13, $14, $15, $16, $17, $18, $19, $20) WHERE generation OPERATOR(pg_catalog.=) $1",
						lines_table_name(generation->relid)));
}

/* Deletes its row. */
void
generation_forget(const Generation *generation)
{
	(void) query_run(psprintf("DELETE FROM %s WHERE generation OPERATOR(pg_catalog.=) '" INT64_FORMAT "'",
							  lines_table_name(generation->relid), generation->number));
}

/* ---- Names and owners ----------------------------------------------------------------------- */

/* The name of a shard's mesh on its server, as an identifier in SQL. */
char *
generation_mesh(const Generation *generation, int shard)
{
	return psprintf("abacus_%s_" INT64_FORMAT "_%d", generation->token, generation->number, shard + 1);
}

/* What names of its prepared changes begin with, on its server. */
char *
generation_change_prefix(const Generation *generation, int shard)
{
	return generation_mesh(generation, shard);
}

/* The shard that owns a code. */
uint32
generation_owner(const Generation *generation, uint64 code)
{
	return (uint32) owner_of_code(generation->borders, generation->shards - 1, code);
}
