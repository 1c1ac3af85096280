/*
 * row_packer.h: packs rows from the executor into the core's records of points, or of simplices.
 */
#ifndef ABACUS_ROW_PACKER_H
#define ABACUS_ROW_PACKER_H

#include "abacus/mesh_header.h"
#include "pg/postgis/catalogue.h"
#include "tcop/dest.h"

/* How a column's Datum becomes an eight-byte word. */
typedef enum PackKind
{
	PACK_FLOAT8,
	PACK_FLOAT4,
	PACK_INT2,
	PACK_INT4,
	PACK_INT8,
	PACK_NUMERIC,
	PACK_NULL,					/* of an unreadable type: NULLs only */
	PACK_GEOMETRY,				/* all coordinates at once */
	PACK_Z						/* z of the geometry, as an attribute */
} PackKind;

/* The source of rows, for messages. */
typedef struct RowOrigin
{
	const char *columns_of;
	const char *rows_of;
	const char *type_hint;		/* what to do about an unreadable type */
	const char *geometry_hint;	/* ... that is a geometry: begins a sentence, or NULL */
	const char *value_hint;		/* ... and about a row without a place */
	bool		bare_nulls;		/* an attribute or label may be NULL without a cast */
	const char *whole;			/* what the rows are for */
	const char *id;				/* the first column */
	const char *an_id;			/* a value of it */
	const char *level;			/* the second column, if it is not a coordinate */
	bool		by_number;		/* a row is identified by its number, not its id; of several ids,
								 * the first is not that of a vertex */
	bool		takes_geometry; /* a geometry may follow the first column */
	bool		makes_id;		/* rows without an id can be given one in the query */
	bool		takes_z;		/* the geometry again is an attribute: its z */
} RowOrigin;

/* Kinds of rows for octrees. */
typedef enum OctantRows
{
	OCTANT_LEAVES,				/* code, level, attributes */
	OCTANT_VALUES,				/* code, attributes */
	OCTANT_PLACES,				/* level, coordinates */
	OCTANT_POINTS				/* id, coordinates; other columns are ignored */
} OctantRows;

typedef struct RowPacker
{
	DestReceiver receiver;
	const RowOrigin *origin;
	abacus_names names;			/* of the columns; the mesh may have others */
	int			columns;		/* of a record: id, coordinates, attributes; or ids, labels */
	int			ids;			/* columns of ids: 1, or of a simplex */
	int			coordinates;	/* columns after them that must be finite: coordinates, or a level */
	int			inputs;			/* columns of a row: a geometry stands for all coordinates */
	PackKind   *kinds;
	GeometryType geometry;		/* of type InvalidOid: coordinates have columns of their own */
	bool		takes_srid;		/* a mesh without SRID takes the geometries' SRID */
	int32		srid;			/* of geometries: of the mesh, or of the first; -1: none so far */
	bool		converts;		/* needs memory for conversions */
	bool		any_null;		/* of kind PACK_NULL */
	uint64	   *points;			/* records: room for a batch */
	size_t		count;
	uint64		row;			/* rows seen, for messages */
	MemoryContext scratch;		/* of conversions; emptied at each batch */
} RowPacker;

extern bool row_packer_takes_geometry(TupleDesc desc);
extern const char *row_packer_column(abacus_names names, int column);
extern RowPacker *row_packer_create(TupleDesc desc, abacus_names names, bool takes_srid,
									size_t batch);
extern RowPacker *row_packer_create_places(TupleDesc desc, abacus_names names,
										   size_t batch);
extern RowPacker *row_packer_create_tracked(TupleDesc desc, abacus_names names,
											size_t batch);
extern RowPacker *row_packer_create_simplices(TupleDesc desc, abacus_names names,
											  size_t batch);
extern RowPacker *row_packer_create_labels(TupleDesc desc, abacus_names names,
										   size_t batch);
extern RowPacker *row_packer_create_facets(TupleDesc desc, abacus_names names,
										   size_t batch);
extern RowPacker *row_packer_create_loaded_facets(TupleDesc desc, abacus_names names,
												  size_t batch);
extern RowPacker *row_packer_create_loaded_lines(TupleDesc desc, abacus_names names,
												 size_t batch);
extern RowPacker *row_packer_create_values(TupleDesc desc, size_t batch);
extern RowPacker *row_packer_create_octants(TupleDesc desc, abacus_names names,
											OctantRows rows, bool takes_srid, size_t batch);
extern void row_packer_reset(RowPacker *packer);

#endif
