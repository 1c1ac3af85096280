"""Records of a LAZ file, decompressed by laz-perf in a Node.js of its own (client/laz)."""
import json
import pathlib
import resource
import signal
import subprocess

from .psql import Failed

FOLDER = pathlib.Path(__file__).resolve().parent.parent / "laz"
MEMORY = 3 << 30  # bytes that it may write to; it reserves far more, so the limit of the reader's address space would end it at once


def install():
    """Brings laz-perf, when that has not been done."""
    done = subprocess.run([FOLDER / "install"], stdin=subprocess.DEVNULL, stderr=subprocess.PIPE, text=True, check=False)
    if done.returncode != 0:
        raise Failed(f"LAZ files are decompressed by laz-perf, which client/laz/install could not install: {done.stderr.strip()}")


def limit():
    """In the process of Node.js. It keeps the end to its processor time."""
    resource.setrlimit(resource.RLIMIT_AS, 2 * resource.getrlimit(resource.RLIMIT_AS)[1:])
    resource.setrlimit(resource.RLIMIT_DATA, (MEMORY, MEMORY))


def blocks(path, header, chunks, size):
    """The bytes of the records of chunks, so many records at once."""
    asked = {"path": str(path), "format": header.format, "length": header.length, "chunks": chunks}
    node = subprocess.Popen(["node", FOLDER / "decompress.js"], stdin=subprocess.PIPE, stdout=subprocess.PIPE, stderr=subprocess.PIPE, preexec_fn=limit)
    try:
        node.stdin.write(json.dumps(asked).encode())
        node.stdin.close()
        left = sum(points for _, _, points in chunks)
        while left:
            data = node.stdout.read(min(size, left) * header.length)
            if len(data) < min(size, left) * header.length:
                said = node.stderr.read(1 << 16).decode(errors="replace").strip()
                if node.wait() in (-signal.SIGXCPU, -signal.SIGKILL):
                    raise Failed("was not decompressed within its share of processor time; it may be damaged")
                raise Failed(said if node.returncode == 2 else f"cannot be decompressed: Node.js ended with status {node.returncode}: {said[-300:]}")
            yield data
            left -= len(data) // header.length
    finally:
        node.stdout.close()
        node.stderr.close()
        node.kill()
        node.wait()
