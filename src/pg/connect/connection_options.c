/*
 * connection_options.c: how a foreign server is reached, and who may do so.
 *
 * The user makes foreign servers and user mappings with the wrapper of dblink or of postgres_fdw, which
 * check their options. Who may connect is decided as these two do: a user who is not a superuser needs a
 * password in the mapping, which the server must really ask for. Else he would connect as the operating
 * system's user who runs the coordinator. A superuser can allow it: password_required 'false'.
 */
#include "postgres.h"

#include <libpq-fe.h>

#include "catalog/dependency.h"
#include "catalog/pg_foreign_data_wrapper.h"
#include "commands/defrem.h"
#include "commands/extension.h"
#include "mb/pg_wchar.h"
#include "miscadmin.h"
#include "nodes/pg_list.h"
#include "utils/builtins.h"

#include "pg/connect/connection_options.h"

/* Two of our own, and the end. */
#define OWN_OPTIONS 3

/*
 * What is passed on. Later versions of libpq may have options that do more than say how to connect, such as
 * writing files: they are left out.
 */
static const char *const passed_on[] = {
	"application_name", "channel_binding", "connect_timeout", "dbname", "gssencmode", "host", "hostaddr",
	"keepalives", "keepalives_count", "keepalives_idle", "keepalives_interval", "krbsrvname", "load_balance_hosts",
	"options", "passfile", "password", "port", "require_auth", "requirepeer", "ssl_max_protocol_version",
	"ssl_min_protocol_version", "sslcert", "sslcertmode", "sslcrl", "sslcrldir", "sslkey", "sslmode",
	"sslnegotiation", "sslpassword", "sslrootcert", "sslsni", "target_session_attrs", "tcp_user_timeout", "user"
};

static void
require_wrapper(const ForeignServer *server)
{
	Oid			extension = getExtensionOfObject(ForeignDataWrapperRelationId, server->fdwid);
	char	   *name = OidIsValid(extension) ? get_extension_name(extension) : NULL;

	if (name == NULL || (strcmp(name, "dblink") != 0 && strcmp(name, "postgres_fdw") != 0))
		ereport(ERROR,
				(errcode(ERRCODE_WRONG_OBJECT_TYPE),
				 errmsg("server \"%s\" is not one of dblink or postgres_fdw", server->servername),
				 errhint("CREATE SERVER with FOREIGN DATA WRAPPER postgres_fdw or dblink_fdw.")));
}

void
connection_require_password(const char *server)
{
	ereport(ERROR,
			(errcode(ERRCODE_S_R_E_PROHIBITED_SQL_STATEMENT_ATTEMPTED),
			 errmsg("password is required"),
			 errdetail("Users who are not superusers connect to server \"%s\" only with a password that it asks for.",
					   server),
			 errhint("Put a password into the user mapping, and let the server ask for it (pg_hba.conf).")));
}

/* Whether the option is passed on, and this libpq knows it. */
static bool
is_passed_on(const PQconninfoOption *known, const char *name)
{
	bool		passed = false;

	for (int i = 0; i < lengthof(passed_on); i++)
		passed |= strcmp(passed_on[i], name) == 0;
	for (; passed && known->keyword != NULL; known++)
		if (strcmp(known->keyword, name) == 0)
			return true;
	return false;
}

static int
add_options(ConnectionOptions *options, int count, const PQconninfoOption *known, List *given)
{
	ListCell   *cell;

	foreach(cell, given)
	{
		DefElem    *option = lfirst(cell);

		if (!is_passed_on(known, option->defname))
			continue;			/* others say how the wrapper plans, for example */
		options->names[count] = option->defname;
		options->values[count++] = defGetString(option);
	}
	return count;
}

/* The option of that name, or NULL. */
static DefElem *
find_option(List *options, const char *name)
{
	ListCell   *cell;

	foreach(cell, options)
	{
		DefElem    *option = lfirst(cell);

		if (strcmp(option->defname, name) == 0)
			return option;
	}
	return NULL;
}

static bool
has_password(List *options)
{
	DefElem    *password = find_option(options, "password");

	return password != NULL && defGetString(password)[0] != '\0';
}

static bool
is_without_password(List *options)
{
	DefElem    *required = find_option(options, "password_required");

	return required != NULL && !defGetBoolean(required);
}

ConnectionOptions
connection_options(ForeignServer *server, UserMapping *mapping)
{
	ForeignDataWrapper *wrapper = GetForeignDataWrapper(server->fdwid);
	int			room = list_length(wrapper->options) + list_length(server->options) + list_length(mapping->options) +
		OWN_OPTIONS;
	ConnectionOptions options;
	PQconninfoOption *known;
	int			count = 0;

	require_wrapper(server);
	options.names = palloc(room * sizeof(char *));
	options.values = palloc(room * sizeof(char *));
	options.needs_password = !superuser() && !is_without_password(mapping->options);
	if (options.needs_password && !has_password(mapping->options))
		connection_require_password(server->servername);
	known = PQconndefaults();
	if (known == NULL)
		ereport(ERROR,
				(errcode(ERRCODE_OUT_OF_MEMORY),
				 errmsg("out of memory")));
	count = add_options(&options, count, known, wrapper->options);
	count = add_options(&options, count, known, server->options);
	count = add_options(&options, count, known, mapping->options);
	PQconninfoFree(known);
	options.names[count] = "fallback_application_name";
	options.values[count++] = "abacus";
	options.names[count] = "client_encoding";
	options.values[count++] = GetDatabaseEncodingName();
	options.names[count] = options.values[count] = NULL;
	return options;
}
