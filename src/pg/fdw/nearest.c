/*
 * nearest.c: the points of a mesh, the nearest to a place first.
 *
 * The number of wanted points is unknown, since conditions may drop some. So at first the query's
 * limit says how many to look for. When these are used up, the next search looks for four times as
 * many and skips the earlier ones. That takes a third more time than knowing the number. Rows wait
 * in a tuple store, which keeps to work_mem.
 */
#include "postgres.h"

#include "executor/tuptable.h"
#include "miscadmin.h"
#include "utils/memutils.h"
#include "utils/tuplestore.h"

#include "abacus/locate.h"
#include "pg/fdw/nearest.h"
#include "pg/host/guard.h"
#include "pg/mesh/mesh_cache.h"

#define GROWTH 4

struct Nearest
{
	Oid			mesh;
	Oid			user;
	double		place[ABACUS_MAX_DIMENSION];
	uint64		wanted;			/* ranks to look for next */
	uint64		known;			/* ranks found */
	bool		is_all;
	NearestRow	row;
	void	   *context;
	Host	   *host;			/* while the core runs */
	MemoryContext memory;
	MemoryContext row_memory;
	TupleDesc	type;
	TupleTableSlot *slot;
	Tuplestorestate *rows;		/* NULL: none yet */
};

/* `first`: how many to look for at first. */
Nearest *
nearest_begin(Relation table, Oid mesh, Oid user, const double *place, uint64 first,
			  NearestRow row, void *context, MemoryContext parent)
{
	MemoryContext memory = AllocSetContextCreate(parent, "Abacus nearest", ALLOCSET_SMALL_SIZES);
	MemoryContext old = MemoryContextSwitchTo(memory);
	Nearest    *nearest = palloc0(sizeof(Nearest));

	nearest->mesh = mesh;
	nearest->user = user;
	memcpy(nearest->place, place, 2 * sizeof(double));
	nearest->wanted = Max(1, first);
	nearest->row = row;
	nearest->context = context;
	nearest->memory = memory;
	nearest->row_memory = AllocSetContextCreate(memory, "Abacus row", ALLOCSET_SMALL_SIZES);
	nearest->type = CreateTupleDescCopy(RelationGetDescr(table));
	nearest->slot = MakeSingleTupleTableSlot(nearest->type, &TTSOpsMinimalTuple);
	MemoryContextSwitchTo(old);
	return nearest;
}

static void
keep(Nearest *nearest, const abacus_vertex *vertex)
{
	MemoryContext old = MemoryContextSwitchTo(nearest->row_memory);
	Datum	   *values = palloc(nearest->type->natts * sizeof(Datum));
	bool	   *isnull = palloc(nearest->type->natts * sizeof(bool));

	nearest->row(nearest->context, vertex, values, isnull);
	MemoryContextSwitchTo(nearest->memory);
	tuplestore_putvalues(nearest->rows, nearest->type, values, isnull);
	MemoryContextSwitchTo(old);
	MemoryContextReset(nearest->row_memory);
}

/* Keeps a vertex unless it was there before; called by the core. */
static abacus_host_status
put(void *context, int64_t place, uint64_t rank, const abacus_vertex *vertex, double distance)
{
	Nearest    *nearest = context;

	if (rank <= nearest->known)
		return ABACUS_HOST_OK;
	GUARD_BEGIN();
	keep(nearest, vertex);
	GUARD_END(nearest->host);
	nearest->known = rank;
	return ABACUS_HOST_OK;
}

/* Looks for the next points. */
static void
look(Nearest *nearest)
{
	MemoryContext old = MemoryContextSwitchTo(nearest->memory);
	uint64		before = nearest->known;
	CachedMesh *cached;
	Oid			caller;
	int			context;

	if (nearest->rows != NULL)
		tuplestore_end(nearest->rows);
	nearest->rows = NULL;
	nearest->rows = tuplestore_begin_heap(false, false, work_mem);
	GetUserIdAndSecContext(&caller, &context);
	SetUserIdAndSecContext(nearest->user, context | SECURITY_LOCAL_USERID_CHANGE);
	cached = mesh_cache_get(nearest->mesh);
	SetUserIdAndSecContext(caller, context);
	nearest->host = cached->host;
	host_run(cached->host, abacus_mesh_nearest, cached->mesh, nearest->place, nearest->wanted, put,
			 nearest);
	host_release(cached->host);
	nearest->is_all = nearest->known < nearest->wanted || nearest->known == before;
	nearest->wanted = nearest->wanted > PG_UINT64_MAX / GROWTH ? PG_UINT64_MAX
		: nearest->wanted * GROWTH;
	MemoryContextSwitchTo(old);
}

/* The next row, whose values are valid until the one after it; false after the last. */
bool
nearest_next(Nearest *nearest, Datum *values, bool *isnull)
{
	while (nearest->rows == NULL ||
		   !tuplestore_gettupleslot(nearest->rows, true, false, nearest->slot))
	{
		if (nearest->is_all)
			return false;
		look(nearest);
	}
	slot_getallattrs(nearest->slot);
	memcpy(values, nearest->slot->tts_values, nearest->type->natts * sizeof(Datum));
	memcpy(isnull, nearest->slot->tts_isnull, nearest->type->natts * sizeof(bool));
	return true;
}

void
nearest_end(Nearest *nearest)
{
	ExecClearTuple(nearest->slot);
	if (nearest->rows != NULL)
		tuplestore_end(nearest->rows);
	MemoryContextDelete(nearest->memory);
}
