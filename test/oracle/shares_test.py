#!/usr/bin/python3
"""Parts of a mesh and shares of them against brute force, read by the client: 1 to 9 parts, halos of 0 to 3 layers, in the plane and in space, also in
loaded meshes with holes, with simplices that share a vertex alone, and with split nodes."""
import sys
import unittest

import numpy

import abacus

sys.path.insert(0, str(abacus.REPOSITORY / "client"))

import abacus_share


class Whole:
    """A mesh as all parts have it, and what follows from that."""

    def __init__(self, snapshot, mesh, parts, weight=None):
        self.snapshot, self.mesh, self.parts, self.weight = snapshot, mesh, parts, weight
        self.own = [self.read(part, 0) for part in range(parts)]
        self.owner = {key: part for part, share in enumerate(self.own) for key in keys(share)}  # of simplices
        self.at = {}  # the simplices at a vertex
        for key in self.owner:
            for corner in key[1:]:
                self.at.setdefault(corner, []).append(key)

    def read(self, part, halo):
        return self.snapshot.share(self.mesh, self.parts, part, halo, self.weight)

    def owner_of(self, vertex):
        return min(self.owner[key] for key in self.at[vertex])

    def layers(self, part, most):
        """The simplices of the share with 0 layers, 1, and so on."""
        simplices = {key for key, owner in self.owner.items() if owner == part}
        for _ in range(most + 1):
            yield simplices
            simplices = simplices | {key for simplex in simplices for corner in simplex[1:] for key in self.at[corner]}

    def sizes(self):
        owners = [self.owner_of(vertex) for vertex in self.at]
        facets = {}
        for key, owner in self.owner.items():
            for corner in key[1:]:
                facets.setdefault(frozenset(key[1:]) - {corner}, []).append(owner)
        cut = [0] * self.parts
        for sides in facets.values():
            for side in sides:
                cut[side] += any(other != side for other in sides)
        for part in range(self.parts):
            own, more = list(self.layers(part, 1))
            yield [part, owners.count(part), len(own), cut[part], len(more) - len(own)]


def keys(share):
    """Code and ids of the corners of each simplex."""
    return [(code, *corners) for code, corners in zip(share.code.tolist(), share.id[share.simplices].tolist())]


class Shares(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        random = numpy.random.default_rng(12)
        abacus.triangulate("share_plane", random.random((400, 2)), load=random.random(400) ** 4)
        abacus.triangulate("share_space", random.random((150, 3)), load=random.random(150) ** 4)
        cls.cut_out("share_plane", 2, random)
        cls.cut_out("share_space", 3, random)
        cls.split("share_plane", 2)
        cls.split("share_space", 3)
        abacus.psql("SELECT abacus_label('share_plane', 'SELECT code, v0, v1, v2, CASE WHEN code % 3 = 0 THEN 1e300 WHEN code % 3 = 1 THEN 1e-300 END AS work"
                    " FROM abacus_simplices(''share_plane'')')")
        # the numbers of a regular grid: many points on a hyperplane, and ties
        grid = numpy.stack(numpy.meshgrid(*[numpy.arange(6.0)] * 3), axis=-1).reshape(-1, 3)
        abacus.triangulate("share_grid", grid)
        cls.snapshot = cls.enterClassContext(abacus_share.Snapshot())

    @staticmethod
    def points_of(mesh, dimension):
        return f"SELECT id, {', '.join('xyz'[:dimension])} FROM {mesh}_points"

    @classmethod
    def cut_out(cls, mesh, dimension, random):
        """Half of the simplices: pieces that hang together at a vertex, or at an edge."""
        corners = abacus.simplices(mesh, dimension + 1) + 1
        corners = corners[random.random(len(corners)) < 0.5]
        abacus.store(f"{mesh}_left", [f"v{i}" for i in range(dimension + 1)], corners)
        columns = ", ".join(f"v{i}::bigint" for i in range(dimension + 1))
        abacus.psql(f"DROP TABLE IF EXISTS {mesh}_holes CASCADE")
        abacus.psql(f"SELECT abacus_load('{mesh}_holes', '{cls.points_of(mesh, dimension)}', 'SELECT {columns} FROM {mesh}_left')")

    @classmethod
    def split(cls, mesh, dimension):
        """Each of two halves has vertices of its own, so they touch without a common vertex."""
        corners = abacus.simplices(mesh, dimension + 1) + 1
        points = abacus.numbers(cls.points_of(mesh, dimension))
        x = points[numpy.argsort(points[:, 0]), 1]
        far = x[corners - 1].mean(axis=1) > 0.5
        corners[far] += 1000
        beyond = points[numpy.isin(points[:, 0] + 1000, corners[far])].copy()
        beyond[:, 0] += 1000
        nodes = numpy.vstack([points[numpy.isin(points[:, 0], corners[~far])], beyond])
        axes = "xyz"[:dimension]
        abacus.store(f"{mesh}_nodes", ["node", *axes], nodes)
        abacus.store(f"{mesh}_elements", [f"v{i}" for i in range(dimension + 1)], corners)
        columns = ", ".join(f"v{i}::bigint" for i in range(dimension + 1))
        abacus.psql(f"DROP TABLE IF EXISTS {mesh}_split CASCADE")
        abacus.psql(f"SELECT abacus_load('{mesh}_split', 'SELECT node::bigint, {', '.join(axes)} FROM {mesh}_nodes', 'SELECT {columns} FROM {mesh}_elements', split_nodes => true)")

    def compare(self, mesh, parts, most_halo, weight=None):
        corners = 3 if "plane" in mesh else 4
        whole = Whole(self.snapshot, mesh, parts, weight)
        theirs = abacus.rows(f"SELECT code, {', '.join(f'v{i}' for i in range(corners))} FROM abacus_simplices('{mesh}')")
        self.assertEqual(sorted(key for share in whole.own for key in keys(share)), sorted(tuple(map(int, row)) for row in theirs))
        sizes = [len(share.code) for share in whole.own]
        if weight is None:
            self.assertLessEqual(max(sizes) - min(sizes), 1)
        codes = [share.code for share in whole.own if len(share.code)]
        for before, after in zip(codes, codes[1:]):
            self.assertLessEqual(before.max(), after.min())
        argument = "" if weight is None else f", '{weight}'"
        self.assertEqual(abacus.numbers(f"SELECT * FROM abacus_partition('{mesh}', {parts}{argument})").astype(int).tolist(), list(whole.sizes()))
        places = {int(row[0]): row[1:] for row in abacus.numbers(f"SELECT id, {', '.join('xyz'[:corners - 1])} FROM abacus_vertices('{mesh}')")}
        for part in range(parts):
            for halo, expected in enumerate(whole.layers(part, most_halo)):
                share = whole.read(part, halo)
                found = keys(share)
                self.assertEqual(len(found), len(expected))
                self.assertEqual(set(found), expected)
                self.assertEqual(share.simplex_owner.tolist(), [whole.owner[key] for key in found])
                self.assertEqual(set(share.id.tolist()), {corner for key in expected for corner in key[1:]})
                self.assertEqual(len(set(share.id.tolist())), len(share.id))
                self.assertEqual(share.owner.tolist(), [whole.owner_of(vertex) for vertex in share.id.tolist()])
                ranks = [(owner != part, owner) for owner in share.owner.tolist()]
                self.assertEqual(ranks, sorted(ranks))
                self.assertEqual(share.own, share.owner.tolist().count(part))
                for vertex, point in zip(share.id.tolist(), share.points):
                    self.assertEqual(point.tolist(), places[vertex].tolist())

    def test_brute_force(self):
        for kind in "plane", "space":
            for suffix in "", "_holes", "_split":
                for parts, halo in (1, 1), (2, 3), (4, 2), (9, 1):
                    with self.subTest(mesh=kind + suffix, parts=parts):
                        self.compare(f"share_{kind}{suffix}", parts, halo)

    def test_ties(self):
        for parts in 5, 8:
            self.compare("share_grid", parts, 2)

    def test_weights(self):
        self.compare("share_plane", 4, 1, "load")
        self.compare("share_space", 3, 1, "load")
        self.compare("share_plane", 3, 1, "work")
        for mesh in "share_plane", "share_space":
            shares = [self.snapshot.share(mesh, 5, part, 0, "load") for part in range(5)]
            weights = [share.attribute("load")[share.simplices].mean(axis=1) for share in shares]
            mean, most = sum(map(numpy.sum, weights)) / 5, max(map(numpy.max, weights))
            self.assertTrue(all(abs(weight.sum() - mean) <= most * (1 + 1e-9) for weight in weights))
        great = [int((self.snapshot.share("share_plane", 4, part, 0, "work").label("work") > 1).sum()) for part in range(4)]
        self.assertLessEqual(max(great) - min(great), 1)

    def test_snapshot(self):
        """Ranks that read one snapshot see one state, whatever happens meanwhile."""
        abacus.triangulate("share_moving", numpy.random.default_rng(3).random((300, 2)))
        with abacus_share.Snapshot() as snapshot:
            first = snapshot.share("share_moving", 2, 0)
            abacus.psql("SELECT abacus_delete('share_moving', 'SELECT id, x, y FROM share_moving_points WHERE id % 2 = 0')")
            with abacus_share.Snapshot(name=snapshot.name) as other:
                second = other.share("share_moving", 2, 1)
        ids = set(first.id[:first.own].tolist()) | set(second.id[:second.own].tolist())
        self.assertEqual(ids, set(range(1, 301)))
        self.assertEqual(set(abacus_share.read("share_moving", 1, 0).id.tolist()), set(range(1, 301, 2)))
        with self.assertRaisesRegex(abacus_share.Failed, "part must be between 0 and 1, not 2"):
            abacus_share.read("share_moving", 2, 2)


if __name__ == "__main__":
    unittest.main()
