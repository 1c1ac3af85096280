/*
 * exports_row.h: vertices that other shards need, as rows.
 */
#ifndef ABACUS_EXPORTS_ROW_H
#define ABACUS_EXPORTS_ROW_H

#include "fmgr.h"

#include "abacus/shards.h"
#include "pg/mesh/reader.h"

enum
{
	EXPORT_SHARD,
	EXPORT_ID,
	EXPORT_X,
	EXPORT_ATTRIBUTES = EXPORT_X + ABACUS_MAX_DIMENSION,
	EXPORT_COLUMNS
};

extern abacus_exports *exports_open(FunctionCallInfo fcinfo, Reader *reader);
extern void export_columns(uint32 shard, const abacus_vertex *vertex, const abacus_facts *facts, Datum *values,
						   bool *isnull);

#endif
