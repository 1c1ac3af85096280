/*
 * change.h: a change of a mesh with the points of a query.
 */
#ifndef ABACUS_CHANGE_OF_MESH_H
#define ABACUS_CHANGE_OF_MESH_H

#include "abacus/constrain.h"
#include "abacus/labels.h"
#include "abacus/load.h"
#include "pg/input/source.h"
#include "pg/mesh/writer.h"

typedef struct Change
{
	Writer		writer;
	abacus_stage *stage;		/* the points */
	abacus_build *build;
	uint64		points;			/* how many it holds */
	uint32		point_words;	/* of each */
	int64		greatest_id;	/* of them */
	abacus_stage *put_aside;	/* another one */
	int64		greatest_aside; /* id of its points */
	abacus_on_duplicate on_duplicate;
	uint64		duplicates;		/* of the mesh before the change */
	bool		may_replace;	/* the user can choose 'replace' */
	bool		keeps_domain;	/* that of a mesh over several servers */
	bool		inserts;
	bool		holds;			/* labels and markers, until its end */
	bool		returns;		/* which simplices it creates and removes */
	bool		knows_lines;	/* no line names a point that it deletes, even while lines wait */
	abacus_load *load;			/* a triangulation made elsewhere */
	abacus_labelling *labelling;
	abacus_marking *marking;
	abacus_segments *fixed;		/* of lines that come */
	abacus_segments *freed;		/* of lines that go */
	abacus_segments *ties;		/* loaded edges that the perturbation decides against */
} Change;

extern Change *change_begin(Oid mesh, const char *command);
extern Change *change_begin_in_trigger(Oid mesh, const char *command);
extern void change_open_stage(Change *change, const abacus_facts *shape);
extern void change_add(Change *change, const uint64 *points, size_t count);
extern void change_read(Change *change, Source *source);
extern void change_read_gone(Change *change, Source *source, abacus_names names);
extern void change_take_srid(Change *change, int32 srid);
extern void change_swap_stages(Change *change);
extern void change_open_build(Change *change);
extern void change_show(Change *change);
extern void change_insert(Change *change);
extern uint64 change_delete(Change *change, bool exactly);
extern uint64 change_update(Change *change, const uint32 *attributes, size_t count, bool exactly,
							abacus_named_place *missing);
extern void change_attributes(Change *change, const uint32 *source, size_t count);
extern void change_clear(Change *change);
extern void change_stage(Change *change);
extern void change_lines(Change *change, int64 more, int64 soft);
extern void change_fix(Change *change);
extern void change_unfix(Change *change);
extern uint64 change_restore_ties(Change *change);
extern void change_settle(Change *change);
extern void change_report(Change *change, abacus_change_report report, void *context);
extern void change_abandon(Change *change);
extern void change_end(Change *change);
extern uint64 change_insert_query(Oid mesh, Source *source, const char *command,
								  abacus_header *header);

#endif
