/*
 * fn_octree_nodes.c: abacus_octree_nodes, abacus_octree_elements and abacus_octree_tetrahedra, an
 * octree as input of a solver.
 */
#include "postgres.h"

#include "access/htup_details.h"
#include "catalog/pg_type.h"
#include "funcapi.h"
#include "utils/array.h"

#include "abacus/octree.h"
#include "pg/base/settings.h"
#include "pg/base/sql_function.h"
#include "pg/sql/rows/result.h"
#include "pg/sql/rows/set.h"

SQL_FUNCTION(abacus_sql_octree_nodes);
SQL_FUNCTION(abacus_sql_octree_elements);
SQL_FUNCTION(abacus_sql_octree_tetrahedra);

static Datum
number_array(const uint64 *numbers, int count)
{
	Datum		elements[1 << ABACUS_MAX_DIMENSION];

	for (int i = 0; i < count; i++)
		elements[i] = Int64GetDatum((int64) numbers[i]);
	return PointerGetDatum(construct_array(elements, count, INT8OID, sizeof(int64),
										   FLOAT8PASSBYVAL, TYPALIGN_DOUBLE));
}

static void
begin_nodes(FunctionCallInfo fcinfo, FuncCallContext *set)
{
	Reader	   *reader = set_begin_of(fcinfo, set, ABACUS_OCTREE, result_row_type);
	Host	   *host = reader->host;
	abacus_octree_nodes *nodes = NULL;

	host_run(host, abacus_octree_nodes_open, &host->table, &reader->header.facts,
			 setting_query_sort_bytes(), &nodes);
	host_own(host, nodes, (void (*) (void *)) abacus_octree_nodes_close);
}

static void
begin_elements(FunctionCallInfo fcinfo, FuncCallContext *set)
{
	Reader	   *reader = set_begin_of(fcinfo, set, ABACUS_OCTREE, result_row_type);
	Host	   *host = reader->host;
	abacus_octree_elements *elements = NULL;

	host_run(host, abacus_octree_elements_open, &host->table, &reader->header.facts,
			 setting_query_sort_bytes(), &elements);
	host_own(host, elements, (void (*) (void *)) abacus_octree_elements_close);
}

static void
begin_tetrahedra(FunctionCallInfo fcinfo, FuncCallContext *set)
{
	Reader	   *reader = set_begin_of(fcinfo, set, ABACUS_OCTREE, result_row_type);
	Host	   *host = reader->host;
	abacus_octree_simplices *simplices = NULL;

	host_run(host, abacus_octree_simplices_open, &host->table, &reader->header.facts,
			 setting_query_sort_bytes(), &simplices);
	host_own(host, simplices, (void (*) (void *)) abacus_octree_simplices_close);
}

/* abacus_octree_nodes(octree regclass) -> node, point, anchors */
Datum
abacus_sql_octree_nodes(PG_FUNCTION_ARGS)
{
	FuncCallContext *set;
	Reader	   *reader;
	abacus_octree_node node;
	Datum		values[3];
	bool		isnull[3] = {false};
	abacus_status status;

	if (SRF_IS_FIRSTCALL())
		begin_nodes(fcinfo, SRF_FIRSTCALL_INIT());
	set = SRF_PERCALL_SETUP();
	reader = set->user_fctx;
	status = host_run(reader->host, abacus_octree_nodes_next, reader->host->handle, &node);
	host_release(reader->host);
	if (status == ABACUS_END)
		SRF_RETURN_DONE(set);
	values[0] = Int64GetDatum((int64) node.number);
	values[1] = attribute_array(node.point, (int) reader->header.facts.form.dimension);
	isnull[2] = node.anchors == 0;
	values[2] = isnull[2] ? (Datum) 0 : number_array(node.anchor, node.anchors);
	SRF_RETURN_NEXT(set, HeapTupleGetDatum(heap_form_tuple(set->tuple_desc, values, isnull)));
}

/* abacus_octree_elements(octree regclass) -> element, nodes, code, level, attributes */
Datum
abacus_sql_octree_elements(PG_FUNCTION_ARGS)
{
	FuncCallContext *set;
	Reader	   *reader;
	abacus_octant octant;
	uint64		corners[1 << ABACUS_MAX_DIMENSION];
	Datum		values[5];
	bool		isnull[5] = {false};
	abacus_status status;

	if (SRF_IS_FIRSTCALL())
		begin_elements(fcinfo, SRF_FIRSTCALL_INIT());
	set = SRF_PERCALL_SETUP();
	reader = set->user_fctx;
	status = host_run(reader->host, abacus_octree_elements_next, reader->host->handle, &octant,
					  corners);
	host_release(reader->host);
	if (status == ABACUS_END)
		SRF_RETURN_DONE(set);
	values[0] = Int64GetDatum((int64) set->call_cntr);
	values[1] = number_array(corners, 1 << reader->header.facts.form.dimension);
	values[2] = Int64GetDatum((int64) octant.code);
	values[3] = Int32GetDatum(octant.level);
	values[4] = attribute_array(octant.values, (int) reader->header.facts.columns.attributes);
	SRF_RETURN_NEXT(set, HeapTupleGetDatum(heap_form_tuple(set->tuple_desc, values, isnull)));
}

/* abacus_octree_tetrahedra(octree regclass) -> element, nodes */
Datum
abacus_sql_octree_tetrahedra(PG_FUNCTION_ARGS)
{
	FuncCallContext *set;
	Reader	   *reader;
	uint64		element;
	uint64		nodes[ABACUS_MAX_DIMENSION + 1];
	Datum		values[2];
	bool		isnull[2] = {false};
	abacus_status status;

	if (SRF_IS_FIRSTCALL())
		begin_tetrahedra(fcinfo, SRF_FIRSTCALL_INIT());
	set = SRF_PERCALL_SETUP();
	reader = set->user_fctx;
	status = host_run(reader->host, abacus_octree_simplices_next, reader->host->handle, &element,
					  nodes);
	host_release(reader->host);
	if (status == ABACUS_END)
		SRF_RETURN_DONE(set);
	values[0] = Int64GetDatum((int64) element);
	values[1] = number_array(nodes, (int) reader->header.facts.form.dimension + 1);
	SRF_RETURN_NEXT(set, HeapTupleGetDatum(heap_form_tuple(set->tuple_desc, values, isnull)));
}
