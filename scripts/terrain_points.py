#!/usr/bin/python3
"""The Jacksboro fault elevation model as text for COPY.

Reads jacksboro_fault_dem.npz of the Debian package python-matplotlib-data and
writes rows (id, x, y, height), tab-separated: x eastward and y northward in
metres from the south-west corner, height in metres above the sea. The spacing
is rounded to whole metres, so that the grid is exact and every cell's four
corners are cocircular: a degenerate input on purpose.
"""
import math
import sys

import numpy as np

FILE = "/usr/share/matplotlib/mpl-data/sample_data/jacksboro_fault_dem.npz"
METRES_PER_DEGREE = 111_320


def main():
    with np.load(FILE) as data:
        heights = data["elevation"]
        middle = math.radians((float(data["ymin"]) + float(data["ymax"])) / 2)
        dx = round(float(data["dx"]) * METRES_PER_DEGREE * math.cos(middle))
        dy = round(float(data["dy"]) * METRES_PER_DEGREE)
    rows, columns = heights.shape
    for row in range(rows):
        y = (rows - 1 - row) * dy
        sys.stdout.writelines(
            f"{row * columns + column + 1}\t{column * dx}\t{y}\t{heights[row, column]}\n"
            for column in range(columns))


if __name__ == "__main__":
    main()
