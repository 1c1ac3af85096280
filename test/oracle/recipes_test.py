"""Recipes of the cookbook that need a shell: their commands and statements run in turn, and what GDAL has written is read."""
import json
import os
import pathlib
import re
import subprocess
import tempfile
import unittest

import abacus

BLOCK = re.compile(r"^```(sh|sql)\n(.*?)^```\n(?:\n*^```text\n(.*?)^```\n)?", re.M | re.S)
DATABASE = "abacus_recipes"


def ogr(path, layer, sql=None):
    """The features of a layer as GDAL reads them."""
    with tempfile.TemporaryDirectory() as folder:
        target = pathlib.Path(folder) / "out.geojson"
        subprocess.run(["ogr2ogr", "-f", "GeoJSON", "-lco", "RFC7946=NO", str(target), str(path), *(["-sql", sql] if sql else [layer])], check=True, capture_output=True)
        return json.loads(target.read_text())["features"]


class Recipes(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.folder = tempfile.TemporaryDirectory()
        cls.at = pathlib.Path(cls.folder.name)
        cls.environment = dict(os.environ, PGDATABASE=DATABASE)
        abacus.psql(f"DROP DATABASE IF EXISTS {DATABASE}")
        abacus.psql(f"CREATE DATABASE {DATABASE}")
        cls.psql("CREATE EXTENSION abacus_postgis CASCADE")

    @classmethod
    def tearDownClass(cls):
        abacus.psql(f"DROP DATABASE {DATABASE}")
        cls.folder.cleanup()

    @classmethod
    def psql(cls, sql):
        done = subprocess.run(["psql", "-X", "-q"], input=sql, text=True, env=cls.environment, cwd=cls.at, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, check=True)
        return done.stdout

    def test_surfaces_for_geologists(self):
        page = (abacus.REPOSITORY / "docs/cookbook/surfaces-for-geologists.md").read_text()
        for language, block, _ in BLOCK.findall(page):
            if language == "sql" and "CREATE EXTENSION" in block:  # the other examples of documents compare its output
                self.psql(block.replace("CREATE EXTENSION abacus;", ""))
            elif language == "sh":
                commands = block.replace("client/", f"{abacus.REPOSITORY}/client/").replace("-d survey", f"-d {DATABASE}")
                done = subprocess.run(["bash", "-e", "-c", commands], text=True, env=self.environment, cwd=self.at, capture_output=True)
                self.assertEqual(done.returncode, 0, done.stderr)
        self.assertEqual(sorted(path.name for path in self.at.glob("*.glb")), ["lower.glb", "shell.glb", "shells.glb", "units.glb"])
        self.assertIn("'origin': [512", done.stdout)

    def test_lines_of_cad(self):
        page = (abacus.REPOSITORY / "docs/cookbook/lines-of-cad.md").read_text()
        for language, block, wanted in BLOCK.findall(page):
            if language == "sh":
                done = subprocess.run(["bash", "-e", "-c", block.replace("dbname=survey", f"dbname={DATABASE}")], text=True, env=self.environment, cwd=self.at, capture_output=True)
                self.assertEqual((done.returncode, done.stderr), (0, ""), block)
            else:
                tidy = lambda text: [line.rstrip() for line in text.strip().split("\n")]
                found = self.psql(block)
                self.assertEqual(tidy(found), tidy(wanted), found)
        package = self.at / "terrain.gpkg"
        triangles = ogr(package, "triangles")
        count, area = self.psql("COPY (SELECT triangles, area FROM abacus_regions('terrain')) TO STDOUT").split()
        self.assertEqual((len(triangles), area), (int(count), "936"))
        self.assertEqual({len(corner) for feature in triangles for corner in feature["geometry"]["coordinates"][0]}, {3})
        lines = {(feature["properties"]["line"], feature["properties"]["kind"]): feature["geometry"]["coordinates"] for feature in ogr(package, "lines")}
        self.assertEqual(lines[6, "hard"], [[400005, 5500015, 18], [400020, 5500017, 19], [400035, 5500015, 20]])
        self.assertEqual(len(lines[7, "soft"]), 5)
        self.assertGreater(len(ogr(package, "contours")), 3)
        entities = ogr(self.at / "terrain.dxf", "entities")
        self.assertEqual(sum(feature["properties"]["Layer"] == "TRIANGLES" for feature in entities), len(triangles))
        heights = {feature["properties"]["Layer"]: {corner[2] for corner in feature["geometry"]["coordinates"]} for feature in entities
                   if feature["properties"]["Layer"].startswith("CONTOUR")}
        self.assertEqual(heights["CONTOUR 17"], {17})


if __name__ == "__main__":
    unittest.main()
