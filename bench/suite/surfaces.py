"""The part that takes surfaces out of a mesh in space: an isosurface beside VTK's, a section, a picture of what is inside."""
import json
import shutil
import subprocess

import paths
import server

VELOCITY = 1000  # m/s; its surface lies in the sediments


class Surfaces:
    """Of the points of an earthquake model; `frequencies` (Hz) tell how many."""

    def __init__(self, frequencies):
        self.frequencies = frequencies

    def measure(self, suite):
        self.suite = suite
        self.runs = {"full": 5, "quick": 3, "smoke": 1}[suite.mode]
        server.create_extension("abacus_lab")
        server.restart(shared_buffers="2GB" if suite.mode == "full" else "128MB")
        try:
            server.drop("mesh", "mesh_vertices", "points")
            server.query(f"CREATE TABLE points AS SELECT id, x, y, z, vs FROM abacus_quake({self.frequencies[suite.mode]})")
            server.query("SELECT abacus_triangulate('mesh', 'TABLE points', '{vs}', dimension => 3)")
            server.query("VACUUM (FREEZE, ANALYZE) mesh")
            self.points = int(server.query("SELECT count(*) FROM points"))
            self.timed("isosurface", f"SELECT count(*) FROM abacus_isosurface('mesh', {VELOCITY})")
            self.beside_vtk()
            middle = server.query("SELECT ARRAY[min(x) + max(x), min(y) + max(y), min(z) + max(z)]::text FROM points")
            middle = ",".join(str(float(sum) / 2) for sum in middle.strip("{}").split(","))
            self.timed("section", f"SELECT count(*) FROM abacus_section('mesh', '{{{middle}}}', '{{1,1,0.5}}')")
            self.timed("picture of the inside", "SELECT length(abacus_draw_volume('mesh', attribute => 'vs'))")
        finally:
            server.restart()
        server.drop("mesh", "mesh_vertices", "points")

    def record(self, question, engine, samples):
        self.suite.measurements.append({"what": "surface", "question": question, "engine": engine, "points": self.points,
                                        "samples": samples})
        least = min(sample["wall"] for sample in samples)
        self.suite.say(f"  {question:24} {engine:8} {least:9.4f} s")

    def timed(self, question, statement):
        """With the settings that a session has; the first time is not counted."""
        with server.Session(max_parallel_workers_per_gather=0) as session:
            session.run(statement)
            samples = [session.timed(statement) for _ in range(self.runs)]
        for sample in samples:
            sample["answers"] = int(sample.pop("printed"))
        self.record(question, "abacus", samples)

    def beside_vtk(self):
        """What VTK's contour filter takes, of the same tetrahedra in memory."""
        folder = paths.DATA / "surfaces"
        folder.mkdir(parents=True, exist_ok=True)
        try:
            for name, query in ("points", "SELECT x, y, z, vs FROM points ORDER BY id"), \
                               ("tetrahedra", "SELECT v0, v1, v2, v3 FROM abacus_simplices('mesh')"):
                with open(folder / f"{name}.csv", "w") as file:
                    subprocess.run(["psql", "-X", "-q", "-c", f"COPY ({query}) TO STDOUT (FORMAT csv)"], stdout=file, check=True)
            printed = subprocess.run(["/usr/bin/python3", paths.ROOT / "bench/suite/vtk_contour.py", folder, str(self.runs),
                                      str(VELOCITY)], stdout=subprocess.PIPE, text=True, check=True).stdout
        finally:
            shutil.rmtree(folder)
        self.record("isosurface", "vtk", json.loads(printed))
