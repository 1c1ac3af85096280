"""What stands above a table: the versions of Abacus and of its peers, and the machine."""
import re

from document import size

# The packages of an engine: {engine: [(what it is called, pattern of the package's name)]}
POSTGIS = [("PostGIS", r"postgresql-\d+-postgis-3"), ("GEOS", r"libgeos\d.*")]
CGAL = [("CGAL", "libcgal-dev")]
PEERS = {
    "cgal": CGAL, "cgal_parallel": [*CGAL, ("TBB", "libtbb-dev")], "tetgen": [("TetGen", r"libtet1\.\d")],
    "qhull": [("Qhull", r"libqhull-r8\.\d")], "postgis": POSTGIS, "postgis_kept": POSTGIS,
    "scipy": [("SciPy", "python3-scipy")], "matplotlib": [("matplotlib", "python3-matplotlib")],
    "gdal": [("GDAL", "gdal-bin")], "vtk": [("VTK", "python3-vtk9")], "p4est": [("p4est", "libp4est-dev")], "metis": [("METIS", "metis")],
    "cupy": [("CuPy", "cupy"), ("CUDA", "cuda")]}
SERVER = [("PostgreSQL", r"postgresql-\d+")]


def version(packages, pattern):
    """That of the program, without what Debian adds; None if there is no such package."""
    for name, found in packages.items():
        if re.fullmatch(pattern, name):
            return re.match(r"(?:\d+:)?(\d[\d.]*\d|\d|)", found)[1] or found
    return None


def versions(about, engines):
    """Words such as `CGAL 5.5.1`, of Abacus first, each once."""
    words = [f"Abacus {about['abacus']}" if about.get("abacus") else f"Abacus of commit {about['commit']}"]
    for what, pattern in [*SERVER, *(entry for engine in PEERS if engine in engines for entry in PEERS[engine])]:
        found = version(about["packages"], pattern)
        if found and f"{what} {found}" not in words:
            words.append(f"{what} {found}")
    return words


def machine(about):
    gpu = f" and one {about['gpu']}" if about.get("gpu") else ""
    return f"{about['cores']} core{'s' * (about['cores'] != 1)} of {about['cpu']}{gpu}, {size(about['memory_bytes'])} of memory"


def head(about, engines):
    """A paragraph above a table that has measurements of these engines."""
    return f"{', '.join(versions(about, engines))}; {machine(about)}:\n\n"
