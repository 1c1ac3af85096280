/*
 * octree_places.c: the places of a query, read for a function that answers all
 * of them from an octree; as places.c does for meshes.
 */
#include "postgres.h"

#include "pg/base/settings.h"
#include "pg/sql/octree_places.h"

/* Opens the octree; shows as progress until octree_places_done(). */
void
octree_places_open(OctreePlaces *read, Oid octree, const char *query)
{
	source_prepare(&read->source, query);
	read->reader = reader_open_of(octree, ABACUS_OCTREE, CurrentMemoryContext);
	read->places = NULL;
	progress_begin(&read->reader->host->progress, octree);
}

/* Reads the places. */
void
octree_places_fetch(OctreePlaces *read)
{
	Host	   *host = read->reader->host;
	const uint64 *records;
	size_t		count;

	host_run(host, abacus_octree_places_open, &host->table, &read->reader->header,
			 setting_query_sort_bytes(), setting_cache_bytes(), &read->places);
	host_own(host, read->places, (void (*) (void *)) abacus_octree_places_close);
	source_open_octants(&read->source, &read->reader->header, OCTANT_POINTS, false);
	while ((count = source_fetch(&read->source, &records)) > 0)
		host_run(host, abacus_octree_places_add, read->places, records, count);
	source_close(&read->source);
}

/* Ends the reading. */
void
octree_places_done(OctreePlaces *read)
{
	Host	   *host = read->reader->host;

	progress_end(&host->progress);
	host_release(host);
	host_destroy(host);
	source_finish(&read->source);
}
