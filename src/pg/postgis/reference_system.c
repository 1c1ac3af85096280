/*
 * reference_system.c: the facts about a spatial reference system, by its number.
 *
 * The table spatial_ref_sys of PostGIS describes it. Without PostGIS, or without the right to read
 * that table, only some EPSG numbers are known: those of the systems in which most data in
 * longitude and latitude is published.
 */
#include "postgres.h"

#include "access/htup_details.h"
#include "catalog/pg_class.h"
#include "catalog/pg_type.h"
#include "executor/spi.h"
#include "miscadmin.h"
#include "utils/acl.h"
#include "utils/builtins.h"
#include "utils/lsyscache.h"
#include "utils/syscache.h"

#include "pg/postgis/catalogue.h"
#include "pg/postgis/reference_system.h"

#define REFERENCE_SYSTEMS "spatial_ref_sys"

static bool
is_well_known(int32 srid)
{
	static const int32 geographic[] = {
		4019,					/* GRS 1980 */
		4148,					/* Hartebeesthoek94 */
		4152,					/* NAD83(HARN) */
		4167,					/* NZGD2000 */
		4171,					/* RGF93 */
		4230,					/* ED50 */
		4258,					/* ETRS89 */
		4267,					/* NAD27 */
		4269,					/* NAD83 */
		4277,					/* OSGB36 */
		4283,					/* GDA94 */
		4314,					/* DHDN */
		4322,					/* WGS 72 */
		4326,					/* WGS 84 */
		4490,					/* CGCS2000 */
		4612,					/* JGD2000 */
		4617,					/* NAD83(CSRS) */
		4674,					/* SIRGAS 2000 */
		4759,					/* NAD83(NSRS2007) */
		4937,					/* ETRS89, with heights */
		4979,					/* WGS 84, with heights */
		6318,					/* NAD83(2011) */
		6668,					/* JGD2011 */
		7844					/* GDA2020 */
	};

	for (int i = 0; i < (int) lengthof(geographic); i++)
		if (geographic[i] == srid)
			return true;
	return false;
}

static Oid
schema_of_type(Oid type)
{
	HeapTuple	tuple = SearchSysCache1(TYPEOID, ObjectIdGetDatum(type));
	Oid			schema;

	if (!HeapTupleIsValid(tuple))
		elog(ERROR, "cache lookup failed for type %u", type);
	schema = ((Form_pg_type) GETSTRUCT(tuple))->typnamespace;
	ReleaseSysCache(tuple);
	return schema;
}

/* The name of the table of systems, if the user may read it, otherwise NULL. */
static char *
readable_table(void)
{
	Oid			type = postgis_geometry();
	Oid			schema;
	Oid			table;

	if (!OidIsValid(type))
		return NULL;
	schema = schema_of_type(type);
	table = get_relname_relid(REFERENCE_SYSTEMS, schema);
	if (!OidIsValid(table) || !postgis_owns(RelationRelationId, table) ||
		get_rel_relkind(table) != RELKIND_RELATION ||
		pg_class_aclcheck(table, GetUserId(), ACL_SELECT) != ACLCHECK_OK)
		return NULL;
	return quote_qualified_identifier(get_namespace_name(schema), REFERENCE_SYSTEMS);
}

/* Whether the coordinates of a system are longitude and latitude, in degrees. */
bool
reference_system_is_geographic(int32 srid)
{
	Oid			types[] = {INT4OID};
	Datum		values[] = {Int32GetDatum(srid)};
	char	   *table;
	bool		found;

	if (is_well_known(srid))
		return true;
	table = readable_table();
	if (table == NULL)
		return false;
	SPI_connect();
	if (SPI_execute_with_args(psprintf("SELECT 1 FROM %s WHERE srid OPERATOR(pg_catalog.=) $1 AND "
									   "(pg_catalog.starts_with(srtext, 'GEOGC') OR "
									   "pg_catalog.strpos(proj4text, '+proj=longlat') OPERATOR(pg_catalog.>) 0)",
									   table),
							  1, types, values, NULL, true, 1) != SPI_OK_SELECT)
		elog(ERROR, "could not read %s", table);
	found = SPI_processed > 0;
	SPI_finish();
	return found;
}
