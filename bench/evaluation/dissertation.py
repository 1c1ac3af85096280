"""The figures of the dissertation's chapter 5, as its text gives them.

Each table is a dictionary from the name of a row to its values, column by column, already
as text: what is printed there is printed here. POINTS_2D and POINTS_3D are the columns. What
is drawn, and not only printed, stands below as numbers.
"""

M, B = 10**6, 10**9

POINTS_2D = [1 * M, 10 * M, 40 * M, 100 * M, 200 * M, 1 * B]
FREQUENCIES = [0.25, 0.5, 0.75, 1, 1.5, 1.85]
POINTS_3D = [1.3 * M, 11.3 * M, 35.7 * M, 134 * M, 534.5 * M, 1 * B]

_vertices_2d = ["1 M", "10 M", "40 M", "100 M", "200 M", "1 B"]
_vertices_3d = ["1.3 M", "11.3 M", "35.7 M", "134 M", "534.5 M", "1 B"]
_triangles = ["2 M", "20 M", "80 M", "200 M", "400 M", "2 B"]
_tetrahedra = ["7 M", "63.4 M", "200.1 M", "738 M", "3.0 B", "5.7 B"]

FIGURE = {
    "5.2": {
        "vertices": _vertices_2d,
        "file": ["24 MB", "240 MB", "960 MB", "2.4 GB", "4.8 GB", "24 GB"],
    },
    "5.4": {
        "vertices": _vertices_3d,
        "file": ["40 MB", "362 MB", "1.14 GB", "4.29 GB", "17.1 GB", "32.75 GB"],
    },
    "5.5": {
        "vertices": _vertices_2d,
        "file": ["24 MB", "240 MB", "960 MB", "2.4 GB", "4.8 GB", "24 GB"],
        "database": ["25 MB", "246 MB", "981 MB", "2.5 GB", "4.90 GB", "24.5 GB"],
        "table": ["24.5 MB", "245 MB", "980 MB", "2.5 GB", "4.9 GB", "24.5 GB"],
        "index": ["65 KB", "279 KB", "1 MB", "2.4 MB", "5 MB", "24 MB"],
        "wall": ["0:00.5", "0:03.6", "0:27", "1:08", "2:25", "12:29"],
        "utilization": ["24 %", "38 %", "22 %", "23 %", "22 %", "21 %"],
        "user": ["0.02", "0.24", "1.2", "3.1", "5.6", "28"],
        "system": ["0.1", "1.15", "4.9", "13", "27.3", "133"],
        "throughput": ["91", "134", "72", "71", "67", "65"],
    },
    "5.6": {
        "vertices": _vertices_3d,
        "file": ["40 MB", "362 MB", "1.14 GB", "4.29 GB", "17.1 GB", "32.8 GB"],
        "database": ["41 MB", "370 MB", "1.17 GB", "4.39 GB", "17.5 GB", "33.5 GB"],
        "table": ["41 MB", "370 MB", "1.17 GB", "4.38 GB", "17.5 GB", "33.5 GB"],
        "index": ["80 KB", "400 KB", "1.2 MB", "4 MB", "32 MB", "33 MB"],
        "wall": ["0:01", "0:16", "0:48", "2:54", "11:21", "22:19"],
        "utilization": ["21 %", "13 %", "13 %", "14 %", "15 %", "15 %"],
        "user": ["0.04", "0.3", "1", "4", "15", "30"],
        "system": ["0.2", "1.8", "6", "21", "88", "171"],
        "throughput": ["71", "46", "48", "50", "51", "49"],
    },
    "5.7": {
        "vertices": _vertices_2d,
        "simplices": _triangles,
        "database": ["67 MB", "817 MB", "3.1 GB", "8.3 GB", "16.4 GB", "69.0 GB"],
        "table": ["67 MB", "814 MB", "3.1 GB", "8.3 GB", "16.3 GB", "68.7 GB"],
        "index": ["280 KB", "3 MB", "13 MB", "30 MB", "53 MB", "269 MB"],
        "wall": ["0:00:18", "0:03:30", "0:15:19", "0:43:10", "1:18:16", "7:17:12"],
        "utilization": ["99 %", "98 %", "94 %", "94 %", "93 %", "92 %"],
        "user": ["18", "204", "860", "2416", "4300", "23901"],
        "system": ["0.17", "3", "10", "41", "71", "369"],
        "amortized": ["18", "18", "23", "25", "24", "26"],
    },
    "5.8": {
        "vertices": _vertices_3d,
        "simplices": _tetrahedra,
        "database": ["330 MB", "3 GB", "9.6 GB", "36.8 GB", "137.2 GB", "256.0 GB"],
        "table": ["329 MB", "3 GB", "9.5 GB", "36.6 GB", "136.6 GB", "255.0 GB"],
        "index": ["1 MB", "12 MB", "38 MB", "146 MB", "546 MB", "1 GB"],
        "wall": ["0:05:47", "0:54:23", "3:09:08", "12:23:56", "51:07:00", "102:36:54"],
        "utilization": ["98 %", "99 %", "97 %", "97 %", "97 %", "93 %"],
        "user": ["334", "3227", "11083", "43278", "178394", "346468"],
        "system": ["8", "14", "32", "111", "405", "757"],
        "amortized": ["275", "289", "318", "333", "344", "361"],
    },
    "5.9": {
        "vertices": _vertices_2d,
        "simplices": _triangles,
        "total": ["0:00:19", "0:03:34", "0:15:46", "0:44:18", "1:20:41", "7:29:41"],
        "stage": ["0:00:01", "0:00:04", "0:00:27", "0:01:08", "0:02:25", "0:12:29"],
        "triangulate": ["0:00:18", "0:03:30", "0:15:19", "0:43:10", "1:18:16", "7:17:12"],
        "amortized": ["19", "21", "24", "27", "27", "27"],
        "Triangle (ii)": {
            "wall": ["0:00:21", "0:06:22", "0:38:06", "2:39:51", "9:15:49", "N/A"],
            "memory": ["114 MB", "1.1 GB", "4.6 GB", "11.4 GB", "22.8 GB", "114 GB (est.)"],
            "amortized": ["21", "38", "57", "96", "167", "N/A"],
        },
        "Triangle (dc)": {
            "wall": ["0:00:08", "0:01:19", "0:06:01", "1:07:51", "9:55:47", "N/A"],
            "memory": ["122 MB", "1.2 GB", "4.9 GB", "12.2 GB", "24.4 GB", "122 GB (est.)"],
            "amortized": ["8", "8", "9", "41", "179", "N/A"],
        },
    },
    "5.11": {
        "vertices": _vertices_3d,
        "simplices": _tetrahedra,
        "total": ["0:05:48", "0:54:39", "3:09:56", "12:26:50", "51:18:21", "102:59:13"],
        "stage": ["0:00:01", "0:00:16", "0:00:48", "0:02:54", "0:11:21", "0:22:19"],
        "triangulate": ["0:05:47", "0:54:23", "3:09:08", "12:23:56", "51:07:00", "102:36:54"],
        "amortized": ["268", "290", "319", "334", "346", "371"],
        "Pyramid": {
            "wall": ["0:03:16", "0:43:28", "inf", "N/A", "N/A", "N/A"],
            "memory": ["493 MB", "4.4 GB", "14 GB (est.)", "52 GB (est.)", "0.2 TB (est.)",
                       "0.4 TB (est.)"],
            "amortized": ["155", "231", "inf", "N/A", "N/A", "N/A"],
        },
    },
    "5.13": {
        "vertices": _vertices_2d,
        "simplices": _triangles,
        "database": ["92 MB", "1 GB", "4 GB", "11 GB", "21 GB", "94 GB"],
        "total": ["0:00:29", "0:06:11", "0:32:01", "1:33:01", "2:37:50", "14:49:05"],
        "stage": ["0:00:02", "0:00:23", "0:01:40", "0:05:09", "0:10:26", "0:52:14"],
        "triangulate": ["0:00:27", "0:05:48", "0:30:22", "1:27:52", "2:27:24", "13:56:51"],
        "amortized": ["27", "35", "46", "53", "47", "53"],
        "slowdown": ["1.4", "1.9", "2.0", "2.1", "2.0", "2.0"],
    },
    "5.17": {
        "vertices": _vertices_2d,
        "steps": ["11 M", "114 M", "514 M", "1.1 B", "2.6 B", "11.2 B"],
        "hits": ["99.9948 %", "99.9911 %", "99.9937 %", "99.9893 %", "99.9935 %", "99.9938 %"],
        "incircle": ["81.88 %", "81.95 %", "82.18 %", "82.68 %", "83.53 %", "89.82 %"],
    },
    "5.18": {
        "vertices": _vertices_3d,
        "steps": ["118 M", "1.1 B", "3.3 B", "12.4 B", "50.0 B", "97.1 B"],
        "hits": ["100 %", "99.99958 %", "99.99937 %", "99.99913 %", "99.99920 %", "99.99915 %"],
        "incircle": ["92.28 %", "92.29 %", "92.34 %", "92.18 %", "92.32 %", "92.41 %"],
    },
    "5.19": {
        "vertices": _vertices_2d,
        "misses": ["596", "10,118", "32,647", "120,520", "168,262", "694,189"],
        "quick": ["67.79 %", "69.16 %", "68.06 %", "69.32 %", "69.23 %", "62.83 %"],
        "ray": ["31.54 %", "29.74 %", "30.81 %", "29.80 %", "29.80 %", "36.01 %"],
        "concentric": ["0.67 %", "1.10 %", "1.13 %", "0.88 %", "0.97 %", "1.16 %"],
    },
    "5.20": {
        "vertices": _vertices_3d,
        "misses": ["0", "4,459", "21,512", "108,424", "398,532", "821,445"],
        "quick": ["N/A", "50.93 %", "52.50 %", "53.40 %", "51.91 %", "52.13 %"],
        "ray": ["N/A", "42.52 %", "40.75 %", "39.36 %", "40.79 %", "40.50 %"],
        "concentric": ["N/A", "6.55 %", "6.75 %", "7.24 %", "7.29 %", "7.37 %"],
    },
}

# Figure 5.21: functions and their share of the CPU time; the first three are hashing.
FUNCTIONS = [
    ("hash_uint32key", "24.63 %"),
    ("hash_insert", "11.95 %"),
    ("hash_search", "10.10 %"),
    ("incircle", "8.77 %"),
    ("delaunay2d_insert", "5.70 %"),
    ("release_triangle", "4.93 %"),
    ("direct_insert_triangle", "4.84 %"),
    ("octree_search", "4.51 %"),
    ("get_leaf", "2.40 %"),
    ("moma_newobj", "2.10 %"),
]

# §5.3.2: simplices deleted and created by an insertion, 2D and 3D.
DELETED_CREATED = {2: (4.7, 6.6), 3: (36.1, 41.6)}


def numbers(figure, row, engine=None):
    """The values of a row as numbers, None where there is none: seconds a million points."""
    values = FIGURE[figure][engine][row] if engine else FIGURE[figure][row]
    return [float(value) if value.replace(".", "").isdigit() else None for value in values]
