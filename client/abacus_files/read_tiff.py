"""GeoTIFF, by GDAL: cells of one band."""

import numpy

from . import cells
from .epsg import matching, unknown
from .psql import Failed

suffixes = (".tif", ".tiff")
types, usual, options = cells.types, cells.usual, ("window", "band")
CACHE = 256 << 20  # bytes


def library():
    try:
        from osgeo import gdal, gdal_array  # noqa: F401, the second one is needed for arrays
    except ImportError as error:
        raise Failed("GeoTIFF is read by GDAL, which is not installed (python3-gdal in Debian, gdal in PyPI)") from error
    gdal.UseExceptions()
    return gdal


def prepare(path):
    library()


class Reader:
    """`total`: cells; `srid`; `notes`."""

    def __init__(self, path, names, wanted):
        cells.check(names)
        gdal = library()
        gdal.SetCacheMax(CACHE)
        self.notes = []
        self.data = gdal.OpenEx(path, gdal.OF_RASTER, allowed_drivers=["GTiff"])
        self.band = self.find_band(gdal, wanted["band"])
        self.width, self.height = self.data.RasterXSize, self.data.RasterYSize
        self.total = self.width * self.height
        left, width, tilt, top, other, height = self.data.GetGeoTransform(can_return_null=True) or (0,) * 6
        if width == 0 or height == 0:
            raise Failed("does not say where its cells are")
        if tilt or other:
            raise Failed("its rows do not go from west to east; gdalwarp makes a raster whose rows do")
        self.cells = cells.Cells(left, top, width, height, wanted["window"])
        self.srid = self.find_srid()

    def find_band(self, gdal, asked):
        count, number = self.data.RasterCount, asked or 1
        if not 1 <= number <= count:
            raise Failed(f"has no band {number}; it has {count}")
        bands = [self.data.GetRasterBand(n) for n in range(1, count + 1)]
        left = [f"{n}{f' ({band.GetDescription()})' if band.GetDescription() else ''}" for n, band in enumerate(bands, 1)
                if n != number and band.GetColorInterpretation() != gdal.GCI_AlphaBand]
        if left:
            self.notes.append(f"bands other than {number} are left out: {', '.join(left)}")
        band = bands[number - 1]
        if gdal.DataTypeIsComplex(band.DataType):
            raise Failed(f"band {number} has complex numbers, which are not heights")
        return band

    def find_srid(self):
        system = self.data.GetSpatialRef()
        if system is None:
            self.notes.append("does not say its coordinate system: the mesh has no SRID unless abacus_set_srid gives it one")
            return 0
        part = "PROJCS" if system.IsProjected() else "GEOGCS"
        code = int(system.GetAuthorityCode(part)) if system.GetAuthorityName(part) == "EPSG" else matching(system.ExportToWkt())
        if code == 0:
            self.notes.append(unknown(system.GetName()))
        return code

    def blocks(self, size):
        yield from cells.joined(self.parts(size), size)
        self.notes += self.cells.notes()

    def parts(self, size):
        mask = self.band.GetMaskBand()
        scale, offset = self.band.GetScale(), self.band.GetOffset()
        for row in range(self.height):
            for column in range(0, self.width, size):
                count = min(size, self.width - column)
                with numpy.errstate(invalid="ignore"):
                    values = self.band.ReadAsArray(column, row, count, 1)[0].astype(float)
                valid = mask.ReadAsArray(column, row, count, 1)[0] != 0
                yield count, self.cells.row(values * (1 if scale is None else scale) + (offset or 0), valid, row, column)
