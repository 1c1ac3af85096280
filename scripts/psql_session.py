"""A psql that stays open, for the scripts that drive a server: the environment says which one."""
import os
import subprocess

SENTINEL = "---- done ----"


class Failure(Exception):
    """A statement failed, or has shown what should not be."""


class Session:
    """A psql that is given one statement after the other."""

    def __init__(self):
        self.psql = subprocess.Popen(
            ["psql", "-X", "-q", "-A", "-t"], text=True, bufsize=1,
            stdin=subprocess.PIPE, stdout=subprocess.PIPE, stderr=subprocess.STDOUT,
            # all output is an answer or an error
            env=os.environ | {"PGOPTIONS": os.environ.get("PGOPTIONS", "") + " -c client_min_messages=warning"})

    def __enter__(self):
        return self

    def __exit__(self, *_):
        self.close()

    def close(self):
        self.psql.stdin.close()
        self.psql.wait()

    def run(self, sql, expected=()):
        """What it prints; None if it fails with one of these messages."""
        self.psql.stdin.write(f"{sql}\n\\echo {SENTINEL}\n")
        self.psql.stdin.flush()
        lines = []
        for line in self.psql.stdout:
            if line == SENTINEL + "\n":
                break
            lines.append(line)
        else:
            raise Failure(f"the session has ended at\n{sql[:2000]}\n{''.join(lines)}")
        printed = "".join(lines).strip()
        if "ERROR:" not in printed:
            return printed
        if any(message in printed for message in expected):
            return None
        raise Failure(f"{sql[:2000]}\n{printed}")
