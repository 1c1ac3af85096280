/*
 * fn_attributes.c: abacus_attributes and abacus_rename_attribute, the attributes
 * of a mesh or an octree and their names.
 *
 * The names are in the header. The values are only in the points or the leaves, so all of these are
 * read.
 */
#include "postgres.h"

#include <math.h>

#include "funcapi.h"
#include "utils/builtins.h"

#include "abacus/octree.h"
#include "abacus/scan.h"
#include "abacus/windows.h"
#include "pg/base/settings.h"
#include "pg/base/sql_function.h"
#include "pg/mesh/reader.h"
#include "pg/mesh/shape.h"
#include "pg/mesh/writer.h"

SQL_FUNCTION(abacus_sql_attributes);
SQL_FUNCTION(abacus_sql_rename_attribute);

/* Columns of abacus_attributes */
enum
{
	ATTRIBUTE_POSITION,
	ATTRIBUTE_NAME,
	ATTRIBUTE_LEAST,
	ATTRIBUTE_GREATEST,
	ATTRIBUTE_NULLS,
	ATTRIBUTE_COLUMNS
};

/* The values of one attribute; least and greatest are NaN if there are none. */
typedef struct Values
{
	double		least;
	double		greatest;
	int64		nulls;
} Values;

static void
count_value(Values *values, double value)
{
	if (isnan(value))
		values->nulls++;
	else
	{
		values->least = fmin(values->least, value); /* fmin() of a NaN and a number is the number */
		values->greatest = fmax(values->greatest, value);
	}
}

/* Reads all points. */
static void
read_values(Reader *reader, Values *values)
{
	Host	   *host = reader->host;
	uint32		attributes = reader->header.facts.columns.attributes;
	abacus_vertex_scan *scan = NULL;
	abacus_vertex vertex;

	for (uint32 i = 0; i < attributes; i++)
		values[i] = (Values) {NAN, NAN, 0};
	header_open_vertices(host, &reader->header.facts);
	host_run(host, abacus_vertex_scan_open, &host->table, &reader->header.facts, setting_cache_bytes(),
			 &scan);
	host_own(host, scan, (void (*) (void *)) abacus_vertex_scan_close);
	while (host_run(host, abacus_vertex_scan_next, scan, &vertex) == ABACUS_OK)
		for (uint32 i = 0; i < attributes; i++)
			count_value(&values[i], vertex.attributes[i]);
}

/* The same for an octree: reads all leaves. */
static void
read_octree_values(Reader *reader, Values *values)
{
	Host	   *host = reader->host;
	uint32		attributes = reader->header.facts.columns.attributes;
	abacus_window all = {0};
	abacus_octree_scan *scan = NULL;
	abacus_octant octant;

	for (uint32 i = 0; i < attributes; i++)
		values[i] = (Values) {NAN, NAN, 0};
	host_run(host, abacus_octree_scan_open, &host->table, &reader->header.facts, &all,
			 setting_cache_bytes(), &scan);
	host_own(host, scan, (void (*) (void *)) abacus_octree_scan_close);
	while (host_run(host, abacus_octree_scan_next, scan, &octant) == ABACUS_OK)
		for (uint32 i = 0; i < attributes; i++)
			count_value(&values[i], octant.values[i]);
}

/* abacus_attributes(mesh regclass) -> position, name, least, greatest, nulls */
Datum
abacus_sql_attributes(PG_FUNCTION_ARGS)
{
	ReturnSetInfo *set = (ReturnSetInfo *) fcinfo->resultinfo;
	Reader	   *reader;
	Values	   *all;

	InitMaterializedSRF(fcinfo, 0);
	reader = reader_open_of(PG_GETARG_OID(0), ANY_TYPE, CurrentMemoryContext);
	all = palloc(Max(1, reader->header.facts.columns.attributes) * sizeof(Values));
	if (reader->header.facts.columns.attributes > 0 && reader->header.facts.form.type == ABACUS_OCTREE)
		read_octree_values(reader, all);
	else if (reader->header.facts.columns.attributes > 0)
		read_values(reader, all);
	for (uint32 i = 0; i < reader->header.facts.columns.attributes; i++)
	{
		Datum		values[ATTRIBUTE_COLUMNS];
		bool		isnull[ATTRIBUTE_COLUMNS] = {false};

		values[ATTRIBUTE_POSITION] = Int32GetDatum((int32) i + 1);
		values[ATTRIBUTE_NAME] = CStringGetTextDatum(reader->header.names[i]);
		values[ATTRIBUTE_LEAST] = Float8GetDatum(all[i].least);
		values[ATTRIBUTE_GREATEST] = Float8GetDatum(all[i].greatest);
		values[ATTRIBUTE_NULLS] = Int64GetDatum(all[i].nulls);
		isnull[ATTRIBUTE_LEAST] = isnull[ATTRIBUTE_GREATEST] = isnan(all[i].least) != 0;
		tuplestore_putvalues(set->setResult, set->setDesc, values, isnull);
	}
	host_release(reader->host);
	host_destroy(reader->host);
	PG_RETURN_NULL();
}

/* abacus_rename_attribute(mesh regclass, attribute text, name text) */
Datum
abacus_sql_rename_attribute(PG_FUNCTION_ARGS)
{
	char	   *attribute = text_to_cstring(PG_GETARG_TEXT_PP(1));
	char	   *name = text_to_cstring(PG_GETARG_TEXT_PP(2));
	Writer		writer;
	abacus_header *header;
	int			number;

	shape_check_name(name);
	writer_begin_of(&writer, PG_GETARG_OID(0), ANY_TYPE, "abacus_rename_attribute()");
	header = writer.header;
	number = header_find_attribute(abacus_names_of(header), attribute);
	header_require_new_name(abacus_names_of(header), name);
	strlcpy(header->names[number], name, ABACUS_NAME_BYTES);
	writer_end(&writer);
	PG_RETURN_VOID();
}
