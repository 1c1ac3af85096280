"""A control group whose processes share so much memory: their own and what the kernel caches for
them of files. It stands for a machine with no more than that.

Both kinds of control groups are supported: version 1, mounted at /sys/fs/cgroup/memory, and the
unified version 2. Swap is shut off, so a process that needs more than there is is killed.
"""
import contextlib
import os
import pathlib
import subprocess
import time

ROOT_V1 = pathlib.Path("/sys/fs/cgroup/memory")
ROOT_V2 = pathlib.Path("/sys/fs/cgroup")


def as_root(*command, text=None):
    """What the command prints; an OSError if it fails or there is no way to be root."""
    done = subprocess.run([*([] if os.geteuid() == 0 else ["sudo", "-n"]), *command], input=text,
                          text=True, capture_output=True)
    if done.returncode != 0:
        raise OSError(done.stderr.strip())
    return done.stdout


def write(path, value):
    as_root("tee", str(path), text=str(value))


def drop_page_cache():
    """What the kernel has cached of files is read anew; false if we must not ask for that."""
    os.sync()
    try:
        write("/proc/sys/vm/drop_caches", 3)
    except OSError:
        return False
    return True


def page_cache():
    """Bytes that the kernel has cached of files."""
    with open("/proc/meminfo") as file:
        return next(int(line.split()[1]) << 10 for line in file if line.startswith("Cached:"))


class MemoryGroup:
    """The group, for as long as it is needed. Raises OSError where none can be made."""

    def __init__(self, limit):
        self.limit = limit
        self.version = 1 if (ROOT_V1 / "memory.limit_in_bytes").exists() else 2
        self.folder = (ROOT_V1 if self.version == 1 else ROOT_V2) / f"abacus-{os.getpid()}"

    def __enter__(self):
        if self.version == 2:
            if "memory" not in (ROOT_V2 / "cgroup.controllers").read_text().split():
                raise OSError("the memory controller is not there")
            write(ROOT_V2 / "cgroup.subtree_control", "+memory")
        as_root("mkdir", str(self.folder))
        if self.version == 1:
            write(self.folder / "memory.limit_in_bytes", self.limit)
        else:
            write(self.folder / "memory.max", self.limit)
        swap, limit = (("memory.memsw.limit_in_bytes", self.limit) if self.version == 1
                       else ("memory.swap.max", 0))
        if (self.folder / swap).exists():  # missing on kernels that don't count it
            write(self.folder / swap, limit)
        return self

    def __exit__(self, *_):
        """Who is still there goes where this process is; one that ends takes a moment to leave."""
        home = self.folder.parent / self.own_group().lstrip("/")
        for _ in range(50):
            for process in (self.folder / "cgroup.procs").read_text().split():
                with contextlib.suppress(OSError):
                    write(home / "cgroup.procs", process)
            with contextlib.suppress(OSError):
                as_root("rmdir", str(self.folder))
                return
            time.sleep(0.1)

    def own_group(self):
        """Of this process, among the groups of memory."""
        for line in pathlib.Path("/proc/self/cgroup").read_text().splitlines():
            number, controllers, path = line.split(":", 2)
            if "memory" in controllers.split(",") or self.version == 2 and number == "0":
                return path
        return "/"

    def adopt(self, process):
        """Its children, from now on, belong to the group too; those that there are as well."""
        write(self.folder / "cgroup.procs", process)
        for child in pathlib.Path(f"/proc/{process}/task/{process}/children").read_text().split():
            with contextlib.suppress(OSError):  # it has ended
                write(self.folder / "cgroup.procs", child)

    def command(self, *command):
        """The command, to be run in the group."""
        tee = "tee" if os.geteuid() == 0 else "sudo -n tee"
        join = f"echo $$ | {tee} {self.folder}/cgroup.procs >/dev/null && exec \"$@\""
        return ["sh", "-c", join, "sh", *map(str, command)]

    def forget_peak(self):
        """In version 2 the peak is that since the group was made: few kernels can forget it."""
        if self.version == 1:
            write(self.folder / "memory.max_usage_in_bytes", 0)

    def figures(self):
        """Most memory that was taken; how often the limit was hit; processes killed for it."""
        def number(name, key=None):
            path = self.folder / name
            if not path.exists():
                return None
            if key is None:
                return int(path.read_text())
            return next((int(value) for found, value in map(str.split, path.read_text().splitlines())
                         if found == key), None)

        if self.version == 1:
            return {"peak": number("memory.max_usage_in_bytes"), "hits": number("memory.failcnt"),
                    "killed": number("memory.oom_control", "oom_kill")}
        return {"peak": number("memory.peak"), "hits": number("memory.events", "max"),
                "killed": number("memory.events", "oom_kill")}
