"""A file is read in a process of its own, with an end to its time and memory: what is cut off or made to harm ends with an error.

The process sends a line of JSON and the arrays that it names, as numpy writes them.
"""
import contextlib
import json
import os
import pathlib
import resource
import signal
import subprocess
import sys

import numpy

from .grid import Grid
from .plan import Plan
from .psql import Failed

SECONDS, BYTES_A_SECOND = 20, 100_000  # of processor time
GROUPS = ("cells", "data", "labels", "markers", "codes")  # of arrays
MEMORY, TIMES = 2 << 30, 100  # so many bytes, and for each of the file's


def limits(size):
    physical = os.sysconf("SC_PAGE_SIZE") * os.sysconf("SC_PHYS_PAGES")
    return SECONDS + size // BYTES_A_SECOND, min(MEMORY + TIMES * size, max(physical, MEMORY))


class Pipe:
    """A pipe as numpy takes it: it asks for the position of whatever is a file."""

    def __init__(self, file):
        self.read, self.write = file.read, file.write


def size_of(path):
    """The bytes of a file and of those beside it that its reader reads, too."""
    from . import read
    beside = getattr(read.reader(path), "beside", lambda path: [])(path)
    return sum(file.stat().st_size for file in {pathlib.Path(path), *beside} if file.is_file())


def send(grid, out):
    named = {("points",): grid.points, **({("ids",): grid.ids} if grid.ids is not None else {})}
    for group in GROUPS:
        for key, values in getattr(grid, group).items():
            named[group, key] = values
    if grid.plan:
        named.update({("plan", key): values for key, values in grid.plan.arrays().items()})
    out.write(json.dumps({"arrays": list(named), "notes": grid.notes, "groups": grid.groups, "srid": grid.srid,
                          "regions": grid.plan.regions if grid.plan else None}).encode() + b"\n")
    for values in named.values():
        numpy.lib.format.write_array(Pipe(out), numpy.ascontiguousarray(values), allow_pickle=False)


def receive(line, source):
    head = json.loads(line)
    if "failed" in head:
        raise Failed(head["failed"])
    grid = Grid(None, {}, groups=head["groups"], notes=head["notes"])
    grid.srid = head["srid"]
    if head["regions"] is not None:
        grid.plan = Plan(head["regions"])
    for group, *key in head["arrays"]:
        values = numpy.lib.format.read_array(Pipe(source), allow_pickle=False)
        if group == "plan":
            setattr(grid.plan, key[0], values)
        elif key:
            getattr(grid, group)[tuple(key[0]) if isinstance(key[0], list) else key[0]] = values
        else:
            setattr(grid, group, values)
    return grid


def limit(path):
    """Ends this process where reading the file takes too long, or too much memory; returns how much it may take. Processes that it starts may
    have other memory."""
    seconds, memory = limits(size_of(path))
    for kind, value in (resource.RLIMIT_CPU, seconds), (resource.RLIMIT_AS, memory), (resource.RLIMIT_CORE, 0):
        try:
            resource.setrlimit(kind, (value, resource.getrlimit(kind)[1] if kind == resource.RLIMIT_AS else value))
        except (ValueError, OSError):  # a lower one is set, or the system has none
            pass
    return memory


def main(path, work):
    """In the process apart: work(out) reads the file, and sends what it has found. What goes wrong is the last line that is sent."""
    out = os.fdopen(os.dup(1), "wb")
    os.dup2(2, 1)  # what a library prints is no answer
    memory = limit(path)
    try:
        work(out)
    except BrokenPipeError:  # nobody reads on
        os._exit(1)
    except Failed as error:
        said = str(error)
    except MemoryError:
        said = f"takes more memory than {memory >> 20} MB to read; it may be cut off or damaged"
    except RecursionError:
        said = "cannot be read: it is nested too deeply"
    except Exception as error:  # of any library
        said = f"cannot be read: {error or type(error).__name__}"
    else:
        said = None
    if said:
        out.write(json.dumps({"failed": said}).encode() + b"\n")
    out.close()


def send_grid(path, options, out):
    from . import read
    grid = read.read_here(path, **options)
    grid.check()
    send(grid, out)


def died(status, size):
    seconds, memory = limits(size)
    if status in (-signal.SIGXCPU, -signal.SIGKILL):
        return f"was not read within {seconds} s of processor time or {memory >> 20} MB; it may be cut off or damaged"
    return f"cannot be read: its reader ended with status {status}"


@contextlib.contextmanager
def process(path, work, *options):
    """One that calls a function of this package, module.name, with the path, options and its output."""
    if not os.path.isfile(path):
        raise Failed("is not a file" if os.path.exists(path) else "No such file")
    module, name = work.split(".")
    code = (f"import sys; sys.path[:] = {sys.path!r}; from abacus_files import apart, {module}; "
            f"apart.main(sys.argv[1], lambda out: {module}.{name}(sys.argv[1], *{options!r}, out))")
    reader = subprocess.Popen([sys.executable, "-c", code, path], stdout=subprocess.PIPE, env=dict(os.environ, OPENBLAS_NUM_THREADS="1"),
                              preexec_fn=lambda: signal.signal(signal.SIGINT, signal.SIG_IGN))  # Ctrl-C ends it by way of this process
    try:
        yield reader
    finally:
        reader.stdout.close()
        if sys.exc_info()[0]:
            reader.kill()
        reader.wait()


def read(path, **options):
    """The grid of a file."""
    grid = None
    with process(path, "apart.send_grid", options) as reader:
        try:
            line = reader.stdout.readline()
            grid = receive(line, reader.stdout) if line.endswith(b"\n") else None
        except ValueError:  # it died while it sent
            pass
    if grid is None or reader.returncode != 0:
        raise Failed(died(reader.returncode, size_of(path)))
    return grid
