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


def features(layer, encoded, place=(ZOOM, X, Y)):
    """GDAL's, in metres of Web Mercator."""
    with tempfile.TemporaryDirectory() as folder:
        path = pathlib.Path(folder, "tile.pbf")
        path.write_bytes(encoded)
        text = subprocess.run(["ogr2ogr", "-f", "GeoJSON", "/vsistdout/", str(path), layer, "-oo", "CLIP=NO",
                               "-oo", f"X={place[1]}", "-oo", f"Y={place[2]}", "-oo", f"Z={place[0]}", "-lco", "RFC7946=NO",
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

    def test_regions_and_fixed_edges(self):
        """Of a mesh with a square, a soft line through it and another region; at each zoom, however many triangles a tile has."""
        west, south, east, north = self.window
        abacus.psql("""
            DROP TABLE IF EXISTS shore CASCADE;
            SELECT abacus_triangulate('shore', 'SELECT id, x, y, attributes[1] AS height FROM abacus_vertices(''hills'') UNION ALL
                SELECT 10000 + i, 7.9 + i % 2 * 0.2, 46.3 + i / 2 * 0.2, 0 FROM generate_series(0, 3) AS i');
            SELECT abacus_set_srid('shore', 4326);
            SELECT abacus_constrain('shore', 'VALUES (1, 1, 10000), (1, 2, 10001), (1, 3, 10003), (1, 4, 10002), (1, 5, 10000)');
            SELECT abacus_constrain('shore', 'VALUES (2, 1, 10000), (2, 2, 10003)', kind => 'soft');
            SELECT abacus_region('shore', $$VALUES ('Südufer', 8.05, 46.35)$$)""")
        x, y = projected(numpy.array([7.9, 8.1]), numpy.array([46.3, 46.5]))
        regions = {}
        for v0, v1, v2, corners in abacus.rows("SELECT v0, v1, v2, corners FROM abacus_cells('shore', within => 'Südufer')"):
            regions[frozenset(map(int, (v0, v1, v2)))] = corners
        encoded = tile(f"abacus_tile_vector('shore', {ZOOM}, {X}, {Y})")
        triangles = features("triangles", encoded)
        named = [f["properties"] for f in triangles if f["properties"].get("region") is not None]
        self.assertTrue(0 < len(named) < len(triangles))
        for tags in (f["properties"] for f in triangles):
            ids = frozenset((tags["v0"], tags["v1"], tags["v2"]))
            self.assertEqual(tags.get("region"), "Südufer" if ids in regions else None)
        # where there are triangles, edges have their lines, two of them if they share one
        abacus.psql("SELECT abacus_constrain('shore', 'VALUES (9007199254740993, 1, 10000), (9007199254740993, 2, 10001)')")
        found = {}
        corner = ZOOM, X - 1, Y + 1
        for feature in features("fixed", tile(f"abacus_tile_vector('shore', {ZOOM}, {X - 1}, {Y + 1})"), corner):
            tags, geometry = feature["properties"], feature["geometry"]
            parts = geometry["coordinates"] if geometry["type"] == "MultiLineString" else [geometry["coordinates"]]
            found[tags["line"], tags["kind"], tags.get("line_text")] = sum(numpy.hypot(*numpy.diff(numpy.array(part), axis=0).T).sum() for part in parts)
        self.assertEqual(set(found), {(1, "hard", None), (2, "soft", None), (9007199254740993, "hard", "9007199254740993")})
        self.assertGreater(found[1, "hard", None], found[9007199254740993, "hard", "9007199254740993"])
        abacus.psql("SELECT abacus_unconstrain('shore', 'VALUES (9007199254740993)')")
        # a tile in which the whole square lies, with few and with many triangles
        for zoom, tile_x, tile_y in ((8, 133, 90), (0, 0, 0)):
            encoded = tile(f"abacus_tile_vector('shore', {zoom}, {tile_x}, {tile_y})")
            unit = 2 * METRES / 2**zoom / 4096
            found = {f["properties"]["kind"]: f["geometry"] for f in features("fixed", encoded, (zoom, tile_x, tile_y))}
            self.assertEqual(set(found), {"hard", "soft"} if zoom else set(found))
            for kind, geometry in found.items():
                parts = geometry["coordinates"] if geometry["type"] == "MultiLineString" else [geometry["coordinates"]]
                places = numpy.array([place for part in parts for place in part])
                across = numpy.abs((places[:, 0] - x[0]) / (x[1] - x[0]) - (places[:, 1] - y[0]) / (y[1] - y[0]))
                beside = numpy.minimum(numpy.abs(places[:, :1] - x).min(1), numpy.abs(places[:, 1:] - y).min(1))
                self.assertLess((across * (y[1] - y[0]) if kind == "soft" else beside).max(), 300 + unit)
                if zoom:
                    length = sum(numpy.hypot(*numpy.diff(numpy.array(part), axis=0).T).sum() for part in parts)
                    expected = numpy.hypot(x[1] - x[0], y[1] - y[0]) if kind == "soft" else 2 * (x[1] - x[0] + y[1] - y[0])
                    self.assertAlmostEqual(length / expected, 1, places=1)
        # without the region, within it, and with many triangles
        self.assertEqual({f["properties"]["kind"] for f in features("fixed", tile(f"abacus_tile_vector('shore', 8, 133, 90, within => 'Südufer')"), (8, 133, 90))},
                         {"hard", "soft"})
        abacus.psql("SELECT abacus_unregion('shore', 'Südufer')")
        for feature in features("triangles", tile(f"abacus_tile_vector('shore', {ZOOM}, {X}, {Y})")):
            self.assertIsNone(feature["properties"].get("region"))
        self.assertNotIn(b"fixed", tile(f"abacus_tile_vector('hills', {ZOOM}, {X}, {Y})"))

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
