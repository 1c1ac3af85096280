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

    def test_lines(self):
        """Lines and fixed edges are layers as well, with heights at their corners; of a mesh that has got another name since."""
        abacus.psql("""SELECT abacus_constrain('survey', $$ SELECT 1 + i, ST_GeomFromText(format('MULTILINESTRING Z((%s 50 %s, %s 400 8), (600 %s 9, 900 %s 10))',
            100 + 10 * i, 7 + i, 500 + 10 * i, 10 + 20 * i, 11 + 20 * i), 25832) FROM generate_series(0, 3) AS i $$, z => 'height')""")
        abacus.psql("ALTER TABLE survey RENAME TO outcome; ALTER TABLE survey_vertices RENAME TO outcome_vertices; ALTER TABLE survey_lines RENAME TO outcome_lines")
        try:
            given, edges = layer("survey_breaklines"), layer("survey_fixed_edges")
            listed = subprocess.run(["ogrinfo", "-so", f"PG:dbname={abacus.rows('SELECT current_database()')[0][0]}", "survey_fixed_edges"],
                                    check=True, capture_output=True, text=True).stdout
        finally:
            abacus.psql("ALTER TABLE outcome RENAME TO survey; ALTER TABLE outcome_vertices RENAME TO survey_vertices; ALTER TABLE outcome_lines RENAME TO survey_lines")
        self.assertIn("Geometry: 3D Line String", listed)
        self.assertRegex(listed, r"lines: Integer64List|lines: IntegerList")
        self.assertEqual([f["properties"]["line"] for f in given], [1, 2, 3, 4])
        for feature in given:
            self.assertEqual(feature["geometry"]["type"], "MultiLineString")
            self.assertEqual([len(part) for part in feature["geometry"]["coordinates"]], [2, 2])
        corners = numpy.array([place for f in edges for place in f["geometry"]["coordinates"]])
        self.assertEqual(len(corners), 16)
        at = {(float(x), float(y)): float(h) for x, y, h in abacus.numbers("SELECT x, y, coalesce(attributes[1], 'NaN') FROM abacus_vertices('survey')")}
        numpy.testing.assert_array_equal(corners[:, 2], [at[x, y] for x, y in corners[:, :2]])
        total = float(abacus.rows("SELECT sum(length) FROM abacus_edges('survey', fixed => true)")[0][0])
        self.assertAlmostEqual(sum(f["properties"]["length"] for f in edges), total, 6)
        # the window of a layer
        part = layer("survey_fixed_edges", "-spat", "100", "100", "200", "200")
        self.assertTrue(0 < len(part) < len(edges))


if __name__ == "__main__":
    unittest.main()
