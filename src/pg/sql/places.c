/*
 * places.c: the places of a query, read for a function that answers all of
 * them.
 *
 * All places are read before the first is answered, for they are brought into
 * the order of the curve; so the rows go into a tuplestore, as those of a
 * function in FROM do anyway. The session's cache has no part in it: the core
 * looks for all places of a page together, and keeps none.
 */
#include "postgres.h"

#include "pg/base/settings.h"
#include "pg/sql/places.h"

/* Opens the mesh and reads the places; shows as progress until places_done(). */
void
places_read(PlacesRead *read, Oid mesh, const char *query)
{
	Reader	   *reader;
	Host	   *host;
	const uint64 *records;
	size_t		count;

	source_prepare(&read->source, query);
	reader = reader_open(mesh, CurrentMemoryContext);
	read->host = host = reader->host;
	read->dimension = reader->header.dimension;
	read->places = NULL;

	progress_begin(&host->progress, mesh);
	host_run(host, abacus_places_open, &host->table, &reader->header, setting_query_sort_bytes(),
			 setting_cache_bytes(), &read->places);
	host_own(host, read->places, (void (*) (void *)) abacus_places_close);
	source_open_places(&read->source, &reader->header);
	while ((count = source_fetch(&read->source, &records)) > 0)
		host_run(host, abacus_places_add, read->places, records, count);
	source_close(&read->source);
}

/* Ends the reading. */
void
places_done(PlacesRead *read)
{
	progress_end(&read->host->progress);
	host_release(read->host);
	host_destroy(read->host);
	source_finish(&read->source);
}
