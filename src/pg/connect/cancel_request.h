/* cancel_request.h: asks a server to cancel what runs there, without waiting for long. */
#ifndef ABACUS_CANCEL_REQUEST_H
#define ABACUS_CANCEL_REQUEST_H

#include <libpq-fe.h>

extern void cancel_request(PGconn *conn);

#endif
