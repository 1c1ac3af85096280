"""LAS, LAZ and COPC as abacus-import reads them, without a database: points that a formula gives, compressed by laz-perf's writer; systems of coordinates
as GDAL writes them; files that are cut off or damaged."""
import decimal
import itertools
import pathlib
import struct
import subprocess
import sys
import unittest
import warnings

import numpy
from osgeo import osr

import abacus
import las_files
from las_files import las

sys.path.insert(0, str(abacus.REPOSITORY / "client"))
from abacus_files import apart_points, classes, epsg, laz_chunks, read_las  # noqa: E402
from abacus_files.decimals import Axis  # noqa: E402
from abacus_files.las_header import Header  # noqa: E402
from abacus_files.psql import Failed  # noqa: E402

LAZ = pathlib.Path(__file__).resolve().parent / "las"
ALL = ("z", "intensity", "return_number", "number_of_returns", "classification", "scan_angle", "user_data", "point_source_id")
PROJECTION = "LASF_Projection"
NO_SYSTEM = "does not say its coordinate system: the mesh has no SRID unless abacus_set_srid gives it one"
osr.UseExceptions()


def wanted(**options):
    return {"classes": None, "window": None, "spacing": None, "band": None, **options}


def install():
    """Skips what needs laz-perf where npm's registry cannot be reached."""
    done = subprocess.run([abacus.REPOSITORY / "client/laz/install"], capture_output=True, text=True, check=False)
    if done.returncode != 0:
        if subprocess.run(["npm", "ping"], capture_output=True, check=False).returncode == 0:
            raise AssertionError(done.stderr)
        raise unittest.SkipTest("npm's registry, which has laz-perf, cannot be reached")


def columns_of(path, names, size=100, **options):
    """(the reader, arrays of x, y and attributes)."""
    reader = read_las.Reader(str(path), list(names), wanted(**options))
    read, blocks = 0, []
    for count, x, y, values in reader.blocks(size):
        read += count
        blocks.append([x, y, *map(numpy.asarray, values)])
    reader.file.close()
    assert read == reader.total
    return reader, [numpy.concatenate(parts) for parts in zip(*blocks)]


def copc(nodes, spacing=16):
    """The bytes of a COPC file: the chunks of nodes.laz, an octree of them, of which one quarter has a page of its own."""
    data = (LAZ / "nodes.laz").read_bytes()
    with open(LAZ / "nodes.laz", "rb") as file:
        header = Header(file)
        chunks, laszip = laz_chunks.chunks(header), header.record(laz_chunks.USER, laz_chunks.NUMBER)
    body = data[chunks[0][0]:]  # with the table of chunks
    table = struct.unpack_from("<q", data, header.begin)[0] - chunks[0][0]
    begin = 375 + 54 + 160 + 54 + len(laszip)
    shift = begin + 8 - chunks[0][0]
    entries = [struct.pack("<4iQii", *key, at + shift, length, count) for key, (at, length, count) in zip(nodes, chunks)]
    pages = begin + 8 + len(body) + 60
    below = [key[0] >= 1 and (key[1] >> (key[0] - 1), key[2] >> (key[0] - 1)) == (0, 0) for key in nodes]  # (1, 0, 0, 0), on a page of its own
    second = b"".join(entry for entry, is_below in zip(entries, below) if is_below)
    root = b"".join(entry for entry, is_below in zip(entries, below) if not is_below)
    root += struct.pack("<4iQii", 1, 0, 0, 0, pages + len(root) + 32, len(second), -1)
    half = las_files.HALF / 100
    info = struct.pack("<5d2Q2d", 0, 0, 0, half, spacing, pages, len(root), 0, 0).ljust(160, b"\0")
    head = las(7, points=sum(nodes.values(), []), compressed=True, records=[("copc", 1, info), (laz_chunks.USER, laz_chunks.NUMBER, laszip)],
               body=struct.pack("<q", begin + 8 + table) + body, long_records=(pages - 60, 1))
    return head + las_files.variable_record("copc", 1000, root + second, long=True)


class Lidar(abacus.InFolder):
    @classmethod
    def setUpClass(cls):
        super().setUpClass()
        warnings.simplefilter("ignore", ResourceWarning)  # a reader that fails ends with its process, and closes nothing
        install()

    def file(self, name, data):
        path = self.at / name
        path.write_bytes(data)
        return path

    def assert_points(self, found, points, format, names):
        """Coordinates are the doubles nearest to two decimals."""
        for column, axis in zip(found, "XY"):
            numpy.testing.assert_array_equal(column, [float(decimal.Decimal(of[axis]).scaleb(-2)) for of in points])
        wants = las_files.columns([dict(of, z=float(decimal.Decimal(of["Z"]).scaleb(-2))) for of in points], names, format)
        for name, column, want in zip(names, found[2:], wants):
            numpy.testing.assert_array_equal(column, want, name)

    def test_every_format(self):
        """Each point format in each version that may have it, without and with bytes behind the record."""
        versions = [(format, minor) for format in range(11) for minor in range(5) if minor >= (4 if format >= 6 else 3 if format >= 4 else 2 if format >= 2 else 0)]
        for (format, minor), extra in itertools.product(versions, (0, las_files.EXTRA)):
            with self.subTest(format=format, minor=minor, extra=extra):
                names = [*ALL, *(["gps_time"] if format not in las_files.NEVER_TIMED else []), *("red", "green", "blue", "nir")[: las_files.COLOURS.get(format, 0)]]
                reader, found = columns_of(self.file("f.las", las(format, minor, extra=extra)), names)
                kept = [of for n in range(las_files.COUNT) if not (of := las_files.point(n, format))["withheld"]]
                self.assert_points(found, kept, format, names)
                self.assertEqual(reader.notes, [NO_SYSTEM, f"left out: {las_files.COUNT - len(kept)} points marked as withheld"])

    def test_laz(self):
        """Three chunks of each format that laz-perf knows."""
        for format in 0, 1, 2, 3, 6, 7, 8:
            with self.subTest(format=format):
                names = [*ALL, *(["gps_time"] if format not in las_files.NEVER_TIMED else []), *("red", "green", "blue", "nir")[: las_files.COLOURS.get(format, 0)]]
                reader, found = columns_of(LAZ / f"format_{format}.laz", names)
                self.assertEqual([count for _, _, count in reader.chunks], [50, 50, 37])
                self.assert_points(found, [of for n in range(las_files.COUNT) if not (of := las_files.point(n, format))["withheld"]], format, names)

    def test_classes(self):
        self.assertEqual(classes.numbers("ground,Water, 200,high_vegetation,Road Surface"), [2, 5, 9, 11, 200])
        for wrong in "grund", "256", "-1", "2,,9", "":
            with self.assertRaisesRegex(Failed, "is not a class; .*low-vegetation"):
                classes.numbers(wrong)
        for format in 1, 6:
            _, found = columns_of(self.file("c.las", las(format)), ALL, classes=[2, 9])
            kept = [of for n in range(las_files.COUNT) if (of := las_files.point(n, format))["classification"] in (2, 9) and not of["withheld"]]
            self.assertGreater(len(kept), 3)
            self.assert_points(found, kept, format, ALL)

    def test_window(self):
        for path in self.file("w.las", las(1)), LAZ / "format_1.laz":
            _, found = columns_of(path, ("z",), window=[-20.5, 12, 33.25, 61])
            kept = [of for n in range(las_files.COUNT) if -2050 <= (of := las_files.point(n, 1))["X"] <= 3325 and 1200 <= of["Y"] <= 6100 and not of["withheld"]]
            self.assertGreater(len(kept), 5)
            self.assert_points(found, kept, 1, ("z",))

    def test_offsets(self):
        """A place that files have with different offsets, and scales, is one double, the nearest to its decimal."""
        random = numpy.random.default_rng(5)
        places = [decimal.Decimal(int(n)).scaleb(-3) for n in random.integers(4 * 10**9, 6 * 10**9, 2000)]
        wants = numpy.array([float(place) for place in places])
        seen, plain = set(), 0
        for scale, offset in ((".001", "0"), (".001", "5000000"), (".001", "4999999.37"), ("0.001", "5012345.678"), (".0001", "5000000.1"), (".00025", "5e6"), (".001", "-1e3")):
            wholes = numpy.array([int((place - decimal.Decimal(offset)) / decimal.Decimal(scale)) for place in places])
            axis = Axis(float(scale), float(offset))
            numpy.testing.assert_array_equal(axis.values(wholes), wants)
            self.assertTrue(axis.exact)
            plain += int((wholes * float(scale) + float(offset) != wants).sum())
            seen.add((scale, offset))
        self.assertGreater(plain, 500)  # a product and a sum would not do
        self.assertEqual(Axis(.01, 499999.99999999994).values(numpy.array([7]))[0], 500000.07)  # noise of a writer
        self.assertFalse(Axis(1 / 3, 0).exact)
        reader, _ = columns_of(self.file("o.las", las(0, scale=(1 / 3, .01, .01))), ("z",))
        self.assertIn("is not a short decimal", reader.notes[0])

    def test_systems(self):
        """As GDAL writes them, in WKT of both versions, with a vertical system and without; keys of GeoTIFF."""
        for code, horizontal in ((25832, 25832), (4326, 4326), (2227, 2227), (6318, 6318), (5972, 25832), (7415, 28992)):
            system = osr.SpatialReference()
            system.ImportFromEPSG(code)
            for form in "WKT1_GDAL", "WKT2_2015", "WKT2_2018":
                with self.subTest(code=code, form=form):
                    text = system.ExportToWkt([f"FORMAT={form}", "MULTILINE=YES"]).encode() + b"\0"
                    reader, _ = columns_of(self.file("s.las", las(6, points=[las_files.point(1, 6)], records=[(PROJECTION, 2112, text)], wkt=True)), ["z"])
                    # in the second version GDAL writes the code of the whole alone
                    self.assertEqual((reader.srid, reader.notes), (code if form != "WKT1_GDAL" else horizontal, []))
        for code in 25832, 31370, 27700, 4326, 2227:  # without a code
            system = osr.SpatialReference()
            system.ImportFromEPSG(code)
            self.assertEqual(epsg.of_wkt(system.ExportToWkt(["FORMAT=WKT1_ESRI"]))[0], code)
        own = osr.SpatialReference()
        own.SetTM(48, 7, 1, 1000, 2000)
        own.SetProjCS("site \"7\"")
        reader, _ = columns_of(self.file("s.las", las(6, points=[las_files.point(1, 6)], records=[(PROJECTION, 2112, own.ExportToWkt().encode())], wkt=True)), ["z"])
        self.assertEqual(reader.srid, 0)
        self.assertIn("has no EPSG code", reader.notes[0])
        self.assertIn("site", reader.notes[0])
        for keys, srid in (((1024, 1), (3072, 25832)), 25832), (((1024, 2), (2048, 4326)), 4326), (((2048, 4269), (3072, 26910), (4096, 5703)), 26910), (((3072, 32767),), 0), ((), 0):
            directory = struct.pack("<4H", 1, 1, 0, len(keys)) + b"".join(struct.pack("<4H", key, 0, 1, value) for key, value in keys)
            reader, _ = columns_of(self.file("k.las", las(1, points=[las_files.point(1, 1)], records=[("other", 1, b"x"), (PROJECTION, 34735, directory)])), ["z"])
            self.assertEqual((reader.srid, len(reader.notes)), (srid, int(srid == 0)))

    def test_copc(self):
        """A window reads the nodes that meet it, a spacing the levels that it needs; without them all is read."""
        nodes = las_files.nodes()
        path = self.file("n.copc.laz", copc(nodes))
        everything = sum(nodes.values(), [])
        side = 2 * las_files.HALF
        for window, spacing in ((None, None), ([1, 1, 20, 20], None), (None, 16), (None, 8), (None, 5), (None, 1), ([-64, -64, -40, -40], 8), ([40, 40, 41, 41], 100),
                                ([32, 0, 40, 1], None)):
            with self.subTest(window=window, spacing=spacing):
                reader, found = columns_of(path, ALL, window=window, spacing=spacing)
                levels = las_files.LEVELS if spacing is None else {16: 1, 8: 2, 5: 3, 1: 3, 100: 1}[spacing]
                within = window or [-999, -999, 999, 999]
                kept = [of for key, points in nodes.items() if key[0] < levels for of in points
                        if within[0] <= of["X"] / 100 <= within[2] and within[1] <= of["Y"] / 100 <= within[3]]
                self.assert_points(found, kept, 7, ALL)
                met = [key for key in nodes if key[0] < levels and all(
                    at * (side >> key[0]) - las_files.HALF <= most * 100 and (at + 1) * (side >> key[0]) - las_files.HALF >= least * 100
                    for at, least, most in zip(key[1:3], within[:2], within[2:]))]
                self.assertEqual(reader.total, las_files.EACH * len(met))
        self.assertEqual(len(everything), las_files.EACH * 13)
        for name in "format_6.laz", "s.las":
            file = LAZ / name if name.endswith("z") else self.file(name, las(6))
            with self.assertRaisesRegex(Failed, "is not a COPC file"):
                columns_of(file, ["z"], spacing=3)

    def refused(self, data, said, names=("z",), name="r.laz"):
        with self.assertRaisesRegex(Failed, said, msg=said):
            columns_of(self.file(name, data), names)

    def test_bounds(self):
        """Points that are not where the header says are counted, whatever is left out of the rest."""
        points = [las_files.point(n, 1) for n in range(las_files.COUNT)]
        exact = [end([of[axis] for of in points]) / 100 for axis in "XYZ" for end in (max, min)]
        for bounds, count in ((exact, 0), ([exact[0], -50.5, *exact[2:]], sum(of["X"] < -5051 for of in points)), ([*exact[:4], 201, exact[5]], sum(of["Z"] > 20101 for of in points))):
            reader, _ = columns_of(self.file("b.las", las(1, bounds=bounds)), ["z"], classes=[2])
            self.assertEqual([note for note in reader.notes if "outside" in note], [f"has {count} point{'s' * (count > 1)} outside of the bounds in its header; the file may be damaged"] * (count > 0))
        self.assertGreater(count, 9)

    def test_empty(self):
        """A tile without points is no error."""
        for path in self.file("e.las", las(1, points=[])), self.file("e.laz", las(1, points=[], compressed=True)):
            reader = read_las.Reader(path, ["z"], wanted())
            self.assertEqual((list(reader.blocks(9)), reader.total, reader.notes), ([], 0, ["has no points", NO_SYSTEM]))

    def test_refused(self):
        """Errors name the byte."""
        good = las(1)

        def changed(at, form, value, data=good):
            data = bytearray(data)
            struct.pack_into(form, data, at, value)
            return bytes(data)
        for data, said in ((b"", "byte 0: does not begin"), (b"LASF" + bytes(90), "byte 94: the file ends within"), (changed(24, "B", 2), "byte 24: has the version 2.2"),
                           (changed(25, "B", 5), "byte 24: .* 1.5"), (changed(104, "B", 11), "byte 104: has points of format 11"), (changed(104, "B", 65), "byte 104: .*LASzip"),
                           (changed(105, "<H", 27), "byte 105: .* 27 bytes"), (changed(107, "<I", 138), "the file ends after 137 of 138 points"),
                           (good[:-1], "ends after 136 of 137"), (changed(96, "<I", 10), "byte 96"), (changed(100, "<I", 1), "byte 227: variable length record 1 of 1"),
                           (changed(131, "<d", 0), "byte 131: the scale .* of x"), (changed(171, "<d", float("nan")), "byte 131: .* of z"), (las(4, compressed=True), "has no record of LASzip")):
            self.refused(data, said)
        self.refused(good, "points of format 1 have no red; they have z, intensity", ("red",))
        packed = (LAZ / "format_1.laz").read_bytes()
        at = packed.index(b"laszip encoded") + 52
        begin = struct.unpack_from("<I", packed, 96)[0]
        table, = struct.unpack_from("<q", packed, begin)
        for data, said in ((changed(at, "<H", 4, packed), f"byte {at}: is compressed in a way"), (changed(at + 34 + 4, "<H", 1, packed), "items of version 1, 2"),
                           (packed[:-30], "table of chunks"), (packed[: table - 9], f"byte {begin}: .*cut off"), (changed(begin, "<q", 5, packed), f"byte {begin}: .*byte 5"),
                           (changed(table, "<I", 1, packed), f"byte {table}: no table of chunks"), (changed(107, "<I", 151, packed), f"byte {table}: the table of chunks"),
                           (changed(at + 12, "<I", 40, packed), f"byte {table}: the table of chunks"), (las(4, compressed=True, records=[("laszip encoded", 22204, struct.pack("<H30xH6x", 2, 1))]), "byte 104: .*wave packets"),
                           (changed(table + 9, "<I", 77, packed), f"byte {table}: the table of chunks")):
            self.refused(data, said)
        packed = copc(las_files.nodes())
        self.refused(packed[:-40], "variable length record")
        root, length = struct.unpack_from("<2Q", packed, 429 + 40)
        for data, said in ((changed(429 + 40, "<Q", 10**9, packed), "a page of the octree"), (changed(root, "<i", -1, packed), "cannot be"), (changed(root + 16, "<Q", 10**9, packed), "ends beyond"),
                           (changed(429 + 24, "<d", 0, packed), "no size"), (changed(root + (length - 32) + 16, "<Q", root, packed), "two nodes of the octree have one page")):
            with self.assertRaisesRegex(Failed, said):
                columns_of(self.file("r.copc.laz", data), ("z",), window=[-99, -99, 99, 99])

    def test_damaged(self):
        """Files of which a part is lost or changed give an error that says what is wrong, never another exception; or points, where only those are changed."""
        random = numpy.random.default_rng(7)
        seeds = [("d.las", las(1)), ("d.las", las(7, extra=2, records=[(PROJECTION, 34735, struct.pack("<8H", 1, 1, 0, 1, 3072, 0, 1, 25832))]))]
        refused = 0
        for name, whole in seeds:
            for n in range(400):
                data = bytearray(whole if n % 2 else whole[: random.integers(len(whole))])
                for at in random.integers(0, min(len(data), 400) or 1, random.integers(1, 4)) if n % 2 else ():
                    data[at] = random.integers(256)
                try:
                    columns_of(self.file(name, bytes(data)), ("z", "classification"))
                except Failed as error:
                    refused += 1
                    self.assertRegex(str(error), "^byte")
        self.assertGreater(refused, 400)
        for n, whole in itertools.product(range(4), ((LAZ / "format_1.laz").read_bytes(), copc(las_files.nodes()))):  # each starts a process
            data = bytearray(whole[: random.integers(len(whole))] if n % 4 == 3 else whole)
            for at in random.integers(300, len(data), 3) if n % 4 != 3 else ():
                data[at] = random.integers(256)
            try:
                columns_of(self.file("d.laz", bytes(data)), ("z",))
            except Failed as error:
                self.assertTrue(str(error))

    def test_apart(self):
        """The process sends all points; chunks that claim more points than they can have end with an error, soon."""
        with apart_points.Points(str(LAZ / "format_6.laz"), ["z", "intensity"], wanted(), 100) as points:
            rows = b"".join(data for _, _, data in points)
            self.assertEqual((points.total, points.srid, len(points.notes)), (las_files.COUNT, 0, 2))
        row = numpy.dtype([("n", ">i2"), ("a", ">i4"), ("id", ">i8"), ("b", ">i4"), ("x", ">f8"), ("c", ">i4"), ("y", ">f8"), ("d", ">i4"), ("z", ">f8"), ("e", ">i4"), ("i", ">i4")])
        found = numpy.frombuffer(rows, row)
        kept = [of for n in range(las_files.COUNT) if not (of := las_files.point(n, 6))["withheld"]]
        self.assertEqual({tuple(lengths) for lengths in found[["n", "a", "b", "c", "d", "e"]].tolist()}, {(5, 8, 8, 8, 8, 4)})
        self.assertEqual(found["id"].tolist(), list(range(100, 100 + len(kept))))
        self.assert_points([found["x"], found["y"], found["z"], found["i"]], kept, 6, ("z", "intensity"))
        nodes = las_files.nodes()
        data = bytearray(copc(nodes))
        root, = struct.unpack_from("<Q", data, 429 + 40)
        struct.pack_into("<i", data, root + 28, 2**31 - 1)
        path = self.file("endless.copc.laz", bytes(data))
        code = ("import resource, sys; resource.setrlimit(resource.RLIMIT_CPU, (2, 2)); from abacus_files import apart_points\n"
                f"with apart_points.Points({str(path)!r}, ['z'], {wanted(spacing=1)!r}, 1) as points: print(sum(rows for _, rows, _ in points))")
        done = subprocess.run(["/usr/bin/python3", "-c", code], cwd=abacus.REPOSITORY / "client", capture_output=True, text=True, timeout=100, check=False)
        self.assertRegex(done.stderr, "Failed: (was not decompressed within|was not read within|byte .* cannot be decompressed)")


if __name__ == "__main__":
    unittest.main()
