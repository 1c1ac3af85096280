#!/usr/bin/python3
"""A mesh as foreign tables, read by GDAL: by window, as layers of a database. Skipped without PostGIS or GDAL's programs."""
import json
import pathlib
import shutil
import subprocess
import tempfile
import unittest

import numpy

import abacus


def layer(name, *options):
    """The features of a layer as ogr2ogr reads them."""
    database = abacus.rows("SELECT current_database()")[0][0]
    with tempfile.TemporaryDirectory() as folder:
        file = pathlib.Path(folder, "part.json")
        subprocess.run(["ogr2ogr", "-f", "GeoJSON", "-lco", "COORDINATE_PRECISION=17", str(file), f"PG:dbname={database}", name, *options],
                       check=True, stderr=subprocess.PIPE)
        return json.loads(file.read_text())["features"]


class Layers(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        if not abacus.rows("SELECT FROM pg_available_extensions WHERE name = 'postgis'"):
            raise unittest.SkipTest("PostGIS is not installed")
        if shutil.which("ogr2ogr") is None:
            raise unittest.SkipTest("GDAL's programs are not installed")
        random = numpy.random.default_rng(5)
        points = random.random((20000, 2)) * 1000
        abacus.triangulate("survey", points, height=points[:, 0] + points[:, 1])
        abacus.psql("CREATE EXTENSION IF NOT EXISTS postgis")
        abacus.psql("SELECT abacus_publish('survey', cells => 'triangles', points => 'corners', srid => 25832, z => 'height')")

    def test_cells_of_a_window(self):
        features = layer("triangles", "-spat", "300", "400", "340", "450")
        found = sorted(tuple(f["properties"][v] for v in ("v0", "v1", "v2")) for f in features)
        ours = sorted(tuple(map(int, row)) for row in abacus.numbers(
            "SELECT v0, v1, v2 FROM triangles WHERE (geom && ST_MakeEnvelope(300, 400, 340, 450, 25832)) IS TRUE"))
        # depending on its version, GDAL includes or omits rows that meet the window only by their boxes
        meet = {tuple(map(int, row)) for row in abacus.numbers(
            "SELECT v0, v1, v2 FROM abacus_cells('survey', ARRAY[300, 400], ARRAY[340, 450])")}
        self.assertGreater(len(meet), 50)
        self.assertTrue(meet <= set(found) <= set(ours))
        for feature in features:
            ring = numpy.array(feature["geometry"]["coordinates"][0])
            self.assertEqual(ring.shape, (4, 3))
            self.assertLess(abs(ring[:, 2] - ring[:, 0] - ring[:, 1]).max(), 1e-9)
            self.assertAlmostEqual(ring[:3, 2].mean(), feature["properties"]["height"], 9)

    def test_points_of_a_condition(self):
        features = layer("corners", "-where", "height BETWEEN 100 AND 120", "-spat", "0", "0", "60", "1000")
        ours = abacus.numbers("SELECT id FROM survey_points WHERE height BETWEEN 100 AND 120 AND x <= 60")
        self.assertEqual(sorted(f["properties"]["id"] for f in features), sorted(ours[:, 0].astype(int)))
        self.assertGreater(len(features), 10)


if __name__ == "__main__":
    unittest.main()
