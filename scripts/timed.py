#!/usr/bin/python3
"""Runs a command and adds a line to a file: elapsed seconds, those of processors, those in the kernel.

    timed.py FILE COMMAND...

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


def main(report, command):
    ctypes.CDLL(None).prctl(PR_SET_CHILD_SUBREAPER, 1, 0, 0, 0)
    began = time.monotonic()
    pid = os.fork()
    if pid == 0:
        os.execvp(command[0], command)
    for number in (signal.SIGINT, signal.SIGTERM):  # the command ends itself
        signal.signal(number, lambda *_: None)
    status = None
    while status is None:
        done, ended = os.wait()
        if done == pid:
            status = os.waitstatus_to_exitcode(ended)
    elapsed = time.monotonic() - began
    for left in children(os.getpid()):
        try:
            os.kill(left, signal.SIGTERM)
        except ProcessLookupError:
            pass
    try:
        while True:
            os.wait()
    except ChildProcessError:
        pass
    used = resource.getrusage(resource.RUSAGE_CHILDREN)
    with open(report, "a") as out:
        print(f"{elapsed:.1f} {used.ru_utime + used.ru_stime:.1f} {used.ru_stime:.1f}", file=out)
    return status if status >= 0 else 128 - status


if __name__ == "__main__":
    sys.exit(main(sys.argv[1], sys.argv[2:]))
