/*
 * fn_tiles.c: abacus_tiles, which makes functions of a mesh for tile servers.
 *
 * Martin calls f(z, x, y, query_params json), which returns a tile and an etag; a comment says what
 * kind of bytes it is. pg_tileserv calls f(z, x, y, named arguments...) for a vector tile. So four
 * functions are made. Their bodies are parsed when they are made. So they follow the mesh when it
 * is renamed, and depend on it.
 */
#include "postgres.h"

#include "common/hashfn.h"
#include "common/shortest_dec.h"
#include "executor/spi.h"
#include "funcapi.h"
#include "utils/builtins.h"
#include "utils/lsyscache.h"

#include "pg/base/sql_function.h"
#include "pg/mesh/reader.h"
#include "pg/mesh/shape.h"
#include "pg/sql/arguments/attribute.h"
#include "pg/sql/arguments/step_argument.h"
#include "pg/sql/draw/drawing.h"
#include "pg/steps/step.h"

SQL_FUNCTION(abacus_sql_tiles);

/* Arguments */
enum
{
	TILES_MESH,
	TILES_SRID,
	TILES_WORLD,
	TILES_ATTRIBUTE,
	TILES_RANGE,
	TILES_CONTOURS,
	TILES_RAMP,
	TILES_EXAGGERATION,
	TILES_EDGES,
	TILES_MAX_EDGE,
	TILES_SIZE,
	TILES_WITHIN,
	TILES_REGIONS,
	TILES_LINES,
	TILES_PIXEL_ERROR,
	TILES_STEP
};

/* The parts of the functions as SQL; what is not given is NULL. */
typedef struct Tiles
{
	ReturnSetInfo *set;
	const char *extension;		/* schema */
	const char *schema;			/* of the mesh */
	const char *name;			/* of the mesh */
	const char *mesh;
	const char *world;
	const char *attribute;
	const char *range;
	const char *contours;
	const char *ramp;
	const char *exaggeration;
	const char *edges;
	const char *max_edge;
	const char *within;
	const char *regions;
	const char *lines;
	const char *pixel_error;
	const char *step;
	bool		has_step;
	const char *srid;
	const char *fill;			/* the height outside the mesh */
	int32		size;
} Tiles;

static const char *
text_literal(FunctionCallInfo fcinfo, int argument)
{
	if (PG_ARGISNULL(argument))
		return "NULL::text";
	return quote_literal_cstr(text_to_cstring(PG_GETARG_TEXT_PP(argument)));
}

/* A number as text that reads back as the same number. */
static const char *
number_literal(double value)
{
	char		text[DOUBLE_SHORTEST_DECIMAL_LEN];

	double_to_shortest_decimal_buf(value, text);
	return psprintf("'%s'::float8", text);
}

static void
run(const char *command)
{
	int			status = SPI_execute(command, false, 0);

	if (status < 0)
		elog(ERROR, "could not run \"%s\": %s", command, SPI_result_code_string(status));
}

/* The least and the greatest value of the attribute, or of a step. */
static void
find_range(FunctionCallInfo fcinfo, int attribute, const Tiles *tiles, double *range)
{
	bool		isnull = true;

	if (!PG_ARGISNULL(TILES_STEP))
		isnull = !step_range(PG_GETARG_OID(TILES_MESH), PG_GETARG_INT64(TILES_STEP), attribute, range);
	else
		run(psprintf("SELECT least, greatest FROM %s.abacus_attributes(%s) WHERE name OPERATOR(pg_catalog.=) %s",
				 tiles->extension, tiles->mesh, tiles->attribute));
	for (int i = 0; PG_ARGISNULL(TILES_STEP) && i < 2 && SPI_processed == 1; i++)
	{
		Datum		value = SPI_getbinval(SPI_tuptable->vals[0], SPI_tuptable->tupdesc, i + 1,
										  &isnull);

		if (!isnull)
			range[i] = DatumGetFloat8(value);
	}
	if (isnull)
		ereport(ERROR,
				(errcode(ERRCODE_OBJECT_NOT_IN_PREREQUISITE_STATE),
				 errmsg("no vertex has a value for the attribute"),
				 errhint("Give the range of the colours.")));
	if (!(range[0] < range[1]))
		range[1] = range[0] + 1;
}

/* The range of the attribute, which has this number; its lower end is also the height where terrain ends. */
static void
set_range(FunctionCallInfo fcinfo, int attribute, Tiles *tiles)
{
	double		range[2];

	if (PG_ARGISNULL(TILES_RANGE))
		find_range(fcinfo, attribute, tiles, range);
	else
		shape_range(PG_GETARG_ARRAYTYPE_P(TILES_RANGE), "range", range);
	tiles->fill = number_literal(range[0]);
	tiles->range = psprintf("ARRAY[%s, %s]", tiles->fill, number_literal(range[1]));
}

static const char *
world_literal(FunctionCallInfo fcinfo)
{
	StringInfoData world;
	Datum	   *numbers;
	int			count;

	if (PG_ARGISNULL(TILES_WORLD))
		return "NULL::float8[]";
	numbers = shape_numbers(PG_GETARG_ARRAYTYPE_P(TILES_WORLD), "world", &count);
	initStringInfo(&world);
	for (int i = 0; i < count; i++)
		appendStringInfo(&world, "%s%s", i == 0 ? "ARRAY[" : ", ", number_literal(DatumGetFloat8(numbers[i])));
	appendStringInfoString(&world, count == 0 ? "'{}'::float8[]" : "]");
	return world.data;
}

/* Makes a function whose name ends like this, and adds it to the result. */
static void
make(const Tiles *tiles, const char *suffix, const char *type, const char *argument,
	 const char *returns, const char *body, const char *comment)
{
	char	   *name = psprintf("%s_%s", tiles->name, suffix);
	char	   *function;
	bool		isnull;
	Datum		value;

	if (strlen(name) >= NAMEDATALEN)
		ereport(ERROR,
				(errcode(ERRCODE_NAME_TOO_LONG),
				 errmsg("function name \"%s\" is too long", name),
				 errhint("Rename the mesh.")));
	function = quote_qualified_identifier(tiles->schema, name);
	run(psprintf("CREATE OR REPLACE FUNCTION %s(z integer, x integer, y integer, %s) RETURNS %s "
				 "LANGUAGE sql STABLE PARALLEL SAFE BEGIN ATOMIC SELECT %s; END",
				 function, argument, returns, body));
	function = psprintf("%s(integer, integer, integer, %s)", function, type);
	run(psprintf("COMMENT ON FUNCTION %s IS %s", function, quote_literal_cstr(comment)));
	run(psprintf("SELECT %s::regprocedure", quote_literal_cstr(function)));
	value = SPI_getbinval(SPI_tuptable->vals[0], SPI_tuptable->tupdesc, 1, &isnull);
	tuplestore_putvalues(tiles->set->setResult, tiles->set->setDesc, &value, &isnull);
}

/*
 * A function for Martin. The etag, which shows whether a tile has changed, consists of the mesh's
 * stamp and a hash of the function's body.
 */
static void
make_with_etag(const Tiles *tiles, const char *suffix, const char *body, const char *comment)
{
	uint32		hash = DatumGetUInt32(hash_any((const unsigned char *) body, (int) strlen(body)));

	make(tiles, suffix, "json", "query_params json DEFAULT '{}'", "TABLE (tile bytea, etag text)",
		 psprintf("%s, %s.abacus_tile_etag(%s, %s) || '-%08x'", body, tiles->extension, tiles->mesh,
				  tiles->step, hash),
		 comment);
}

static const char *
vector_body(const Tiles *tiles, const char *contours, const char *step)
{
	return psprintf("%s.abacus_tile_vector(%s, z, x, y, %s, %s, %s, %s, %s, %s, pixel_error => %s, step => %s)", tiles->extension,
					tiles->mesh, tiles->srid, tiles->world, tiles->attribute, contours, tiles->max_edge,
					tiles->within, tiles->pixel_error, step);
}

static void
make_all(Tiles *tiles, bool has_attribute)
{
	const char *own_step = tiles->step;
	const char *contours = "NULL::float8";
	const char *ramp = "NULL::text";
	const char *regions = psprintf("coalesce((query_params ->> 'regions')::boolean, %s)", tiles->regions);
	const char *lines = psprintf("coalesce((query_params ->> 'lines')::boolean, %s)", tiles->lines);

	/* functions of a step show others, if a request names one; of a mesh they know no values of steps */
	if (tiles->has_step)
		tiles->step = psprintf("coalesce((query_params ->> 'step')::bigint, %s)", own_step);
	if (has_attribute)
	{
		contours = psprintf("coalesce((query_params ->> 'contours')::float8, %s)", tiles->contours);
		ramp = psprintf("coalesce(query_params ->> 'ramp', %s)", tiles->ramp);
	}
	make_with_etag(tiles, "picture",
				   psprintf("%s.abacus_tile_picture(%s, z, x, y, %s, %s, %d, %s, %s, %s, %s, %s, %s, %s, %s, %s, %s, pixel_error => %s, step => %s)",
							tiles->extension, tiles->mesh, tiles->srid, tiles->world, tiles->size,
							tiles->attribute, tiles->range, tiles->edges, tiles->exaggeration,
							tiles->max_edge, ramp, contours, tiles->within, regions, lines, tiles->pixel_error, tiles->step),
				   "{\"content_type\": \"image/png\", \"description\": \"A mesh as pictures\"}");
	make_with_etag(tiles, "vector", vector_body(tiles, contours, tiles->step),
				   "{\"content_type\": \"application/x-protobuf\", \"description\": \"A mesh: triangles, vertices, contours, fixed, hull\"}");
	make(tiles, "mvt", "double precision",
		 psprintf("contours double precision DEFAULT %s", tiles->contours), "bytea",
		 vector_body(tiles, "contours", own_step), "A mesh: triangles, vertices, contours, fixed, hull");
	if (has_attribute)
		make_with_etag(tiles, "terrain",
					   psprintf("%s.abacus_tile_terrain(%s, z, x, y, %s, %s, %d, %s, %s, %s, %s, pixel_error => %s, step => %s)",
								tiles->extension, tiles->mesh, tiles->srid, tiles->world, tiles->size,
								tiles->attribute, tiles->max_edge, tiles->fill, tiles->within,
								tiles->pixel_error, tiles->step),
					   "{\"content_type\": \"image/png\", \"encoding\": \"terrarium\", \"description\": \"A mesh as heights\"}");
}

/* Draws a tile once, so that wrong arguments are reported now. */
static void
try_arguments(const Tiles *tiles)
{
	run(psprintf("SELECT %s.abacus_tile_picture(%s, 30, 0, 0, %s, %s, %d, %s, %s, %s, %s, %s, %s, %s, %s, %s, %s, pixel_error => %s, step => %s)",
				 tiles->extension, tiles->mesh, tiles->srid, tiles->world, tiles->size, tiles->attribute,
				 tiles->range, tiles->edges, tiles->exaggeration, tiles->max_edge, tiles->ramp,
				 tiles->contours, tiles->within, tiles->regions, tiles->lines, tiles->pixel_error, tiles->step));
}

/*
 * abacus_tiles(mesh regclass, srid int, world float8[], attribute text, range float8[],
 * contours float8, ramp text, exaggeration float8, edges boolean, max_edge float8,
 * size int, within text, regions boolean, lines boolean, pixel_error float8, step int8) -> setof regprocedure
 */
Datum
abacus_sql_tiles(PG_FUNCTION_ARGS)
{
	Tiles		tiles = {.set = (ReturnSetInfo *) fcinfo->resultinfo,.range = "NULL::float8[]"};
	Reader	   *reader;
	Oid			mesh;
	bool		has_attribute;
	int			attribute = -1;
	const char *numbers[4];
	const int	number[4] = {TILES_CONTOURS, TILES_EXAGGERATION, TILES_MAX_EDGE, TILES_PIXEL_ERROR};

	InitMaterializedSRF(fcinfo, MAT_SRF_USE_EXPECTED_DESC);
	if (PG_ARGISNULL(TILES_MESH))
		PG_RETURN_NULL();
	mesh = PG_GETARG_OID(TILES_MESH);
	reader = reader_open(mesh, CurrentMemoryContext);
	header_require_dimension(&reader->header.facts.form, 2, "Use a mesh in the plane.");
	step_argument(fcinfo, TILES_STEP, reader);
	has_attribute = reader->header.facts.columns.attributes > 0;
	tiles.attribute = text_literal(fcinfo, TILES_ATTRIBUTE);
	if (has_attribute)
	{
		attribute = (int) attribute_argument(fcinfo, TILES_ATTRIBUTE, abacus_names_of(&reader->header));
		tiles.attribute = quote_literal_cstr(reader->header.names[attribute]);
	}
	host_release(reader->host);
	host_destroy(reader->host);
	for (int i = 0; i < lengthof(number); i++)
		numbers[i] = PG_ARGISNULL(number[i]) ? "NULL::float8" :
			number_literal(PG_GETARG_FLOAT8(number[i]));
	tiles.contours = numbers[0];
	tiles.exaggeration = numbers[1];
	tiles.max_edge = numbers[2];
	tiles.pixel_error = numbers[3];
	tiles.has_step = !PG_ARGISNULL(TILES_STEP);
	tiles.step = !tiles.has_step ? "NULL::bigint" :
		psprintf("'" INT64_FORMAT "'::bigint", PG_GETARG_INT64(TILES_STEP));
	tiles.extension = quote_identifier(get_namespace_name(get_func_namespace(fcinfo->flinfo->fn_oid)));
	tiles.schema = get_namespace_name(get_rel_namespace(mesh));
	tiles.name = get_rel_name(mesh);
	tiles.mesh = psprintf("%s::regclass",
						  quote_literal_cstr(quote_qualified_identifier(tiles.schema, tiles.name)));
	tiles.world = world_literal(fcinfo);
	tiles.ramp = text_literal(fcinfo, TILES_RAMP);
	tiles.within = text_literal(fcinfo, TILES_WITHIN);
	tiles.regions = !PG_ARGISNULL(TILES_REGIONS) && PG_GETARG_BOOL(TILES_REGIONS) ? "true" : "false";
	tiles.lines = !PG_ARGISNULL(TILES_LINES) && PG_GETARG_BOOL(TILES_LINES) ? "true" : "false";
	tiles.edges = PG_ARGISNULL(TILES_EDGES) || PG_GETARG_BOOL(TILES_EDGES) ? "true" : "false";
	tiles.srid = PG_ARGISNULL(TILES_SRID) ? "NULL::integer" :
		psprintf("%d", PG_GETARG_INT32(TILES_SRID));
	tiles.size = PG_ARGISNULL(TILES_SIZE) ? 256 : PG_GETARG_INT32(TILES_SIZE);

	SPI_connect();
	if (has_attribute)
		set_range(fcinfo, attribute, &tiles);
	try_arguments(&tiles);
	make_all(&tiles, has_attribute);
	SPI_finish();
	PG_RETURN_NULL();
}
