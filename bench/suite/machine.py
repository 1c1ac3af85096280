"""What the figures were measured on."""
import json
import os
import subprocess
import time

import paths

PACKAGES = ("postgresql-15", "libcgal-dev", "libtet1.5", "libqhull-r8.0", "postgresql-15-postgis-3",
            "libgeos3.11.1")


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


def describe():
    """All that the heading of a report says; the load shows whether the machine was quiet."""
    versions = {}
    for package in PACKAGES:
        version = output("dpkg-query", "-W", "-f", "${Version}", package)
        if version:
            versions[package] = version
    changed = bool(output("git", "status", "--porcelain", "--untracked-files=no",
                          "--", "src", "include", "sql", "bench", "Makefile.pgxs"))
    return {
        "cpu": field("/proc/cpuinfo", "model name"),
        "cores": os.cpu_count(),
        "memory_bytes": os.sysconf("SC_PAGE_SIZE") * os.sysconf("SC_PHYS_PAGES"),
        "kernel": os.uname().release,
        "compiler": output("c++", "--version").split("\n")[0],
        "flags": compiler_flags(),
        "packages": versions,
        "commit": output("git", "rev-parse", "--short=12", "HEAD") + (" and changes" if changed else ""),
        "date": time.strftime("%Y-%m-%d %H:%M UTC", time.gmtime()),
        "load": round(os.getloadavg()[0], 2),
    }
