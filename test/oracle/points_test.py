"""Points of files into meshes by abacus-import: lidar, ASCII grids and GeoTIFF, which GDAL reads or writes, too; tables that a mesh follows; what is refused
leaves nothing behind."""
import re
import shlex
import signal
import subprocess
import sys
import time
import unittest
import warnings

import numpy
from osgeo import gdal, osr

import abacus
import las_files
import lidar_test
from las_files import las

sys.path.insert(0, str(abacus.REPOSITORY / "client"))
from abacus_files import read_asc  # noqa: E402
from abacus_files.psql import Failed  # noqa: E402

IMPORT = abacus.REPOSITORY / "client/abacus-import"
LEAST = -1.7976931348623157e308
gdal.UseExceptions()


def run(*arguments, **options):
    return subprocess.run(["/usr/bin/python3", str(IMPORT), *map(str, arguments)], capture_output=True, text=True, check=False, **options)


def system(code):
    found = osr.SpatialReference()
    found.ImportFromEPSG(code)
    return found


class Points(abacus.InFolder):
    @classmethod
    def setUpClass(cls):
        super().setUpClass()
        warnings.simplefilter("ignore", ResourceWarning)  # a reader that fails ends with its process, and closes nothing

    def file(self, name, data):
        path = self.at / name
        path.write_bytes(data if isinstance(data, bytes) else data.encode())
        return path

    def setUp(self):
        self.mesh = self._testMethodName.replace("test_", "points_")
        abacus.psql(f"DROP TABLE IF EXISTS {self.mesh}, {self.mesh}_table CASCADE")

    def loads(self, *arguments):
        """What is said of the files, without their names."""
        done = run(*arguments)
        self.assertEqual(done.returncode, 0, done.stderr)
        return [line.split(": ", 2)[2] for line in done.stderr.splitlines() if line.startswith("abacus-import")]

    def refused(self, said, *arguments):
        done = run(*arguments)
        self.assertEqual(done.returncode, 1, done.stderr)
        self.assertRegex(done.stderr.splitlines()[-1], "^abacus-import: .*" + said)
        self.assertNotIn("Traceback", done.stderr)
        self.assertEqual(abacus.rows(f"SELECT to_regclass('{self.mesh}'), to_regclass('{self.mesh}_table')"), [["NULL"] * 2])

    def vertices(self):
        """Rows of x, y and attributes, in the order of the ids."""
        return [[float(x), float(y), *abacus.vector(values)] for x, y, values in abacus.rows(f"SELECT x, y, attributes FROM abacus_vertices('{self.mesh}') ORDER BY id")]

    def facts(self):
        return abacus.rows(f"SELECT abacus_srid('{self.mesh}'), array_agg(name) FROM abacus_attributes('{self.mesh}')")[0]

    def kept(self, format, *classes, count=las_files.COUNT):
        return [of for n in range(count) if not (of := las_files.point(n, format))["withheld"] and (not classes or of["classification"] in classes)]

    def test_lidar(self):
        """One command: a mesh with attributes and an SRID; ids count the points that are taken."""
        path = self.file("survey.las", las(6, records=[("LASF_Projection", 2112, system(25832).ExportToWkt().encode())], wkt=True))
        said = self.loads(path, self.mesh)
        kept = self.kept(6)
        self.assertEqual(said, [f"left out: {las_files.COUNT - len(kept)} points marked as withheld"])
        self.assertEqual(self.facts(), ["25832", "{z,intensity,return_number,classification}"])
        self.assertEqual(self.vertices(), [[of["X"] / 100, of["Y"] / 100, of["Z"] / 100, of["intensity"], of["return_number"], of["classification"]] for of in kept])
        abacus.triangulate(f"{self.mesh}_same", numpy.array([[of["X"] / 100, of["Y"] / 100] for of in kept]))
        self.assertEqual(sorted(abacus.rows(f"SELECT v0, v1, v2 FROM abacus_simplices('{self.mesh}')")), sorted(abacus.rows(f"SELECT v0, v1, v2 FROM abacus_simplices('{self.mesh}_same')")))

    def test_laz_tiles(self):
        """Several files, classes by name and number, attributes of choice."""
        lidar_test.install()
        east = self.file("east.las", las(3, offset=(200.005, 0, 0)))
        self.loads(lidar_test.LAZ / "format_3.laz", east, self.mesh, "--class", "ground,4, high vegetation", "--attributes", "classification,z,gps_time,blue,z")
        kept = self.kept(3, 2, 4, 5)
        self.assertGreater(len(kept), 10)
        self.assertEqual(self.facts(), ["0", "{classification,z,gps_time,blue}"])
        self.assertEqual(self.vertices(), [[round(of["X"] / 100 + shift, 3), of["Y"] / 100, of["classification"], of["Z"] / 100, of["gps_time"], of["colours"][2]]
                                           for shift in (0, 200.005) for of in kept])

    def test_page(self):
        """The commands of the manual run, in a folder with such files."""
        lidar_test.install()
        self.file("survey.laz", (lidar_test.LAZ / "format_7.laz").read_bytes())
        self.file("tile_1.laz", (lidar_test.LAZ / "format_1.laz").read_bytes())
        self.file("tile_2.laz", (lidar_test.LAZ / "format_3.laz").read_bytes())
        self.file("area.copc.laz", lidar_test.copc(las_files.nodes()))
        self.grid("heights.asc", self.heights())
        data, _ = self.tiff("heights.tif", numpy.stack([self.heights()] * 2))
        del data
        page = (abacus.REPOSITORY / "docs/files.md").read_text()
        commands = re.search(r"## Points of lidar and rasters\n\n```sh\n(.*?)```", page, re.S)[1].splitlines()
        self.assertEqual(len(commands), 5)
        for command in commands:
            _, _, _, *arguments = shlex.split(command.replace("450000 4649000 450100 4649100", "0 0 50 50"))
            mesh = next(word for word in arguments if "." not in word)
            abacus.psql(f"DROP TABLE IF EXISTS {mesh}, {mesh}_points CASCADE")
            done = run(*arguments, cwd=self.at)
            self.assertEqual((done.returncode, bool(re.fullmatch(mesh + r": [1-9]\d* simplices\n", done.stdout))), (0, True), done.stdout + done.stderr)

    def test_table(self):
        """The mesh follows a table of the points, which takes more of them."""
        table = f"{self.mesh}_table"
        self.loads(self.file("t.las", las(1)), self.mesh, "--table", f'public."{table}"')
        kept = self.kept(1)
        self.assertEqual([int(n) for n, in abacus.rows(f"SELECT id FROM {table} ORDER BY id")], list(range(1, len(kept) + 1)))
        self.assertEqual(abacus.rows(f"SELECT array_agg(attname || ' ' || format_type(atttypid, NULL) ORDER BY attnum) FROM pg_attribute WHERE attrelid = '{table}'::regclass AND attnum > 0"),
                         [["{\"id bigint\",\"x double precision\",\"y double precision\",\"z double precision\",\"intensity integer\",\"return_number smallint\","
                           "\"classification smallint\"}"]])
        abacus.psql(f"DELETE FROM {table} WHERE id > 50; INSERT INTO {table} (x, y, z) VALUES (1, 2, 3)")
        self.assertEqual(abacus.rows(f"SELECT id FROM {table} ORDER BY id DESC LIMIT 1"), [[str(len(kept) + 1)]])
        self.assertEqual(len(self.vertices()), 51)
        self.assertEqual(abacus.rows(f"SELECT abacus_track('{self.mesh}', '{table}')"), [["51"]])

    def test_refused(self):
        """Each error names the file; nothing is left behind, whichever file is wrong."""
        good = self.file("good.las", las(1))
        short = self.file("short.las", las(1)[:-100])
        other = [self.file(f"{code}.las", las(6, records=[("LASF_Projection", 2112, system(code).ExportToWkt().encode())], wkt=True)) for code in (25832, 25833)]
        mesh = self.mesh
        for said, *arguments in (
                ("short.las: byte .*: the file ends after 133 of 137 points", short, mesh), ("short.las: byte", good, short, mesh, "--table", f"{mesh}_table"),
                ("25833.las: has the coordinate system 25833 .*25832.las has 25832", *other, mesh), ("no.las: No such file|No such file.*no.las", self.at / "no.las", mesh),
                ("no point is there, or none that is wanted", good, mesh, "--class", "200"), ("grund' is not a class", good, mesh, "--class", "grund"),
                ("colour is not an attribute .*classification", good, mesh, "--attributes", "z,colour"), ("points of format 1 have no red", good, mesh, "--attributes", "red"),
                ("--band is not for .las, .laz", good, mesh, "--band", "1"), ("is not a COPC file", good, mesh, "--spacing", "1"), ("is not the name of a table", good, mesh, "--table", "a b"),
                ("--retriangulate, --inherit and --surface are for files of meshes", good, mesh, "--retriangulate"), ("several files must be of one kind", good, self.at / "a.tif", mesh),
                ("several are for points", self.at / "a.ply", self.at / "b.ply", mesh), ("--spacing and --band are for points", self.at / "a.ply", mesh, "--class", "2"),
                ("not loaded", good, mesh, "--table", "pg_catalog.pg_class")):
            self.refused(said, *arguments)
        self.loads(good, mesh)
        done = run(good, mesh)
        self.assertEqual(done.returncode, 1)
        self.assertIn(f'mesh "{mesh}" already exists', done.stderr)
        self.assertEqual(len(self.vertices()), len(self.kept(1)))
        self.assertEqual(abacus.rows("SELECT count(*) FROM pg_stat_activity WHERE state LIKE 'idle in transaction%'"), [["0"]])

    def grid(self, name, values, **header):
        rows, columns = values.shape
        said = {"ncols": columns, "nrows": rows, "xllcorner": 1000.5, "yllcorner": -20, "cellsize": 0.1, "NODATA_value": -9999, **header}
        text = "".join(f"{key} {value}\n" for key, value in said.items() if value is not None)
        return self.file(name, text + "\n".join(" ".join(map(repr, row)) for row in values.tolist()) + "\n")

    def of_gdal(self, path, band=1):
        """Centres of the cells that GDAL says are valid, and their values; rows go down."""
        data = gdal.OpenEx(str(path), open_options=["DATATYPE=Float64"] if path.suffix == ".asc" else [])
        x0, dx, _, y0, _, dy = data.GetGeoTransform()
        values, valid = data.GetRasterBand(band).ReadAsArray(), data.GetRasterBand(band).GetMaskBand().ReadAsArray() != 0
        row, column = numpy.nonzero(valid)
        return numpy.column_stack([x0 + (column + .5) * dx, y0 + (row + .5) * dy, values[row, column].astype(float)])

    def assert_cells(self, path, band=1):
        """Values are those of GDAL, to the bit; centres to the last digits, since GDAL's are products of rounded steps."""
        found, wants = numpy.array(self.vertices()), self.of_gdal(path, band)
        numpy.testing.assert_array_equal(found[:, 2], wants[:, 2])
        numpy.testing.assert_allclose(found[:, :2], wants[:, :2], rtol=1e-14, atol=1e-12)

    def heights(self):
        values = numpy.round(numpy.random.default_rng(2).uniform(-50, 4000, (23, 17)), 3)
        values[3:6, 2:9] = -9999
        return values

    def test_grid(self):
        """An ASCII grid: no cell without data, and of the others the decimals that the header means."""
        path = self.grid("g.asc", self.heights())
        path.with_suffix(".prj").write_text(system(31370).ExportToWkt())
        self.assertEqual(self.loads(path, self.mesh), ["left out: 21 cells without data"])
        self.assertEqual(self.facts(), ["31370", "{z}"])
        self.assert_cells(path)
        found = self.vertices()
        self.assertEqual(found[0][:2], [1000.55, -17.75])
        self.assertEqual({repr(x) for x, *_ in found}, {repr(round(1000.55 + n / 10, 2)) for n in range(17)})
        path.with_suffix(".prj").unlink()

    def test_grid_forms(self):
        """Centres instead of corners, cells that are not square, rows on several lines, no word about missing values, a window."""
        values = self.heights()
        for n, header in enumerate(({"xllcorner": None, "yllcorner": None, "XLLCENTER": 5, "yllcenter": 7}, {"cellsize": None, "dx": 2, "dy": 0.5}, {"NODATA_value": values[1, 1]})):
            path = self.grid(f"form_{n}.asc", values, **header)
            self.setUp()
            said = self.loads(path, self.mesh)
            self.assert_cells(path)
            self.assertIn("left out: 1 cell without data" if n == 2 else "left out: 21 cells without data", said[-1])
        path = self.grid("lines.asc", values)
        text = path.read_text().split("\n")
        path.write_text("\r\n".join(text[:6] + " ".join(text[6:]).replace(" 1", "\r\n\r\n1").split("\n")))
        self.setUp()
        self.loads(path, self.mesh, "--window", "1001.05", "-18", "1000.75", "-19")
        wants = [row for row in self.of_gdal(path).tolist() if 1000.749 <= row[0] <= 1001.051 and -19.0001 <= row[1] <= -17.9999]
        self.assertEqual([row[2] for row in self.vertices()], [row[2] for row in wants])
        self.setUp()
        said = self.loads(self.grid("silent.asc", values, NODATA_value=None), self.mesh)
        self.assertEqual(said[1:], ["does not say NODATA_value: -9999 is none", "left out: 21 cells without data"])
        self.assertEqual(len(self.vertices()), values.size - 21)

    def test_grid_refused(self):
        values = numpy.arange(12.).reshape(3, 4)
        good = self.grid("good.asc", values).read_text()
        for old, new, said in (("ncols 4", "ncols 0", "line 7: .*ncols"), ("nrows 3", "nrows x", "line 2: x is not a number"), ("nrows 3\n", "", "line 6: .*nrows"), ("cellsize 0.1", "cellsize -1", "line 7: .*cellsize"),
                               ("xllcorner 1000.5", "xllcorner 1\nxllcenter 2", "line 8: .*xllcorner or xllcenter"), ("xllcorner 1000.5", "xllcorner inf", "xllcorner is not finite"),
                               ("5.0", "5,0", "line 8: 5,0 is not a number"), (" 11.0", "", "line 10: the file ends after 11 of 12"), (" 11.0", " 11.0 12.0", "line 9: the file has more than 12 cells"),
                               ("11.0\n", "11.0\n\n7", "line 11: the file has more than 12 cells"), ("cellsize 0.1", "cellsize 0.1\ncellsize 0.2", "line 6: cellsize"), (good, "", "line 1: .*ncols")):
            path = self.file("bad.asc", good.replace(old, new, 1))
            with self.assertRaisesRegex(Failed, said):
                list(read_asc.Reader(str(path), ["z"], lidar_test.wanted()).blocks(5))
        self.refused("bad.asc: line 1: the header does not say ncols", path, self.mesh)

    def tiff(self, name, values, kind=gdal.GDT_Float64, no_data=None, place=(1000.5, .1, 0, -17.7, 0, -.1), code=25832, **options):
        bands = values if values.ndim == 3 else values[None]
        data = gdal.GetDriverByName("GTiff").Create(str(self.at / name), bands.shape[2], bands.shape[1], len(bands), kind, options=[f"{key}={value}" for key, value in options.items()])
        if place:
            data.SetGeoTransform(place)
        if code:
            data.SetSpatialRef(system(code))
        for n, band in enumerate(bands, 1):
            data.GetRasterBand(n).WriteArray(band)
            if no_data is not None:
                data.GetRasterBand(n).SetNoDataValue(no_data)
        return data, self.at / name

    def test_tiff(self):
        """Types and compressions of GDAL, tiles and strips."""
        values = self.heights()
        for n, (kind, no_data, options) in enumerate(((gdal.GDT_Float64, -9999, {}), (gdal.GDT_Float32, -9999, {"COMPRESS": "LZW", "PREDICTOR": 3}), (gdal.GDT_Int16, -9999, {"TILED": "YES", "COMPRESS": "DEFLATE"}),
                                                      (gdal.GDT_Int32, -9999, {"COMPRESS": "ZSTD", "BIGTIFF": "YES", "ENDIANNESS": "BIG"}))):
            with self.subTest(kind=kind):
                data, path = self.tiff(f"t{n}.tif", values, kind, no_data, **options)
                del data
                self.setUp()
                self.assertEqual(self.loads(path, self.mesh), ["left out: 21 cells without data"])
                self.assertEqual(self.facts(), ["25832", "{z}"])
                self.assert_cells(path)

    def test_tiff_bands(self):
        """The first band, or another; a scale; a mask; a NaN and the least double, which are never heights."""
        values = numpy.stack([self.heights(), numpy.abs(self.heights()) + 1])
        data, path = self.tiff("bands.tif", values, no_data=-9999)
        data.GetRasterBand(1).SetDescription("ground")
        data.GetRasterBand(2).SetScale(.5)
        data.GetRasterBand(2).SetOffset(100)
        del data
        self.assertIn("bands other than 1 are left out: 2", self.loads(path, self.mesh))
        self.assert_cells(path)
        self.setUp()
        self.assertEqual(self.loads(path, self.mesh, "--band", 2), ["bands other than 2 are left out: 1 (ground)"])
        self.assertEqual([row[2] for row in self.vertices()], (values[1].reshape(-1) * .5 + 100).tolist())
        odd = numpy.arange(30.).reshape(5, 6)
        odd[1, 1], odd[2, 2], odd[3, 3] = numpy.nan, LEAST, numpy.inf
        data, path = self.tiff("odd.tif", odd, code=None)
        data.CreateMaskBand(gdal.GMF_PER_DATASET)
        mask = numpy.full(odd.shape, 255)
        mask[0] = 0
        data.GetRasterBand(1).GetMaskBand().WriteArray(mask)
        del data
        self.setUp()
        self.assertEqual(self.loads(path, self.mesh)[1:], ["left out: 6 cells without data", "left out: 3 cells without a finite height"])
        self.assertEqual([row[2] for row in self.vertices()], [value for value in odd[1:].reshape(-1).tolist() if abs(value) < 1000])

    def test_tiff_refused(self):
        values = numpy.ones((5, 6))
        for said, make in (("does not say where", {"place": None}), ("do not go from west to east", {"place": (0, 1, .5, 0, .5, -1)}), ("complex numbers", {"kind": gdal.GDT_CFloat32})):
            data, path = self.tiff("bad.tif", values, **make)
            del data
            self.refused("bad.tif: .*" + said, path, self.mesh)
        data, path = self.tiff("cut.tif", numpy.random.default_rng(1).uniform(0, 1, (300, 300)))
        del data
        self.refused("cut.tif: has no band 2; it has 1", path, self.mesh, "--band", 2)
        whole = path.read_bytes()
        for data in whole[:300], whole[:-9000], b"", b"II*\0" + bytes(100):
            self.refused("cut.tif: (cannot be read|does not say where its cells are)", self.file("cut.tif", data), self.mesh)

    def test_raster_and_back(self):
        """A raster that abacus_postgis_raster makes of the mesh has the heights of the file at the centres of its cells."""
        if abacus.rows("SELECT count(*) FROM pg_available_extensions WHERE name IN ('abacus_postgis_raster', 'postgis_raster')") != [["2"]]:
            self.skipTest("PostGIS's rasters are not installed")
        data, path = self.tiff("there.tif", numpy.round(self.heights()[6:], 1))
        del data
        database = "abacus_points_raster"  # of its own: other tests want one without PostGIS
        abacus.psql(f"DROP DATABASE IF EXISTS {database}")
        abacus.psql(f"CREATE DATABASE {database}")
        self.addCleanup(abacus.psql, f"DROP DATABASE {database}")
        psql = lambda sql: subprocess.run(["psql", "-X", "-q", "-d", database, "-c", sql], capture_output=True, text=True, check=True).stdout
        psql("CREATE EXTENSION abacus_postgis_raster CASCADE")
        self.loads("-d", database, path, self.mesh)
        made = psql("SET postgis.gdal_enabled_drivers = 'GTiff'; "
                    f"COPY (SELECT encode(ST_AsTIFF(abacus_raster('{self.mesh}', ST_MakeEmptyRaster(17, 17, 1000.5, -17.7, .1, -.1, 0, 0, 25832))), 'hex')) TO STDOUT")
        back = gdal.Open(str(self.file("back.tif", bytes.fromhex(made.strip()))))
        there = gdal.Open(str(path))
        self.assertEqual(back.GetGeoTransform(), there.GetGeoTransform())
        self.assertEqual(back.GetSpatialRef().GetAuthorityCode(None), "25832")
        inside = back.GetRasterBand(1).GetMaskBand().ReadAsArray() != 0  # a centre at the border may be beyond it by a rounding
        self.assertTrue(inside[1:-1, 1:-1].all())
        numpy.testing.assert_allclose(back.GetRasterBand(1).ReadAsArray()[inside], there.GetRasterBand(1).ReadAsArray()[inside], rtol=1e-9)

    def many(self, name, count):
        """A file with more points than a block has."""
        rows = numpy.zeros(count, numpy.dtype([("x", "<i4"), ("y", "<i4"), ("rest", "V12")]))
        rows["x"], rows["y"] = numpy.divmod(numpy.arange(count) * 7919 % 16777259, 4096)
        return self.file(name, las(0, points=range(count), body=rows.tobytes()))

    def test_memory(self):
        """It does not grow with the number of points."""
        peaks = []
        for count in 200_000, 2_000_000:
            path = self.many("many.las", count)
            code = (f"import resource, subprocess, sys; status = subprocess.run(['/usr/bin/python3', {str(IMPORT)!r}, {str(path)!r}, '{self.mesh}', '--window', '0', '0', '1', '9']).returncode\n"
                    "print(resource.getrusage(resource.RUSAGE_CHILDREN).ru_maxrss); sys.exit(status)")
            self.setUp()
            done = subprocess.run(["/usr/bin/python3", "-c", code], capture_output=True, text=True, check=False)
            self.assertEqual(done.returncode, 0, done.stderr)
            peaks.append(int(done.stdout.split()[-1]))
        self.assertLess(peaks[1], peaks[0] + 20_000)  # the second file is 36 MB larger

    def test_ended(self):
        """A client that is ended leaves no mesh, no table and no session, even if it is killed."""
        path = self.many("ended.las", 1_500_000)
        for number, status in (signal.SIGTERM, 143), (signal.SIGINT, 130), (signal.SIGKILL, -9):
            client = subprocess.Popen(["/usr/bin/python3", str(IMPORT), str(path), self.mesh, "--table", f"{self.mesh}_table"], stderr=subprocess.PIPE, text=True,
                                      preexec_fn=None if number == signal.SIGKILL else lambda number=number: signal.signal(number, signal.SIG_DFL))
            sessions = f"SELECT count(*) FROM pg_stat_activity WHERE query LIKE '%{self.mesh}_table%' AND pid <> pg_backend_pid() AND state <> 'idle'"
            until = time.monotonic() + 100
            while abacus.rows(sessions + " AND query LIKE 'COPY%'") != [["1"]] and time.monotonic() < until:
                time.sleep(.02)
            client.send_signal(number)
            _, said = client.communicate(timeout=100)
            self.assertEqual((client.returncode, "Traceback" in said), (status, False), said)
            while abacus.rows(sessions) != [["0"]] and time.monotonic() < until:
                time.sleep(.05)
            self.assertEqual(abacus.rows(sessions), [["0"]])
            self.assertEqual(abacus.rows(f"SELECT to_regclass('{self.mesh}'), to_regclass('{self.mesh}_table')"), [["NULL"] * 2])


if __name__ == "__main__":
    unittest.main()
