/*
 * cancel_request.c: asks a server to cancel what runs there.
 *
 * libpq connects anew for that, and waits as long as the system does, minutes if the machine is cut off. A
 * cancel request of the user has to end within a second. So a thread asks, and is left alone with it if the
 * answer takes long. It calls nothing of PostgreSQL but libpq, and takes no signals.
 */
#include "postgres.h"

#include <pthread.h>
#include <signal.h>
#include <time.h>

#include "pg/connect/cancel_request.h"

/* For the answer, in milliseconds. While one server does not answer, others are not waited for. */
#define PATIENCE 250

typedef struct Request
{
	PGcancel   *cancel;
	bool		is_answered;
	bool		is_left;		/* nobody waits: the thread frees it */
} Request;

static pthread_mutex_t lock = PTHREAD_MUTEX_INITIALIZER;	/* of all below, and of what requests say */
static pthread_cond_t answered = PTHREAD_COND_INITIALIZER;
static int	left = 0;

static void
free_request(Request *request)
{
	PQfreeCancel(request->cancel);
	free(request);
}

static void *
ask(void *argument)
{
	Request    *request = argument;
	char		problem[256];
	bool		is_left;

	(void) PQcancel(request->cancel, problem, sizeof(problem));
	pthread_mutex_lock(&lock);
	request->is_answered = true;
	is_left = request->is_left;
	left -= is_left;
	pthread_cond_broadcast(&answered);
	pthread_mutex_unlock(&lock);
	if (is_left)
		free_request(request);
	return NULL;
}

/* Starts a thread that asks; false if there can be none. */
static bool
start(Request *request)
{
	pthread_t	thread;
	pthread_attr_t attributes;
	sigset_t	all;
	sigset_t	found;
	bool		is_started;

	if (pthread_attr_init(&attributes) != 0)
		return false;
	sigfillset(&all);
	pthread_sigmask(SIG_SETMASK, &all, &found);
	is_started = pthread_attr_setdetachstate(&attributes, PTHREAD_CREATE_DETACHED) == 0 &&
		pthread_create(&thread, &attributes, ask, request) == 0;
	pthread_sigmask(SIG_SETMASK, &found, NULL);
	pthread_attr_destroy(&attributes);
	return is_started;
}

/* Waits for the answer, or leaves the request to its thread. */
static void
await(Request *request)
{
	struct timespec end;
	bool		is_answered;

	clock_gettime(CLOCK_REALTIME, &end);
	end.tv_nsec += PATIENCE * 1000000L;
	end.tv_sec += end.tv_nsec / 1000000000L;
	end.tv_nsec %= 1000000000L;
	pthread_mutex_lock(&lock);
	while (!request->is_answered && left == 0 && pthread_cond_timedwait(&answered, &lock, &end) == 0)
		;
	is_answered = request->is_answered;
	request->is_left = !is_answered;
	left += request->is_left;
	pthread_mutex_unlock(&lock);
	if (is_answered)
		free_request(request);
}

/* Cancels what runs on the connection, if the server can be reached. Raises no error. */
void
cancel_request(PGconn *conn)
{
	Request    *request = calloc(1, sizeof(Request));

	if (request == NULL)
		return;
	request->cancel = PQgetCancel(conn);
	if (request->cancel != NULL && start(request))
		await(request);
	else
		free_request(request);
}
