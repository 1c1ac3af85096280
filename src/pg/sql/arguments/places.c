/*
 * places.c: reads the places of a query, for a function that answers all of them.
 *
 * All places are read before the first is answered, since they are sorted along the curve. So the
 * rows go into a tuplestore, as those of a function in FROM do anyway. The session's cache is not
 * used: the core answers all places of a page together, and keeps none.
 */
#include "postgres.h"

#include "pg/base/settings.h"
#include "pg/sql/arguments/places.h"

/* Opens the mesh or octree; shows as progress until places_done(). */
void
places_open(PlacesRead *read, Oid mesh, uint32 type, const char *query)
{
	Reader	   *reader;

	source_prepare(&read->source, query);
	reader = reader_open_of(mesh, type, CurrentMemoryContext);
	read->reader = reader;
	read->host = reader->host;
	read->dimension = reader->header.facts.form.dimension;
	read->names = abacus_names_of(&reader->header);
	read->places = NULL;
	read->octants = NULL;
	read->count = 0;
	progress_begin(&read->host->progress, mesh);
}

static void
begin_places(PlacesRead *read)
{
	Host	   *host = read->host;

	host_run(host, abacus_places_open, &host->table, read->names.facts, setting_query_sort_bytes(),
			 setting_cache_bytes(), &read->places);
	host_own(host, read->places, (void (*) (void *)) abacus_places_close);
	source_open_places(&read->source, read->names);
}

static void
begin_octants(PlacesRead *read)
{
	Host	   *host = read->host;

	host_run(host, abacus_octree_places_open, &host->table, read->names.facts,
			 setting_query_sort_bytes(), setting_cache_bytes(), &read->octants);
	host_own(host, read->octants, (void (*) (void *)) abacus_octree_places_close);
	source_open_octants(&read->source, read->names, OCTANT_POINTS, false);
}

/* Reads the places. */
void
places_fetch(PlacesRead *read)
{
	const uint64 *records;
	size_t		count;

	if (read->names.facts->form.type == ABACUS_OCTREE)
		begin_octants(read);
	else
		begin_places(read);
	while ((count = source_fetch(&read->source, &records)) > 0)
	{
		read->count += count;
		if (read->octants != NULL)
			host_run(read->host, abacus_octree_places_add, read->octants, records, count);
		else
			host_run(read->host, abacus_places_add, read->places, records, count);
	}
	source_close(&read->source);
}

void
places_read(PlacesRead *read, Oid mesh, uint32 type, const char *query)
{
	places_open(read, mesh, type, query);
	places_fetch(read);
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
