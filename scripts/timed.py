#!/usr/bin/python3
"""Runs a command and adds a line to a file: elapsed seconds, those of processors, those in the kernel.

    timed.py FILE COMMAND...

A command that takes more than ABACUS_MOST_SECONDS, if that is set, is ended, with the status 124.
Servers that the command leaves to themselves count, too, as they end: this process is their
"subreaper" (Linux, prctl(2)), so their times come to it when it waits for them. What runs on when
the command has ended is ended. The status is the command's.
"""
import ctypes
import os
import resource
import signal
import sys
import time

PR_SET_CHILD_SUBREAPER = 36


def children(pid):
    try:
        with open(f"/proc/{pid}/task/{pid}/children") as listed:
            return [int(child) for child in listed.read().split()]
    except OSError:
        return []


def end_children():
    """Ends what is left, and what comes to this process while it ends: for a minute as a server ends
    at once (SIGINT, a fast stop), then by force."""
    began = time.monotonic()
    asked = set()
    while True:
        try:
            while os.waitpid(-1, os.WNOHANG)[0]:
                pass
        except ChildProcessError:
            return
        number = signal.SIGINT if time.monotonic() - began < 60 else signal.SIGKILL
        for child in children(os.getpid()):
            if (child, number) not in asked:
                asked.add((child, number))
                try:
                    os.kill(child, number)
                except OSError:  # it has ended, or belongs to another user
                    pass
        time.sleep(0.1)


def main(report, command):
    ctypes.CDLL(None).prctl(PR_SET_CHILD_SUBREAPER, 1, 0, 0, 0)
    began = time.monotonic()
    pid = os.fork()
    if pid == 0:
        os.execvp(command[0], command)
    for number in (signal.SIGINT, signal.SIGTERM):  # the command ends itself
        signal.signal(number, lambda *_: None)
    late = []

    def end_late(*_):  # what the command has started ends as it always does
        late.append(pid)
        os.kill(pid, signal.SIGKILL)

    most = int(os.environ.get("ABACUS_MOST_SECONDS") or 0)
    signal.signal(signal.SIGALRM, end_late)
    signal.alarm(most)
    status = None
    while status is None:
        done, ended = os.wait()
        if done == pid:
            status = os.waitstatus_to_exitcode(ended)
    signal.alarm(0)
    elapsed = time.monotonic() - began
    end_children()
    used = resource.getrusage(resource.RUSAGE_CHILDREN)
    with open(report, "a") as out:
        print(f"{elapsed:.1f} {used.ru_utime + used.ru_stime:.1f} {used.ru_stime:.1f}", file=out)
    if late:
        print(f"Ended by force: it took more than {most} seconds.", flush=True)
        return 124
    return status if status >= 0 else 128 - status


if __name__ == "__main__":
    sys.exit(main(sys.argv[1], sys.argv[2:]))
