/*
 * generation_links.h: the generation of a mesh that readers see, and connections on which its shards are as
 * they belong together.
 */
#ifndef ABACUS_GENERATION_LINKS_H
#define ABACUS_GENERATION_LINKS_H

#include "pg/shards/generation.h"

extern void generation_read_links(Oid relid, Generation *generation, ShardLinks *links);
extern int	generation_begin_together(Generation *generation, ShardLinks *links);
extern void generation_require_seen(const Generation *generation, ShardLinks *links, int shard);
extern Generation *generation_change_links(Oid relid, ShardLinks *links);

#endif
