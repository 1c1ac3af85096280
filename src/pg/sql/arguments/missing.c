/*
 * missing.c: explains why an answer about values is empty.
 */
#include "postgres.h"

#include <math.h>

#include "abacus/windows.h"
#include "pg/base/settings.h"
#include "pg/sql/arguments/missing.h"

/*
 * For an answer without rows: a NOTICE if no vertex of the mesh has a value. The heads of the
 * columns show that, so no page without a value is decoded.
 */
void
notice_missing_values(Reader *reader, uint32 attribute)
{
	Host	   *host = reader->host;
	const abacus_window whole = {.kind = ABACUS_NO_WINDOW};
	const abacus_range any = {.attribute = attribute, .least = -INFINITY, .greatest = INFINITY};
	abacus_faces *vertices = NULL;
	abacus_vertex vertex;
	abacus_status status;

	if (reader->header.facts.census.vertices == 0)
		return;
	host_run(host, abacus_faces_open_range, &host->table, &reader->header.facts, &whole, &any,
			 setting_cache_bytes(), &vertices);
	host_own(host, vertices, (void (*) (void *)) abacus_faces_close);
	status = host_run(host, abacus_faces_next_vertex, vertices, &vertex);
	if (status == ABACUS_END)
		ereport(NOTICE,
				(errmsg("attribute \"%s\" has no value", reader->header.names[attribute]),
				 errhint("abacus_attributes() shows which attributes have values.")));
}
