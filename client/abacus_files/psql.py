"""psql as a child: how it is started, how it is ended, and texts that it does not read.

psql brings the connection options, the password file and the environment that users know.
"""
import ctypes
import fcntl
import os
import signal
import subprocess
import sys


class Failed(Exception):
    """What psql said, or a file that is not as it should be."""


def literal(text):
    """A text as a constant, whatever standard_conforming_strings says."""
    return "E'" + text.replace("\\", "\\\\").replace("'", "''") + "'"


def statement(sql):
    """A line by which psql sends `sql` to the server as it stands. psql does not look into it, so an open quote, parenthesis or comment is
    an error of the server's and nothing that psql waits for the end of."""
    return f"SELECT {literal(sql)} \\gexec\n"


def _end_with_parent():
    """Linux interrupts psql if this process is killed, and psql then cancels its statement."""
    PR_SET_PDEATHSIG = 1
    ctypes.CDLL(None).prctl(PR_SET_PDEATHSIG, signal.SIGINT)


def widen(*pipes):
    """Gives pipes more room, where the system can: with 64 kB the programs take turns so often that this takes most of a stream's processor time."""
    for pipe in pipes:
        try:
            fcntl.fcntl(pipe.fileno(), fcntl.F_SETPIPE_SZ, 1 << 20)
        except (OSError, AttributeError):
            pass


def start(database, variables=(), options="", **pipes):
    """A psql that reads statements from a pipe. `options`: more of PGOPTIONS."""
    command = ["psql", "-X", "-q", "-A", "-t", "-v", "ON_ERROR_STOP=1", *(["-d", database] if database else [])]
    environment = dict(os.environ, PGCLIENTENCODING="UTF8", PGOPTIONS=f"{os.environ.get('PGOPTIONS', '')} {options}".strip())
    try:
        started = subprocess.Popen(command, stdin=subprocess.PIPE, stdout=subprocess.PIPE, env=environment,
                                   preexec_fn=_end_with_parent if sys.platform == "linux" else None, **pipes)
        widen(started.stdin, started.stdout)
        return started
    except FileNotFoundError as error:
        raise Failed("psql is not installed, or not in PATH (postgresql-client)") from error


def end(psql):
    """Ends it and its session, whatever the server is doing: the statement is cancelled, and what it changed is rolled back."""
    for pipe in (psql.stdout, psql.stdin):  # what it still writes goes nowhere, and it reads no more
        try:
            pipe.close()
        except (BrokenPipeError, ValueError):
            pass
    try:
        for _ in range(10):  # where it comes too early, before a statement is sent, psql forgets the first
            if psql.poll() is not None:
                break
            psql.send_signal(signal.SIGINT)
            try:
                psql.wait(0.5)
            except subprocess.TimeoutExpired:
                pass
    finally:
        psql.kill()
        psql.wait()


def end_by_signals():
    """SIGTERM and SIGHUP end this program by way of its `finally` clauses, as Ctrl-C does."""
    for number in signal.SIGTERM, signal.SIGHUP:
        if signal.getsignal(number) != signal.SIG_IGN:  # as nohup has it
            signal.signal(number, lambda number, _: sys.exit(128 + number))
