/*
 * published.h: a foreign table that shows a mesh: which mesh, which part of it, and what each
 * column holds.
 */
#ifndef ABACUS_PUBLISHED_H
#define ABACUS_PUBLISHED_H

#include "access/tupdesc.h"
#include "utils/rel.h"

#include "pg/mesh/numbering.h"
#include "pg/mesh/reader.h"
#include "pg/mesh/regions_table.h"
#include "pg/mesh/shown.h"

#define FDW_NAME "abacus"
/* The function by which a constraint of the table names the mesh. */
#define FDW_MESH_FUNCTION SHOWN_MESH_FUNCTION

/* Options of a table and of its columns. */
#define OPTION_CONTENT "content"
#define OPTION_HOLDS "holds"
#define OPTION_Z "z"
#define OPTION_DROPPED "dropped"

typedef enum Content
{
	CONTENT_CELLS,
	CONTENT_POINTS
} Content;

typedef enum Holds
{
	HOLDS_NOTHING,				/* a column that was dropped */
	HOLDS_CODE,
	HOLDS_CORNER,				/* of a cell: the id of corner `number` */
	HOLDS_CORNERS,				/* their coordinates */
	HOLDS_VALUES,				/* their attributes; `number`: how many had been dropped */
	HOLDS_ID,
	HOLDS_COORDINATE,			/* of a point: on axis `number` */
	HOLDS_ATTRIBUTE,			/* by its permanent `number`: a point's value, a cell's mean */
	HOLDS_LABEL,				/* of a cell: its label `number` */
	HOLDS_REGION,				/* of a cell: the name of its region */
	HOLDS_GEOMETRY				/* with attribute `number` as Z, unless that is negative */
} Holds;

typedef struct Column
{
	Holds		holds;
	int			number;			/* from 0 */
} Column;

typedef struct Published
{
	Oid			table;
	Oid			mesh;
	Content		content;
	int			count;
	Column		columns[FLEXIBLE_ARRAY_MEMBER];
} Published;

extern bool published_content(const char *word, Content *content);
extern bool published_holds(const char *word, Column *column);
extern int	published_number(const char *word);
extern int	published_dropped(const char *word);
extern bool published_has(const Column *column, const Numbering *numbering);
extern Published *published_read(Relation table);
extern Oid	published_mesh(Relation table);
extern Reader *published_open_mesh(const Published *published, Oid user, MemoryContext memory,
								   Numbering *numbering);
extern RegionNames *published_region_names(const Published *published, Oid user, const abacus_facts *facts);
extern void published_bind_restored(Relation mesh);

#endif
