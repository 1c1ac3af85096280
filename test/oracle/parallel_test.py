#!/usr/bin/python3
"""The examples of docs/parallel.md and of the cookbook's waves, with four ranks of Open MPI: against one rank, against the solution that is known and
another solver's, and the steps in SQL."""
import os
import subprocess
import unittest

import numpy
import scipy.sparse.linalg

import abacus

EXAMPLES = abacus.REPOSITORY / "client/examples"


def points(dimension, cells):
    """A grid whose inner points are moved."""
    grid = numpy.stack(numpy.meshgrid(*[numpy.arange(cells + 1.0)] * dimension, indexing="ij"), axis=-1).reshape(-1, dimension)
    moved = grid + numpy.random.default_rng(5).uniform(-0.3, 0.3, grid.shape)
    return numpy.where((grid == 0) | (grid == cells), grid, moved) / cells


def solve(ranks, *arguments, example="heat.py"):
    environment = {**os.environ, "OMPI_ALLOW_RUN_AS_ROOT": "1", "OMPI_ALLOW_RUN_AS_ROOT_CONFIRM": "1", "OMP_NUM_THREADS": "1"}
    command = ["mpiexec", "--oversubscribe", "-n", str(ranks), "/usr/bin/python3", EXAMPLES / example, *map(str, arguments)]
    done = subprocess.run(command, env=environment, stdin=subprocess.DEVNULL, capture_output=True, text=True, timeout=300, check=False)
    if done.returncode != 0:
        raise AssertionError(done.stdout + done.stderr)
    return done.stdout


def errors(printed):
    return [float(line.split()[-1]) for line in printed.splitlines() if line.startswith("step")]


class Parallel(unittest.TestCase):
    def compare(self, dimension, cells, most):
        """Four ranks and one, and the solution that is known: the error shrinks with the edges."""
        for mesh in "heat_of_four", "heat_of_one":
            abacus.triangulate(mesh, points(dimension, cells))
        self.assertLess(max(errors(solve(4, "heat_of_four", 3))), most)
        solve(1, "heat_of_one", 3)
        for mesh, parts in ("heat_of_four", 4), ("heat_of_one", 1):
            self.assertEqual(abacus.rows(f"SELECT step, parts, stored, vertices, whole FROM abacus_steps('{mesh}')"),
                             [[str(step), str(parts), str(parts), str((cells + 1) ** dimension), "t"] for step in (1, 2, 3)])
        both = abacus.numbers('SELECT a."values"[1], b."values"[1] FROM heat_of_four_steps AS a JOIN heat_of_one_steps AS b USING (step, id)')
        self.assertEqual(len(both), 3 * (cells + 1) ** dimension)
        numpy.testing.assert_allclose(both[:, 0], both[:, 1], rtol=0, atol=1e-10)

    def test_plane(self):
        self.compare(2, 12, 0.02)
        # what a station inside a triangle records
        record = abacus.numbers("SELECT step, sum(weight * s.\"values\"[1]) FROM abacus_weights('heat_of_four', 0.43, 0.52) AS w "
                                "JOIN heat_of_four_steps AS s ON s.id = w.vertex GROUP BY step ORDER BY step")
        decay = numpy.exp(-2 * numpy.pi ** 2 * 0.002 * record[:, 0])
        numpy.testing.assert_allclose(record[:, 1], numpy.sin(numpy.pi * 0.43) * numpy.sin(numpy.pi * 0.52) * decay, atol=0.02)

    def test_space(self):
        self.compare(3, 6, 0.08)

    def test_standing_wave(self):
        """The wave that is known; no energy is lost."""
        for dimension, cells, most in (2, 16, 0.06), (3, 7, 0.2):
            mesh = f"waves_standing_{dimension}"
            abacus.triangulate(mesh, points(dimension, cells))
            printed = solve(4, mesh, 10, 0.05, "standing", example="waves.py")
            self.assertLess(max(errors(printed)), most)
            energies = [float(line.split()[3]) for line in printed.splitlines()]
            numpy.testing.assert_allclose(energies, energies[0], rtol=1e-9)

    def test_earthquake(self):
        """A pulse in the earthquake model: four ranks, one, and a direct solver that assembles the equations from SQL."""
        abacus.psql("CREATE EXTENSION IF NOT EXISTS abacus_lab; DROP TABLE IF EXISTS waves_ground, waves_of_four, waves_of_one CASCADE;"
                    "CREATE TABLE waves_ground AS SELECT id, x, y, z, vs, density FROM abacus_quake(0.01);"
                    "SELECT abacus_triangulate('waves_of_four', 'TABLE waves_ground', dimension => 3);"
                    "SELECT abacus_triangulate('waves_of_one', 'TABLE waves_ground', dimension => 3)")
        steps, time, pulse = 12, 0.5, (50000, 50000, -10000, 6000)
        start = ",".join(map(str, pulse))
        for ranks, mesh in (4, "waves_of_four"), (1, "waves_of_one"):
            solve(ranks, mesh, steps, time, start, example="waves.py")
        both = abacus.numbers('SELECT a."values"[1], b."values"[1] FROM waves_of_four_steps AS a JOIN waves_of_one_steps AS b USING (step, id)')
        numpy.testing.assert_allclose(both[:, 0], both[:, 1], rtol=0, atol=1e-9)
        ground = abacus.numbers("SELECT id, x, y, z, vs, density FROM waves_ground ORDER BY id")
        corners = numpy.searchsorted(ground[:, 0], abacus.numbers("SELECT v0, v1, v2, v3 FROM abacus_simplices('waves_of_four')"))
        u = self.newmark(ground[:, 1:4], corners, ground[:, 4], ground[:, 5], numpy.exp(-((ground[:, 1:4] - pulse[:3]) ** 2).sum(axis=1) / (2 * pulse[3] ** 2)), steps, time)
        last = abacus.numbers(f'SELECT id, "values"[1] FROM waves_of_four_steps WHERE step = {steps} AND id IS NOT NULL ORDER BY id')
        self.assertGreater(numpy.abs(u).max(), 0.01)
        numpy.testing.assert_allclose(last[:, 1], u, rtol=0, atol=1e-8)
        # a seismogram by weights, and by the step as an argument
        record = abacus.numbers("SELECT sum(weight * s.\"values\"[1]), abacus_interpolate('waves_of_four', 51000, 46500, -100, '1', step => step) FROM "
                                "abacus_weights('waves_of_four', 51000, 46500, -100) AS w JOIN waves_of_four_steps AS s ON s.id = w.vertex GROUP BY step")
        self.assertEqual(len(record), steps + 1)
        numpy.testing.assert_allclose(record[:, 0], record[:, 1], rtol=0, atol=1e-12)

    @staticmethod
    def newmark(points, corners, speed, density, u, steps, time):
        """Element by element, with the formulas of the book: for a tetrahedron of volume V, ∫ φᵢφⱼ = V (1 + δᵢⱼ) / 20."""
        count = len(points)
        mass, stiffness = scipy.sparse.lil_matrix((count, count)), scipy.sparse.lil_matrix((count, count))
        for simplex in corners:
            coordinates = numpy.column_stack([numpy.ones(4), points[simplex]])
            volume, gradients = abs(numpy.linalg.det(coordinates)) / 6, numpy.linalg.inv(coordinates)[1:]
            rho = density[simplex].mean()
            mass[numpy.ix_(simplex, simplex)] += rho * volume * (1 + numpy.eye(4)) / 20
            stiffness[numpy.ix_(simplex, simplex)] += rho * speed[simplex].mean() ** 2 * volume * (gradients.T @ gradients)
        mass, stiffness = mass.tocsc(), stiffness.tocsc()
        a, v = scipy.sparse.linalg.spsolve(mass, -stiffness @ u), numpy.zeros(count)
        system = scipy.sparse.linalg.splu(mass + time ** 2 / 4 * stiffness)
        for _ in range(steps):
            ahead = u + time * v + time ** 2 / 4 * a
            after = system.solve(-stiffness @ ahead)
            u, v, a = ahead + time ** 2 / 4 * after, v + time / 2 * (a + after), after
        return u

    def test_plex(self):
        """A DMPlex of a share: its cells, vertices and coordinates."""
        abacus.triangulate("heat_plex", points(3, 5))
        program = ("import sys; sys.path.insert(0, sys.argv[1]); import heat, ranks, numpy; share = heat.abacus_share.read('heat_plex', 4, 1)\n"
                   "plex = ranks.PETSc.DMPlex().createFromCellList(share.points.shape[1], share.simplices.astype(ranks.PETSc.IntType), share.points, interpolate=True, comm=ranks.PETSc.COMM_SELF)\n"
                   "first, end = plex.getDepthStratum(0); facets = plex.getHeightStratum(1)\n"
                   "assert plex.getHeightStratum(0) == (0, len(share.simplices)) and (first, end) == (len(share.simplices), len(share.simplices) + len(share.id))\n"
                   "assert (plex.getCoordinates().getArray().reshape(-1, 3) == share.points).all()\n"
                   "assert facets[1] - facets[0] == len({tuple(sorted(set(cell) - {corner})) for cell in share.simplices.tolist() for corner in cell})\n")
        done = subprocess.run(["/usr/bin/python3", "-c", program, str(EXAMPLES)], stdin=subprocess.DEVNULL, capture_output=True, text=True, check=False)
        self.assertEqual((done.returncode, done.stderr), (0, ""))

    def test_adaptive_step(self):
        abacus.triangulate("heat_refined", points(2, 12))
        printed = solve(4, "heat_refined", 4, 2)
        self.assertRegex(printed, r"refined: \d+ points more; \d+ of 169 vertices have moved")
        self.assertLess(max(errors(printed)), 0.02)
        steps = abacus.numbers("SELECT step, vertices, whole::int FROM abacus_steps('heat_refined')")
        self.assertEqual(steps[:2].tolist(), [[1, 169, 1], [2, 169, 1]])
        more = int(abacus.numbers("SELECT count(*) FROM abacus_vertices('heat_refined')")[0, 0])
        self.assertGreater(more, 169)
        self.assertEqual(steps[2:].tolist(), [[3, more, 1], [4, more, 1]])
        self.assertEqual(abacus.rows("SELECT * FROM abacus_check('heat_refined')"), [])


if __name__ == "__main__":
    unittest.main()
