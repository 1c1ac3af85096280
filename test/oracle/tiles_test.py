#!/usr/bin/python3
"""Tiles as others read them: vector tiles by GDAL, which also puts them in their place, pictures of heights by matplotlib; against
what SQL says of the same places."""
import base64
import io
import json
import pathlib
import subprocess
import tempfile
import unittest

import matplotlib.image
import numpy

import abacus

ZOOM, X, Y = 11, 1069, 725
METRES = 20037508.342789244


def tile(call):
    return base64.b64decode(abacus.rows(f"SELECT translate(encode({call}, 'base64'), E'\\n', '')")[0][0])


def features(layer, encoded):
    """GDAL's, in metres of Web Mercator."""
    with tempfile.TemporaryDirectory() as folder:
        path = pathlib.Path(folder, "tile.pbf")
        path.write_bytes(encoded)
        text = subprocess.run(["ogr2ogr", "-f", "GeoJSON", "/vsistdout/", str(path), layer, "-oo", "CLIP=NO",
                               "-oo", f"X={X}", "-oo", f"Y={Y}", "-oo", f"Z={ZOOM}", "-lco", "RFC7946=NO",
                               "-t_srs", "EPSG:3857"], check=True, capture_output=True).stdout
    return json.loads(text)["features"]


def projected(lon, lat):
    """EPSG:3857 of a sphere."""
    return lon * METRES / 180, numpy.log(numpy.tan((90 + lat) * numpy.pi / 360)) * METRES / numpy.pi


def twice_area(ring):
    x, y = (numpy.array(ring) - ring[0]).T
    return (x[:-1] * y[1:] - x[1:] * y[:-1]).sum()


class Tiles(unittest.TestCase):
    unit = 2 * METRES / 2**ZOOM / 4096

    @classmethod
    def setUpClass(cls):
        random = numpy.random.default_rng(1)
        lon, lat = 7.7 + random.random(4000), 46 + random.random(4000)
        height = 900 + 500 * numpy.sin(9 * lon) * numpy.cos(7 * lat)
        abacus.triangulate("hills", numpy.stack([lon, lat], -1), height=height)
        abacus.psql("SELECT abacus_set_srid('hills', 4326)")
        west, east = (2 * METRES * (X + i) / 2**ZOOM - METRES for i in (0, 1))
        north, south = (METRES - 2 * METRES * (Y + i) / 2**ZOOM for i in (0, 1))
        cls.window = west, south, east, north

    def test_triangles_and_vertices(self):
        encoded = tile(f"abacus_tile_vector('hills', {ZOOM}, {X}, {Y})")
        west, south, east, north = self.window
        edge = 65 * self.unit
        cells = {}
        for v0, v1, v2, corners, values in abacus.rows("SELECT v0, v1, v2, corners, \"values\" FROM abacus_cells('hills')"):
            corners = abacus.vector(corners, 2)
            x, y = projected(*corners.T)
            if x.max() > west - edge and x.min() < east + edge and y.max() > south - edge and y.min() < north + edge:
                cells[frozenset(map(int, (v0, v1, v2)))] = abacus.vector(values, 1).mean(), x, y
        self.assertGreater(len(cells), 100)
        found = features("triangles", encoded)
        area = 0
        for feature in found:
            tags = feature["properties"]
            value, x, y = cells[frozenset((tags["v0"], tags["v1"], tags["v2"]))]
            self.assertAlmostEqual(tags["value"], value, places=6)
            self.assertEqual(feature["geometry"]["type"], "Polygon")
            for corner in feature["geometry"]["coordinates"][0]:
                self.assertTrue(x.min() - self.unit < corner[0] < x.max() + self.unit)
                self.assertTrue(y.min() - self.unit < corner[1] < y.max() + self.unit)
            area += abs(twice_area(feature["geometry"]["coordinates"][0])) / 2
        self.assertAlmostEqual(area / (4224 * self.unit) ** 2, 1, places=3)
        self.assertGreater(len(found), 0.98 * len([1 for _, x, y in cells.values() if x.min() > west and x.max() < east and y.min() > south and y.max() < north]))
        places = {int(i): projected(float(lon), float(lat)) for i, lon, lat in abacus.rows("SELECT id, x, y FROM abacus_vertices('hills')")}
        vertices = features("vertices", encoded)
        self.assertGreater(len(vertices), 50)
        for feature in vertices:
            x, y = feature["geometry"]["coordinates"]
            expected = places[feature["properties"]["id"]]
            self.assertLess(abs(x - expected[0]), 0.51 * self.unit)
            self.assertLess(abs(y - expected[1]), 0.51 * self.unit)

    def test_ids_of_browsers(self):
        # 2^53 - 1 is the last integer that a double distinguishes from both its neighbours
        first = 2**53 - 30
        abacus.psql("DROP TABLE IF EXISTS far_ids; SELECT abacus_triangulate('far_ids', 'SELECT " + str(first) +
                    " + row_number() OVER (ORDER BY x, y), x, y, attributes[1] FROM abacus_vertices(''hills'')');"
                    "SELECT abacus_set_srid('far_ids', 4326)")
        encoded = tile(f"abacus_tile_vector('far_ids', {ZOOM}, {X}, {Y})")
        ids = {int(i) for (i,) in abacus.rows("SELECT id FROM abacus_vertices('far_ids')")}
        found = [f["properties"] for f in features("vertices", encoded)]
        self.assertGreater(len(found), 50)
        for tags in found:
            self.assertEqual(tags.get("id_text"), str(tags["id"]) if tags["id"] > 2**53 - 1 else None)
            self.assertIn(tags["id"], ids)
        for tags in (f["properties"] for f in features("triangles", encoded)):
            for name in ("v0", "v1", "v2"):
                self.assertEqual(tags.get(name + "_text"), str(tags[name]) if tags[name] > 2**53 - 1 else None)
        for layer in ("vertices", "triangles"):
            for feature in features(layer, tile(f"abacus_tile_vector('hills', {ZOOM}, {X}, {Y})")):
                self.assertFalse([name for name in feature["properties"] if name.endswith("_text")])

    def test_contours(self):
        encoded = tile(f"abacus_tile_vector('hills', {ZOOM}, {X}, {Y}, contours => 50)")
        lines = features("contours", encoded)
        self.assertGreater(len(lines), 3)
        asked, levels = [], []
        for feature in lines:
            geometry = feature["geometry"]
            parts = geometry["coordinates"] if geometry["type"] == "MultiLineString" else [geometry["coordinates"]]
            for x, y in (place for part in parts for place in part):
                asked.append((x / METRES * 180, numpy.degrees(2 * numpy.arctan(numpy.exp(y / METRES * numpy.pi)) - numpy.pi / 2)))
                levels.append(feature["properties"]["value"])
        values = ", ".join(f"({i}, {lon!r}::float8, {lat!r}::float8)" for i, (lon, lat) in enumerate((float(a), float(b)) for a, b in asked))
        heights = abacus.rows(f"SELECT abacus_interpolate('hills', lon, lat) FROM (VALUES {values}) AS v (i, lon, lat) ORDER BY i")
        for level, (height,) in zip(levels, heights):
            self.assertAlmostEqual(level, float(height), delta=5)  # half a unit on a slope; edges are straight on the map
            self.assertEqual(level % 50, 0)

    def test_heights(self):
        pixels = matplotlib.image.imread(io.BytesIO(tile(f"abacus_tile_terrain('hills', {ZOOM}, {X}, {Y}, size => 32)")), "png")
        red, green, blue = numpy.moveaxis(numpy.rint(pixels[..., :3] * 255), -1, 0)
        heights = red * 256 + green + blue / 256 - 32768
        west, south, east, north = self.window
        for row, column in ((0, 0), (3, 17), (31, 31), (16, 2)):
            x = west + (column + 0.5) / 32 * (east - west)
            y = north - (row + 0.5) / 32 * (north - south)
            lon = float(x / METRES * 180)
            lat = float(numpy.degrees(2 * numpy.arctan(numpy.exp(y / METRES * numpy.pi)) - numpy.pi / 2))
            expected = float(abacus.rows(f"SELECT abacus_interpolate('hills', {lon!r}, {lat!r})")[0][0])
            self.assertAlmostEqual(heights[row, column], expected, delta=1 / 256)


if __name__ == "__main__":
    unittest.main()
