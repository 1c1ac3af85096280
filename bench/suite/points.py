"""The points: one set in two forms, a table for the server and a file for the other engines."""
import contextlib
import subprocess

import paths
import server

COORDINATES = {2: "x, y", 3: "x, y, z"}


class PointSet:
    """`size` points of a set of oracle_points, or the shorelines of the world."""

    def __init__(self, dimension, name, size):
        self.dimension, self.name, self.size = dimension, name, size
        self.columns = COORDINATES[dimension]
        self.file = paths.DATA / f"{dimension}-{name}-{size}.raw"

    def command(self, form):
        if self.name == "shorelines":
            return [paths.ROOT / "scripts/gshhg_points.py", "f", form]
        return [paths.ORACLE_POINTS, str(self.dimension), self.name, str(self.size), form]

    @contextlib.contextmanager
    def in_file(self):
        """The points as raw records, as long as they are needed."""
        paths.DATA.mkdir(parents=True, exist_ok=True)
        try:
            with open(self.file, "wb") as file:
                subprocess.run(self.command("raw"), stdout=file, check=True)
            yield self.file
        finally:
            self.file.unlink(missing_ok=True)

    def create_table(self):
        """The table `points`, settled; their number."""
        server.drop("points", "mesh", "mesh_vertices")
        columns = self.columns.replace(",", " float8,") + " float8"
        with subprocess.Popen(self.command("copy"), stdout=subprocess.PIPE) as source:
            # In one transaction, so that the rows are frozen as they are copied.
            subprocess.run(["psql", "-X", "-q", "-v", "ON_ERROR_STOP=1", "-1",
                            "-c", f"CREATE TABLE points (id bigint, {columns})",
                            "-c", "COPY points FROM STDIN (FORMAT binary, FREEZE)"],
                           stdin=source.stdout, check=True)
        if source.returncode != 0:
            raise server.Failure(f"no points of {self.name}")
        server.query("VACUUM (FREEZE, ANALYZE) points")
        return int(server.query("SELECT count(*) FROM points"))

    def triangulate(self, condition="", mesh="mesh"):
        """The statement that makes the mesh of the table."""
        return (f"SELECT abacus_triangulate('{mesh}', 'SELECT id, {self.columns} FROM points"
                f"{condition}', dimension => {self.dimension})")
