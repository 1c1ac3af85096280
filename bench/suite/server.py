"""PostgreSQL as the suite uses it: sessions that are timed, and what they leave behind.

The server is the throw-away one of scripts/cluster.sh; psql finds it by the environment.
"""
import json
import os
import re
import shutil
import subprocess
import threading
import time

import machine
import paths
import psql_session
from psql_session import Failure


class Session(psql_session.Session):
    """A psql whose backend is watched. It computes with one thread, as those that it is compared with, unless told otherwise."""

    def __init__(self, **settings):
        super().__init__()
        self.backend = int(self.run("SELECT pg_backend_pid()"))
        for name, value in ({"abacus__threads": 1} | settings).items():
            self.run(f"SET {name.replace('__', '.')} = '{value}'")

    def run(self, sql):
        """The statement need not end with a semicolon."""
        return super().run(f"{sql}\n;")

    def cpu(self):
        """CPU seconds of the backend so far, of all its threads, those that have ended too."""
        clock = ~self.backend << 3 | 2  # the clock's number as clock_getcpuclockid() gives it for a process
        return time.clock_gettime(clock)

    def timed(self, sql):
        """A sample of the statement: what it took, and what it printed as `printed`.

        Wall time is psql's; CPU time and largest private memory are the backend's.
        """
        wal, cpu = wal_position(), self.cpu()
        with MemoryWatch(self.backend) as memory:
            printed = self.run(f"\\timing on\n{sql}\n;\n\\timing off")
        times = re.findall(r"^Time: ([0-9.]+) ms", printed, re.MULTILINE)
        return {"wall": round(float(times[-1]) / 1000, 6), "cpu": round(self.cpu() - cpu, 6),
                "memory": memory.peak, "wal": wal_position() - wal,
                "printed": re.sub(r"^Time: .*\n?", "", printed, flags=re.MULTILINE).strip()}


class MemoryWatch:
    """Looks at the private memory (RssAnon) of a process again and again: `peak`, in bytes."""

    def __init__(self, process):
        self.status = f"/proc/{process}/status"
        self.peak = 0
        self.ended = threading.Event()
        self.thread = threading.Thread(target=self.watch, daemon=True)

    def __enter__(self):
        self.thread.start()
        return self

    def __exit__(self, *_):
        self.ended.set()
        self.thread.join()

    def watch(self):
        while True:
            with open(self.status, "rb") as status:
                text = status.read()
            self.peak = max(self.peak, int(re.search(rb"^RssAnon:\s*(\d+)", text, re.M)[1]) << 10)
            if self.ended.wait(0.02):
                break


def query(sql, database=None):
    """What a statement in a session of its own prints."""
    there = ["-d", database] if database else []
    done = subprocess.run(["psql", "-X", "-q", "-A", "-t", "-v", "ON_ERROR_STOP=1", *there, "-c", sql],
                          text=True, capture_output=True)
    if done.returncode != 0:
        raise Failure(f"{sql}\n{done.stderr}")
    return done.stdout.strip()


def wal_position():
    """Bytes of WAL that have been written since the server was made."""
    return int(query("SELECT pg_current_wal_insert_lsn() - '0/0'"))


def has_extension(name):
    return query(f"SELECT count(*) FROM pg_available_extensions WHERE name = '{name}'") == "1"


def create_extension(name):
    query(f"SET client_min_messages = warning; CREATE EXTENSION IF NOT EXISTS {name}")


def settings():
    """The settings that the server was given; the others have their defaults."""
    return json.loads(query(
        "SELECT coalesce(jsonb_object_agg(name, current_setting(name)), '{}') FROM pg_settings"
        " WHERE source IN ('configuration file', 'command line') AND name IN ('shared_buffers',"
        " 'max_wal_size', 'fsync', 'wal_level', 'maintenance_work_mem', 'work_mem')"))


def restart(**changed):
    """Restarts the server: with these settings, and the others as they were at first."""
    await_recovery()
    query("ALTER SYSTEM RESET ALL")
    for name, value in changed.items():
        query(f"ALTER SYSTEM SET {name} = '{value}'")
    subprocess.run(["bash", "-c", ". scripts/common.sh; . scripts/cluster.sh; cluster_restart"],
                   check=True, cwd=paths.ROOT, env=os.environ)


def await_recovery(seconds=300):
    """A server of which a process was killed takes a moment to come back."""
    until = time.monotonic() + seconds
    while subprocess.run(["pg_isready", "-q"]).returncode != 0 and time.monotonic() < until:
        time.sleep(0.5)


def require_disk(needed):
    """Bytes that must be free where the server keeps its data."""
    free = shutil.disk_usage(os.environ["PGHOST"]).free
    if free < needed:
        raise machine.LeftOut(f"{needed / 2**30:.0f} GB of disk are needed, {free / 2**30:.0f} GB are free")


def drop(*tables):
    query(f"SET client_min_messages = warning; DROP TABLE IF EXISTS {', '.join(tables)} CASCADE")


def settle():
    """No earlier work is charged to what is measured next."""
    query("CHECKPOINT")
    time.sleep(0.1)


def cache_size(name):
    """In MB: a number, or one of the server's, `default` or `largest` (no limit in practice)."""
    column = {"default": "boot_val", "largest": "max_val", "smallest": "min_val"}.get(str(name))
    if column is None:
        return int(name)
    return int(query(f"LOAD 'abacus'; SELECT {column} FROM pg_settings WHERE name = 'abacus.cache_size'"))


def mesh_sizes(mesh="mesh"):
    """Bytes on disk of a mesh, and its statistics."""
    return {
        "disk": json.loads(query(
            f"SELECT json_build_object('simplices', pg_table_size('{mesh}'),"
            f" 'index', pg_indexes_size('{mesh}'),"
            f" 'vertices', pg_total_relation_size('{mesh}_vertices'))")),
        "stats": json.loads(query(
            f"SELECT json_object_agg(name, value) FROM abacus_stats('{mesh}')")),
    }
