#!/usr/bin/python3
"""Shorelines, borders and rivers of the world, and the lines that they are, as a binary COPY stream.

Reads the binned GSHHG files of the Debian packages gmt-gshhg-full (resolution
f) and gmt-gshhg-high (h) and writes rows (id bigint, lon float8, lat float8)
for `COPY points FROM STDIN (FORMAT binary)` to standard output; or, asked for
`raw`, the records that the programs of bench/comparators read; or, asked for
`lines`, rows (line bigint, position bigint, point bigint): a line is a stretch
of a shore, border or river within a bin, and `point` is the id of a point.

A bin is a square of a whole number of degrees; bins run eastward from
Greenwich and southward from the pole. A point is two unsigned 16-bit fractions
of its bin, counted from the south-west corner, so 65535 of one bin and 0 of
the next are the same degree: the seams of the bins are full of duplicates.
Bins own consecutive segments and segments own consecutive points.
"""
import sys

import netCDF4
import numpy as np

FOLDER = "/usr/share/gmt-gshhg"
KINDS = ("GSHHS", "border", "river")

ROW = np.dtype([("fields", ">i2"),
                ("id_bytes", ">i4"), ("id", ">i8"),
                ("lon_bytes", ">i4"), ("lon", ">f8"),
                ("lat_bytes", ">i4"), ("lat", ">f8")])
LINE_ROW = np.dtype([("fields", ">i2"),
                     ("line_bytes", ">i4"), ("line", ">i8"),
                     ("position_bytes", ">i4"), ("position", ">i8"),
                     ("point_bytes", ">i4"), ("point", ">i8")])
RECORD = np.dtype([("id", "<i8"), ("lon", "<f8"), ("lat", "<f8")])
HEADER = b"PGCOPY\n\xff\r\n\0" + bytes(8)
TRAILER = b"\xff\xff"


def contents_of(path):
    """Longitudes (-180 to 180) and latitudes of one file, in file order, and the number of the first point of each line."""
    with netCDF4.Dataset(path) as data:
        data.set_auto_maskandscale(False)
        degrees = int(data["Bin_size_in_minutes"][0]) / 60
        columns = int(data["N_bins_in_360_longitude_range"][0])
        first_segment = data["Id_of_first_segment_in_a_bin"][:].astype(np.int64)
        first_point = data["Id_of_first_point_in_a_segment"][:].astype(np.int64)
        east = data["Relative_longitude_from_SW_corner_of_bin"][:].view(np.uint16)
        north = data["Relative_latitude_from_SW_corner_of_bin"][:].view(np.uint16)

    points_before = np.append(first_point, len(east))[np.append(first_segment, len(first_point))]
    bins = np.repeat(np.arange(len(first_segment)), np.diff(points_before))
    west = (bins % columns) * degrees
    west[west >= 180] -= 360
    south = 90 - (bins // columns + 1) * degrees
    return west + east * (degrees / 65535), south + north * (degrees / 65535), first_point


def fill(rows, **columns):
    """Sets columns of records, and the lengths of those that have one."""
    for name, values in columns.items():
        rows[name] = values
        if name + "_bytes" in rows.dtype.names:
            rows["fields"] = 3
            rows[name + "_bytes"] = 8
    return rows


def main():
    resolution, form = (sys.argv[1:] + ["f", "copy"][len(sys.argv) - 1:])[:2]
    if resolution not in ("f", "h") or form not in ("copy", "raw", "lines") or len(sys.argv) > 3:
        sys.exit("usage: gshhg_points.py [f|h [copy|raw|lines]]")
    out = sys.stdout.buffer
    if form != "raw":
        out.write(HEADER)
    count = lines = 0
    for kind in KINDS:
        lon, lat, first = contents_of(f"{FOLDER}/binned_{kind}_{resolution}.nc")
        ids = np.arange(count + 1, count + 1 + len(lon))
        if form == "lines":
            line = np.repeat(np.arange(len(first)), np.diff(np.append(first, len(lon))))
            rows = fill(np.empty(len(lon), LINE_ROW), line=line + lines + 1, position=ids - count - first[line], point=ids)
        else:
            rows = fill(np.empty(len(lon), ROW if form == "copy" else RECORD), id=ids, lon=lon, lat=lat)
        out.write(rows.data)
        count += len(lon)
        lines += len(first)
    if form != "raw":
        out.write(TRAILER)


if __name__ == "__main__":
    main()
