/*
 * generation.h: what the coordinator knows of a mesh over several servers: a row of its table for each
 * generation of the mesh.
 */
#ifndef ABACUS_GENERATION_H
#define ABACUS_GENERATION_H

#include "postgres.h"

#include "abacus/shards.h"
#include "pg/shards/links.h"

/* Phases of a build, each of which is committed. Readers see none but the last. */
typedef enum ShardPhase
{
	SHARDS_NEW,					/* no points are on the servers */
	SHARDS_SPREAD,				/* domain and borders are known, and all points are on their servers */
	SHARDS_TRIANGULATED,		/* each server has a mesh of its own points */
	SHARDS_PUBLISHED			/* they have exchanged vertices: the mesh can be read */
} ShardPhase;

typedef struct Generation
{
	Oid			relid;			/* the coordinator's table */
	int64		number;
	ShardPhase	phase;
	char	   *source;			/* a digest of the queries of its build, or NULL */
	char	   *token;			/* part of the names of its meshes on the servers */
	int			shards;
	char	  **servers;
	abacus_form form;
	char	  **attributes;		/* names; NULL: not known yet */
	int			attribute_count;
	bool		names_given;	/* when the mesh was created, not taken from a query */
	bool		domain_given;
	abacus_box	extent;			/* of all points */
	uint64	   *borders;		/* shards - 1 codes */
	int64		points;			/* of all shards */
	int			rounds;			/* of the exchange */
	int64		sent;			/* vertices that it sent */
	int64		simplices;		/* of all shards, each counted by its owner */
	int64	   *versions;		/* of each shard: changes of the published mesh */
} Generation;

extern bool generation_read(Oid relid, bool published, Generation *generation);
extern bool generation_read_after(Oid relid, int64 number, Generation *generation);
extern void generation_require_published(Oid relid, Generation *generation);
extern void generation_copy(Generation *to, const Generation *from);
extern void generation_insert(const Generation *generation);
extern void generation_update(const Generation *generation);
extern void generation_forget(const Generation *generation);
extern bool generation_read_numbered(Oid relid, int64 number, Generation *generation);
extern char *generation_change_prefix(const Generation *generation, int shard);
extern void generation_reach(const Generation *generation, abacus_box *reach);
extern char *generation_mesh(const Generation *generation, int shard);
extern uint32 generation_owner(const Generation *generation, uint64 code);
extern const char *phase_name(ShardPhase phase);

#endif
