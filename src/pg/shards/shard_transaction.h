/*
 * shard_transaction.h: what servers of a mesh do belongs to the local transaction.
 */
#ifndef ABACUS_SHARD_TRANSACTION_H
#define ABACUS_SHARD_TRANSACTION_H

#include "postgres.h"

#include "pg/connect/connection.h"

extern bool shard_transaction_is_open(const Connection *connection);
extern void shard_transaction_send(Connection *connection, const char *query);
extern void shard_transaction_end(Connection *connection);
extern void shard_transaction_refuse_changed(Oid mesh, const char *work);
extern void shard_transaction_leave(Oid mesh);
extern void shard_transaction_guard(Connection *connection);
extern void shard_transaction_change(Connection *connection, const char *prefix);
extern void shard_transaction_unchange(Connection *connection);
extern void shard_transaction_set_version(Connection *connection, int64 generation, int64 version);
extern bool shard_transaction_knows_version(const Connection *connection, int64 generation, int64 *version);
extern bool shard_transaction_has_changed(const Connection *connection);
extern void shard_transaction_init(void);

#endif
