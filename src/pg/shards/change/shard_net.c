/*
 * shard_net.c: the simplices that a change has created and removed, over all of its steps.
 *
 * A shard inserts points, and later guests: what it has created then may go again. So all rows are sorted by what
 * distinguishes simplices, within work_mem and beyond it in files, and those of one simplex are added up.
 */
#include "postgres.h"

#include "executor/tuptable.h"
#include "funcapi.h"
#include "miscadmin.h"
#include "utils/datum.h"
#include "utils/tuplesort.h"
#include "utils/tuplestore.h"
#include "utils/typcache.h"

#include "pg/shards/change/shard_net.h"

/* Columns of the rows: the first says whether the simplex was created, the others distinguish it. */
#define COLUMNS 7

struct ShardNet
{
	ReturnSetInfo *set;
	Tuplesortstate *sort;
	TupleTableSlot *slot;
	Datum		values[COLUMNS];	/* of the simplex that is added up */
	bool		isnull[COLUMNS];
	int			sum;			/* times created, less times removed */
};

ShardNet *
shard_net_begin(ReturnSetInfo *set)
{
	ShardNet   *net = palloc0(sizeof(ShardNet));
	TupleDesc	desc = set->setDesc;
	AttrNumber	columns[COLUMNS - 1];
	Oid			operators[COLUMNS - 1];
	Oid			collations[COLUMNS - 1] = {0};
	bool		nulls_first[COLUMNS - 1] = {false};

	if (desc->natts != COLUMNS)
		elog(ERROR, "simplices have %d columns", desc->natts);
	for (int i = 0; i < COLUMNS - 1; i++)
	{
		columns[i] = (AttrNumber) (i + 2);
		operators[i] = lookup_type_cache(TupleDescAttr(desc, i + 1)->atttypid, TYPECACHE_LT_OPR)->lt_opr;
	}
	net->set = set;
	net->sort = tuplesort_begin_heap(desc, COLUMNS - 1, columns, operators, collations, nulls_first, work_mem, NULL,
									 TUPLESORT_NONE);
	net->slot = MakeSingleTupleTableSlot(desc, &TTSOpsVirtual);
	return net;
}

void
shard_net_add(ShardNet *net, Datum *values, bool *isnull)
{
	ExecClearTuple(net->slot);
	memcpy(net->slot->tts_values, values, COLUMNS * sizeof(Datum));
	memcpy(net->slot->tts_isnull, isnull, COLUMNS * sizeof(bool));
	ExecStoreVirtualTuple(net->slot);
	tuplesort_puttupleslot(net->sort, net->slot);
	ExecClearTuple(net->slot);
}

static void
put_simplex(ShardNet *net)
{
	if (net->sum == 0)
		return;
	net->values[0] = BoolGetDatum(net->sum > 0);
	net->isnull[0] = false;
	tuplestore_putvalues(net->set->setResult, net->set->setDesc, net->values, net->isnull);
}

static bool
is_same(const ShardNet *net, const TupleTableSlot *slot)
{
	for (int i = 1; i < COLUMNS; i++)
	{
		Form_pg_attribute column = TupleDescAttr(net->set->setDesc, i);

		if (net->isnull[i] != slot->tts_isnull[i] ||
			(!net->isnull[i] && !datum_image_eq(net->values[i], slot->tts_values[i], column->attbyval, column->attlen)))
			return false;
	}
	return true;
}

/* Adds the rows to the result. */
void
shard_net_end(ShardNet *net)
{
	TupleTableSlot *slot = MakeSingleTupleTableSlot(net->set->setDesc, &TTSOpsMinimalTuple);
	bool		any = false;

	tuplesort_performsort(net->sort);
	while (tuplesort_gettupleslot(net->sort, true, false, slot, NULL))
	{
		CHECK_FOR_INTERRUPTS();
		slot_getallattrs(slot);
		if (!any || !is_same(net, slot))
		{
			put_simplex(net);
			if (any && !net->isnull[COLUMNS - 1])
				pfree(DatumGetPointer(net->values[COLUMNS - 1]));
			for (int i = 1; i < COLUMNS; i++)
			{
				Form_pg_attribute column = TupleDescAttr(net->set->setDesc, i);

				net->isnull[i] = slot->tts_isnull[i];
				net->values[i] = net->isnull[i] ? (Datum) 0 : datumCopy(slot->tts_values[i], column->attbyval, column->attlen);
			}
			net->sum = 0;
			any = true;
		}
		net->sum += DatumGetBool(slot->tts_values[0]) ? 1 : -1;
	}
	put_simplex(net);
	ExecDropSingleTupleTableSlot(slot);
	ExecDropSingleTupleTableSlot(net->slot);
	tuplesort_end(net->sort);
}
