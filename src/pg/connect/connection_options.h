/*
 * connection_options.h: how a foreign server is reached, and who may do so.
 */
#ifndef ABACUS_CONNECTION_OPTIONS_H
#define ABACUS_CONNECTION_OPTIONS_H

#include "postgres.h"

#include "foreign/foreign.h"

/* Names and values as libpq takes them, which end with NULL. */
typedef struct ConnectionOptions
{
	const char **names;
	const char **values;
	bool		needs_password; /* the server must ask for the one of the user mapping */
} ConnectionOptions;

extern ConnectionOptions connection_options(ForeignServer *server, UserMapping *mapping);
extern void connection_require_password(const char *server);

#endif
