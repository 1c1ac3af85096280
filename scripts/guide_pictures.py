#!/usr/bin/python3
"""Draws the pictures of docs/guide.md and docs/breaklines.md, each from a mesh that it makes and asks.

    guide_pictures.py            writes docs/images/guide_*.svg and breaklines_*.svg
    guide_pictures.py --check    says which of them differ from what it draws; writes nothing

It works in a scratch database of the server that the environment names. The examples of docs/breaklines.md make the
meshes of its pictures, which are left out if PostGIS is not installed.
"""
import json
import math
import pathlib
import subprocess
import sys

from doc_examples import BLOCK

DOCS = pathlib.Path(__file__).resolve().parents[1] / "docs"
DATABASE = "abacus_guide_pictures"
SETUP = """
CREATE EXTENSION abacus;
CREATE TABLE sites (id bigint PRIMARY KEY, x float8, y float8, height float8);
INSERT INTO sites VALUES (1, 0, 0, 10), (2, 4, 0, 12), (3, 4, 3, 20), (4, 0, 3, 14), (5, 1, 1, 11), (6, 3, 1, 13), (7, 2, 2, 18);
SELECT abacus_triangulate('terrain', 'SELECT id, x, y, height FROM sites');
SELECT abacus_triangulate('grown', 'SELECT id, x, y FROM sites');
SELECT abacus_triangulate('field', 'SELECT i, (i * 0.7548776662466927) % 1 * 4, (i * 0.5698402909980532) % 1 * 3 FROM generate_series(1, 1000) AS i');
"""
SCALE = 100
MARGIN = 40
BLUE, RED, GREY, GREEN, PURPLE = "#2563a8", "#c0392b", "#8a8f98", "#2e8b57", "#7d3c98"
REGIONS = {"lake": "#cfe3f5", "road": "#d9d9d9", "building": "#e6d0ad"}


def psql(database, *arguments, script=None, stderr=None):
    result = subprocess.run(["psql", "-X", "-q", "-A", "-t", "-v", "ON_ERROR_STOP=1", "-d", database, *arguments],
                            input=script, stdout=subprocess.PIPE, stderr=stderr, text=True, check=True)
    return result.stdout


def rows(query):
    return json.loads(psql(DATABASE, "-c", f"SELECT coalesce(json_agg(q), '[]') FROM ({query}) AS q"))


def number(value):
    text = f"{value:.1f}"
    return text[:-2] if text.endswith(".0") else text


class Picture:
    """An SVG in which y grows upwards, over a mesh from (0, 0) to (width, height)."""

    def __init__(self, title, width=4, height=3, scale=SCALE):
        self.title = title
        self.scale = scale
        self.size = width * scale + 2 * MARGIN, height * scale + 2 * MARGIN
        self.left, self.top = MARGIN, height * scale + MARGIN
        self.parts = []

    def origin(self, x, y):
        """What is drawn from now on is moved by this much."""
        self.left, self.top = MARGIN + x * self.scale, self.size[1] - MARGIN - y * self.scale

    def at(self, x, y):
        return x * self.scale + self.left, self.top - y * self.scale

    def path(self, places, closed=False, **style):
        self.paths([places], closed, **style)

    def paths(self, lines, closed=False, **style):
        """Lines as one path, in which rings within rings are holes."""
        steps = (" L".join(",".join(map(number, self.at(*place))) for place in line) + ("Z" if closed else "") for line in lines)
        self.add("path", d="M" + " M".join(steps), **style)

    def add(self, name, text=None, **attributes):
        written = " ".join(f'{key.replace("_", "-")}="{value}"' for key, value in attributes.items())
        self.parts.append(f"<{name} {written}/>" if text is None else f"<{name} {written}>{text}</{name}>")

    def circle(self, x, y, radius, **style):
        cx, cy = self.at(x, y)
        self.add("circle", cx=number(cx), cy=number(cy), r=number(radius), **style)

    def text(self, x, y, text, dx=0, dy=0, **style):
        px, py = self.at(x, y)
        style = {"font_size": 15, "fill": "#222", **style}
        self.add("text", text, x=number(px + dx), y=number(py + dy), **style)

    def write(self):
        width, height = self.size
        return (f'<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 {number(width)} {number(height)}" width="{number(width)}" '
                f'font-family="Helvetica, Arial, sans-serif">\n<title>{self.title}</title>\n'
                f'<rect width="100%" height="100%" fill="white"/>\n' + "\n".join(self.parts) + "\n</svg>\n")


def triangles(picture, mesh="terrain", fill="none", **style):
    for row in rows(f"SELECT v0, v1, v2, corners FROM abacus_cells('{mesh}') ORDER BY v0, v1, v2"):
        picture.path(row["corners"], closed=True, fill=fill, **{"stroke": BLUE, "stroke_width": 1.5, **style})


def vertices(picture, mesh="terrain"):
    for row in rows(f"SELECT id, x, y FROM abacus_vertices('{mesh}') ORDER BY id"):
        picture.circle(row["x"], row["y"], 4, fill="#222")
        picture.text(row["x"], row["y"], row["id"], dx=7, dy=-7)


def centroid(corners):
    return [sum(axis) / len(corners) for axis in zip(*corners)]


def circumcircle(corners):
    (ax, ay), (bx, by), (cx, cy) = corners
    d = 2 * (ax * (by - cy) + bx * (cy - ay) + cx * (ay - by))
    a, b, c = ax * ax + ay * ay, bx * bx + by * by, cx * cx + cy * cy
    x, y = (a * (by - cy) + b * (cy - ay) + c * (ay - by)) / d, (a * (cx - bx) + b * (ax - cx) + c * (bx - ax)) / d
    return x, y, math.hypot(ax - x, ay - y)


def corners_of(simplex):
    (row,) = rows(f"SELECT corners FROM abacus_cells('terrain') AS c, {simplex} AS s WHERE (c.v0, c.v1, c.v2) = (s.v0, s.v1, s.v2)")
    return row["corners"]


def mesh():
    picture = Picture("Seven points and their Delaunay triangulation, with one empty circumcircle")
    corners = corners_of("abacus_locate('terrain', 2, 1.5)")
    picture.path(corners, closed=True, fill="#dbe9f7")
    triangles(picture)
    x, y, radius = circumcircle(corners)
    picture.circle(x, y, radius * SCALE, fill="none", stroke=RED, stroke_width=1.5, stroke_dasharray="6 4")
    vertices(picture)
    return picture


def walk():
    picture = Picture("A place, the triangle that contains it, and the three neighbours of that triangle")
    here = corners_of("abacus_locate('terrain', 2, 1.5)")
    for facet in range(3):
        other = corners_of(f"(SELECT n.* FROM abacus_locate('terrain', 2, 1.5) AS h, abacus_walk('terrain', h, {facet}) AS n)")
        picture.path(other, closed=True, fill="#eef4e6")
        picture.text(*centroid(other), f"facet {facet}", dx=-22, dy=4, fill=GREEN)
    picture.path(here, closed=True, fill="#dbe9f7")
    triangles(picture)
    vertices(picture)
    picture.circle(2, 1.5, 5, fill=RED)
    picture.text(2, 1.5, "(2, 1.5)", dx=8, dy=5, fill=RED)
    return picture


def curve():
    picture = Picture("1,000 points: triangles of one page have one colour; the line joins their vertices along the curve")
    shades = ["#dbe9f7", "#fbe7d5", "#e3f1e3", "#f0e4f5", "#fdf6cf", "#e0efef"]
    pages = [row["code"] for row in rows("SELECT code FROM field WHERE code >= 0 ORDER BY code")]
    of_page = {page: [] for page in pages}
    for row in rows("SELECT code, v0, v1, v2, corners FROM abacus_cells('field') ORDER BY code, v0, v1, v2"):
        of_page[max(page for page in pages if page <= row["code"])].append(row["corners"])
    for page, cells in enumerate(of_page.values()):
        steps = ("M" + "L".join(",".join(map(number, picture.at(*place))) for place in cell) + "Z" for cell in cells)
        picture.add("path", d="".join(steps), fill=shades[page % len(shades)], stroke="#b9c3cf", stroke_width=0.5)
    points = rows("SELECT x, y FROM abacus_numbered_vertices('field') ORDER BY number")
    picture.path([(row["x"], row["y"]) for row in points], fill="none", stroke=BLUE, stroke_width=1.2)
    return picture


def contours():
    picture = Picture("Contours of the height, every metre")
    for row in rows("SELECT v0, v1, v2, corners, \"values\" FROM abacus_cells('terrain') ORDER BY v0, v1, v2"):
        height = sum(value for (value,) in row["values"]) / 3
        shade = int(245 - (height - 10) / 10 * 90)
        picture.path(row["corners"], closed=True, fill=f"#{shade:02x}{min(shade + 12, 255):02x}{max(shade - 35, 0):02x}",
                     stroke="#ffffff", stroke_width=1)
    for row in rows("SELECT id, value, path FROM abacus_contours('terrain', 1) ORDER BY id"):
        path = row["path"]
        picture.path(list(zip(path[::2], path[1::2])), fill="none", stroke="#7a4a1d", stroke_width=2.5 if row["value"] % 5 == 0 else 1)
    for row in rows("SELECT x, y, height FROM sites ORDER BY id"):
        picture.circle(row["x"], row["y"], 4, fill="#222")
        picture.text(row["x"], row["y"], number(row["height"]), dx=7, dy=-7)
    return picture


def change():
    found = rows("SELECT created, v0, v1, v2, corners FROM abacus_insert_returning('grown', 'VALUES (8, 1.8, 1.2)') ORDER BY created, v0, v1, v2")
    created = [row["corners"] for row in found if row["created"]]
    removed = [row["corners"] for row in found if not row["created"]]
    picture = Picture(f"Point 8 is inserted: {len(created)} new triangles take the place of {len(removed)}")
    for corners in created:
        picture.path(corners, closed=True, fill="#eef4e6")
    triangles(picture, "grown", stroke=GREY)
    for corners in removed:
        picture.path(corners, closed=True, fill="none", stroke=RED, stroke_width=1.5, stroke_dasharray="5 4")
    for corners in created:
        picture.path(corners, closed=True, fill="none", stroke=GREEN, stroke_width=2)
    vertices(picture, "grown")
    return picture


def voronoi():
    picture = Picture("Voronoi cells of the vertices, within the window from (0, 0) to (4, 3)")
    shades = ["#dbe9f7", "#fbe7d5", "#e3f1e3", "#f0e4f5", "#fdf6cf", "#e0efef", "#f3dede"]
    for row in rows("SELECT vertex, ring FROM abacus_voronoi('terrain', '{0,0}', '{4,3}') ORDER BY vertex"):
        picture.path(row["ring"], closed=True, fill=shades[row["vertex"] % len(shades)], stroke=RED, stroke_width=1.5)
    triangles(picture, stroke=GREY, stroke_width=1, stroke_dasharray="3 3")
    vertices(picture)
    return picture


def example(heading, everything_before=False):
    """The SQL of docs/breaklines.md up to a heading, or the first block below it."""
    before, after = (DOCS / "breaklines.md").read_text().split(f"\n## {heading}", 1)
    return "".join(block["sql"] for block in BLOCK.finditer(before)) if everything_before else BLOCK.search(after)["sql"]


def regions(picture):
    for region, shade in REGIONS.items():
        border = {}
        for row in rows(f"SELECT ring, x, y FROM abacus_hull('ground', within => '{region}') ORDER BY ring, position"):
            border.setdefault(row["ring"], []).append((row["x"], row["y"]))
        picture.paths(border.values(), closed=True, fill=shade, fill_rule="evenodd")


def fixed_edges(picture, width):
    for kind, colour in (("soft", PURPLE), ("hard", RED)):
        found = rows(f"""SELECT a.x AS ax, a.y AS ay, b.x AS bx, b.y AS by FROM abacus_edges('ground', fixed => true) AS e
            JOIN abacus_vertices('ground') AS a ON a.id = v0 JOIN abacus_vertices('ground') AS b ON b.id = v1 WHERE kind = '{kind}' ORDER BY v0, v1""")
        picture.paths([((row["ax"], row["ay"]), (row["bx"], row["by"])) for row in found], fill="none", stroke=colour, stroke_width=width)


def breaklines_mesh():
    picture = Picture("Spot heights without and with a road, a lake, a building and a parcel", 250, 80, 3.6)
    for mesh, left in (("bare", 0), ("ground", 130)):
        picture.origin(left, 0)
        if mesh == "ground":
            regions(picture)
        sides = {tuple(sorted(map(tuple, (c[i], c[i - 1])))) for c in (row["corners"] for row in rows(f"SELECT corners FROM abacus_cells('{mesh}')")) for i in range(3)}
        picture.paths(sorted(sides), fill="none", stroke=BLUE, stroke_width=0.5)
    fixed_edges(picture, 2)
    return picture


def breaklines_contours():
    picture = Picture("Contours of the land, which is the parcel without the lake and the building", 120, 80, 5)
    regions(picture)
    for row in rows("SELECT id, value, path FROM abacus_contours('ground', 0.25, within => 'land') ORDER BY id"):
        path = row["path"]
        picture.path(list(zip(path[::2], path[1::2])), fill="none", stroke="#7a4a1d", stroke_width=1.8 if row["value"] == int(row["value"]) else 0.7)
    fixed_edges(picture, 1)
    return picture


def breaklines_rings():
    picture = Picture("Seven sets of rings: regions by parity, and what ST_BuildArea makes of them", 43, 14, 18)
    sets = {}
    for row in rows("SELECT name, ST_AsGeoJSON(geom)::json->'coordinates' AS ring FROM rings ORDER BY line"):
        sets.setdefault(row["name"], []).append(row["ring"])
    for name, lines in sets.items():
        inside = [row["corners"] for row in rows(f"SELECT corners FROM abacus_cells('plan', within => '{name}') ORDER BY v0, v1, v2")]
        (built,) = rows(f"SELECT ST_AsGeoJSON(ST_Multi(ST_Normalize(ST_BuildArea(ST_Node(ST_Collect(geom))))))::json->'coordinates' AS area FROM rings WHERE name = '{name}'")
        for bottom, areas, shade, edge in ((7, [[cell] for cell in inside], "#dbe9f7", BLUE), (0, built["area"], "#fbe7d5", GREY)):
            picture.origin(0, bottom)
            for area in areas:
                picture.paths(area, closed=True, fill=shade, fill_rule="evenodd", stroke=shade, stroke_width=1)
            picture.paths(lines, fill="none", stroke=edge, stroke_width=2)
        picture.text(min(x for x, _ in lines[0]), -1, name)
    return picture


def main():
    check = sys.argv[1:] == ["--check"]
    if sys.argv[1:] and not check:
        sys.exit(__doc__)
    psql("postgres", "-c", "SET client_min_messages = warning", "-c", f"DROP DATABASE IF EXISTS {DATABASE}", "-c", f"CREATE DATABASE {DATABASE}")
    psql(DATABASE, script=SETUP)
    pictures = {f"guide_{draw.__name__}": draw for draw in (mesh, walk, curve, contours, change, voronoi)}
    if rows("SELECT 1 FROM pg_available_extensions WHERE name = 'postgis'"):
        # some of the examples show errors
        psql(DATABASE, "-v", "ON_ERROR_STOP=0", stderr=subprocess.DEVNULL, script=example("Lines change later", everything_before=True) +
             example("Rings twice") + "SELECT abacus_triangulate('bare', 'SELECT id, geom FROM spots');\n")
        pictures |= {draw.__name__: draw for draw in (breaklines_mesh, breaklines_contours, breaklines_rings)}
    wrong = 0
    for name, draw in pictures.items():
        file, drawn = DOCS / f"images/{name}.svg", draw().write()
        if check:
            if not file.exists() or file.read_text() != drawn:
                wrong += 1
                print(f"{file.name} is not what scripts/guide_pictures.py draws")
        else:
            file.write_text(drawn)
    psql("postgres", "-c", f"DROP DATABASE {DATABASE}")
    sys.exit(1 if wrong else 0)


if __name__ == "__main__":
    main()
