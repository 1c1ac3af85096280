"""What the figures were measured on."""
import json
import os
import re
import subprocess
import time

import paths

SERVER = "postgresql-" + os.environ.get("ABACUS_POSTGRESQL", "15")
# Patterns of dpkg-query; heads.py says which belongs to which engine.
PACKAGES = (SERVER, "libcgal-dev", "libtbb-dev", "libtet1.[0-9]", "libqhull-r8.[0-9]", f"{SERVER}-postgis-3", "libgeos[0-9]*",
            "python3-scipy", "python3-matplotlib", "python3-vtk9", "gdal-bin", "libp4est-dev", "metis")


class LeftOut(Exception):
    """What was to be measured cannot be measured on this machine, for want of room or of a device."""


def output(*command):
    """What a command prints; empty if there is no such command or it fails."""
    try:
        return subprocess.run(command, capture_output=True, text=True, check=True,
                              cwd=paths.ROOT).stdout.strip()
    except (OSError, subprocess.CalledProcessError):
        return ""


def field(path, name):
    """The value of the first line `name: value` of a file of /proc."""
    with open(path) as file:
        for line in file:
            key, _, value = line.partition(":")
            if key.strip() == name:
                return value.strip()
    return ""


def compiler_flags():
    """The flags of build/release: of the core, and of the comparators that are compiled."""
    with open(paths.RELEASE / "compile_commands.json") as file:
        command = next(entry["command"] for entry in json.load(file)
                       if entry["file"].endswith("comparators/cgal.cpp"))
    return " ".join(word for word in command.split() if word.startswith(("-O", "-f", "-m", "-std")))


def packages():
    """Versions of those that are installed."""
    versions = {}
    for pattern in PACKAGES:
        for line in output("dpkg-query", "-W", "-f", "${db:Status-Status} ${Package} ${Version}\n", pattern).splitlines():
            if line.startswith("installed "):
                _, name, found = line.split(" ")
                versions[name] = found
    return versions


def version():
    """That of the extension."""
    return re.search(r"default_version = '(.+)'", (paths.ROOT / "abacus.control").read_text())[1]


def built():
    """How the programs were compiled, and of what; of programs that were brought here the folder says it."""
    if paths.BROUGHT.exists():
        return json.loads(paths.BROUGHT.read_text())
    changed = bool(output("git", "status", "--porcelain", "--untracked-files=no",
                          "--", "src", "include", "sql", "bench", "Makefile.pgxs"))
    return {
        "compiler": output("c++", "--version").split("\n")[0],
        "flags": compiler_flags(),
        "packages": packages(),
        "abacus": version(),
        "commit": output("git", "rev-parse", "--short=12", "HEAD") + (" and changes" if changed else ""),
    }


def describe():
    """All that the heading of a report says; the load shows whether the machine was quiet."""
    return {
        "cpu": field("/proc/cpuinfo", "model name"),
        "cores": os.cpu_count(),
        "memory_bytes": os.sysconf("SC_PAGE_SIZE") * os.sysconf("SC_PHYS_PAGES"),
        "kernel": os.uname().release,
        **built(),
        "date": time.strftime("%Y-%m-%d %H:%M UTC", time.gmtime()),
        "load": round(os.getloadavg()[0], 2),
    }
