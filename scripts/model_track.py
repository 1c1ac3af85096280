#!/usr/bin/python3
"""Random changes of tables of points and lines that a mesh follows, against a fresh mesh.

A world is a table of points, a table of lines (geometries of PostGIS, or points of lines), and a mesh that follows both, or only the lines.
Transactions change rows of both tables in any order, with savepoints and SET CONSTRAINTS, and each change is made in tables that no mesh
follows, too. From these a fresh mesh is made. Where that fails, since lines cross or a line names a point that is gone, the transaction must
have failed as well, and nothing may have changed. Otherwise vertices, triangles, values and lines must be those of the fresh mesh, vertices
that lines have made must be those that it lacks points for, and abacus_check must find no fault. Everything follows from seed and world number.
"""
import os
import random
import time

import model_worlds
from psql_session import Failure, Session

# what a fresh mesh refuses, the mesh that follows must refuse, in its own words
REFUSALS = ("lines cross", "no point", "two values", "length zero", "only one point", "cannot be deleted", "twice")
FIRST_ID = -10 ** 6  # of points, in some worlds


class World:
    def __init__(self, seed, number, options, done):
        self.chance = random.Random(f"{seed}.{number}.track")
        self.done = done
        self.extent = self.chance.choice((5, 8, 8, 12))
        self.drawn = self.chance.random() < 0.6
        self.with_points = not self.drawn or self.chance.random() < 0.75
        self.with_z = self.drawn and self.chance.random() < 0.6
        # points at one place may differ in value only where no two can be: which is the vertex depends on their order
        self.is_apart = self.chance.random() < 0.7
        self.taken = set()
        self.next_id = self.chance.choice((1, 1, FIRST_ID))
        self.next_line = 1
        self.script = os.path.join(options.folder, f"track-seed-{seed}-world-{number}.sql")
        self.log = open(self.script, "w", encoding="utf-8")
        self.session = Session()

    def run(self, sql, expected=()):
        self.log.write(sql + "\n")
        self.log.flush()
        return self.session.run(sql, expected)

    def rows(self, query):
        return [row.split("|") for row in self.run(query + ";").splitlines()]

    # ---- Statements: each is for the tables named {points} and {lines} ------------------------

    def place(self):
        return tuple(self.chance.randrange(2 * self.extent) / 2 for _ in range(2))

    def free_place(self):
        """A place for a point."""
        for _ in range(100):
            place = self.place()
            if not self.is_apart or place not in self.taken:
                self.taken.add(place)
                return place
        return None

    def height(self, place):
        return place[0] + 100 * place[1] if not self.is_apart or self.chance.random() < 0.98 else -1.0

    def some_points(self, most):
        return self.chance.sample(self.points, min(len(self.points), self.chance.randrange(1, most + 1)))

    def insert_points(self):
        rows = []
        for _ in range(self.chance.choice((1, 1, 2, 6))):
            place = self.free_place()
            if place is None:
                continue
            rows.append(f"({self.next_id}, {place[0]}, {place[1]}, {self.height(place)})")
            self.next_id += 1
        return rows and f"INSERT INTO {{points}} VALUES {', '.join(rows)};"

    def move_point(self):
        place = self.free_place()
        chosen = self.some_points(1)
        return chosen and place and f"UPDATE {{points}} SET (x, y, h) = ({place[0]}, {place[1]}, {self.height(place)}) WHERE id = {chosen[0][0]};"

    def value_points(self):
        chosen = [row[0] for row in self.some_points(3)]
        return chosen and self.is_apart and f"UPDATE {{points}} SET h = {self.chance.choice(('NULL', 'h', 'x + 100 * y'))} WHERE id IN ({', '.join(chosen)});"

    def hide_points(self):
        chosen = [row[0] for row in self.some_points(2)]
        return chosen and f"UPDATE {{points}} SET x = NULL WHERE id IN ({', '.join(chosen)});"

    def delete_points(self):
        chosen = [row[0] for row in self.some_points(3)]
        return chosen and f"DELETE FROM {{points}} WHERE id IN ({', '.join(chosen)});"

    def truncate_points(self):
        return "TRUNCATE {points};"

    def corners(self):
        """Places, or ids, of a line: mostly near to one another."""
        known = [(float(x), float(y), i) for i, x, y in self.points if x != ""]
        corners = []
        for _ in range(self.chance.choice((2, 2, 2, 3, 4))):
            if self.drawn and (len(known) < 2 or self.chance.random() < 0.35):
                place = self.place()
                if corners:
                    place = tuple(p + self.chance.randrange(-3, 4) / 2 for p in corners[-1][:2])
                corners.append((*place, None))
            elif known:
                few = self.chance.sample(known, min(12, len(known)))
                near = [k for k in few if not corners or k[:2] != corners[-1][:2]]
                if near:
                    corners.append(min(near, key=lambda k: abs(k[0] - corners[-1][0]) + abs(k[1] - corners[-1][1])) if corners else near[0])
        return corners

    def geometry(self):
        corners = self.corners()
        if len(corners) < 2:
            return None
        with_z = self.with_z and self.chance.random() < 0.9
        words = [f"{x} {y}" + (f" {self.height((x, y))}" if with_z else "") for x, y, _ in corners]
        letter = " Z" if with_z else ""
        if len(words) > 3 and self.chance.random() < 0.5:
            return f"'MULTILINESTRING{letter} (({', '.join(words[:2])}), ({', '.join(words[2:])}))'"
        return f"'LINESTRING{letter} ({', '.join(words)})'"

    def points_of(self, line):
        return [f"({line}, {10 * n}, {i}, 'hard')" for n, (_, _, i) in enumerate(self.corners())]

    def kind(self):
        return self.chance.choice(("hard", "hard", "soft"))

    def insert_line(self):
        line = self.next_line
        self.next_line += 1
        if self.drawn:
            geometry = self.geometry()
            return geometry and f"INSERT INTO {{lines}} VALUES ({line}, {geometry}, '{self.kind()}');"
        rows = self.points_of(line)
        return len(rows) > 1 and f"INSERT INTO {{lines}} VALUES {', '.join(rows)};"

    def a_line(self):
        return self.chance.choice(self.lines) if self.lines else None

    def move_line(self):
        line = self.a_line()
        if line is None:
            return None
        if self.drawn:
            geometry = self.geometry()
            return geometry and f"UPDATE {{lines}} SET geom = {geometry} WHERE line = {line};"
        chosen = self.some_points(1)
        return chosen and (f"UPDATE {{lines}} SET point = {chosen[0][0]} WHERE line = {line} AND "
                           f"position = {10 * self.chance.randrange(3)};")

    def shift_line(self):
        """Only one end, or the next corner of a line that is not drawn."""
        line = self.a_line()
        if line is None:
            return None
        if self.drawn:
            step = [self.chance.choice((-0.5, 0, 0.5)) for _ in range(2)]
            return (f"UPDATE {{lines}} SET geom = ST_SetPoint(geom, 0, ST_Translate(ST_StartPoint(geom), {step[0]}, {step[1]})) "
                    f"WHERE line = {line} AND ST_GeometryType(geom) = 'ST_LineString';")
        chosen = self.some_points(1)
        return chosen and f"INSERT INTO {{lines}} SELECT line, max(position) + 10, {chosen[0][0]}, min(kind) FROM {{lines}} WHERE line = {line} GROUP BY line;"

    def split_line(self):
        line = self.a_line()
        if line is None:
            return None
        new = self.next_line
        self.next_line += 1
        if self.drawn:
            return (f"INSERT INTO {{lines}} SELECT {new}, ST_RemovePoint(geom, 0), kind FROM {{lines}} WHERE line = {line} AND ST_NPoints(geom) > 2 "
                    f"AND ST_GeometryType(geom) = 'ST_LineString'; "
                    f"UPDATE {{lines}} SET geom = ST_MakeLine(ST_PointN(geom, 1), ST_PointN(geom, 2)) WHERE line = {line} AND ST_NPoints(geom) > 2 "
                    f"AND ST_GeometryType(geom) = 'ST_LineString';")
        return (f"INSERT INTO {{lines}} SELECT {new}, position, point, kind FROM {{lines}} WHERE line = {line} AND position > 0; "
                f"DELETE FROM {{lines}} WHERE line = {line} AND position > 10;")

    def renumber_line(self):
        line = self.a_line()
        new = self.next_line
        self.next_line += 1
        return line and f"UPDATE {{lines}} SET line = {new} WHERE line = {line};"

    def kind_line(self):
        line = self.a_line()
        return line and f"UPDATE {{lines}} SET kind = '{self.kind()}' WHERE line = {line};"

    def hide_line(self):
        line = self.a_line()
        return line and self.drawn and f"UPDATE {{lines}} SET geom = NULL WHERE line = {line};"

    def delete_line(self):
        line = self.a_line()
        return line and f"DELETE FROM {{lines}} WHERE line = {line};"

    def truncate_lines(self):
        return "TRUNCATE {lines};"

    CHANGES = ((4, "insert_points", 3), (3, "move_point", 2), (1, "value_points", 1), (0.5, "hide_points", 1), (2, "delete_points", 2),
               (0.15, "truncate_points", 1), (6, "insert_line", 3), (3, "move_line", 1), (2, "shift_line", 1), (2, "split_line", 1),
               (1, "renumber_line", 1), (1, "kind_line", 1), (0.5, "hide_line", 1), (3, "delete_line", 1), (0.2, "truncate_lines", 1))

    def statement(self):
        while True:
            name = self.chance.choices([c[1] for c in self.CHANGES], [c[0] for c in self.CHANGES])[0]
            if not self.with_points and "point" in name:
                continue
            sql = getattr(self, name)()
            if sql:
                self.done[name] += 1
                return sql

    # ---- Transactions -------------------------------------------------------------------------

    def look_at_tables(self):
        self.points = self.rows("SELECT id, x, y FROM points2 ORDER BY id")
        self.taken = {(float(x), float(y)) for _, x, y in self.points if x != ""}
        self.lines = [int(row[0]) for row in self.rows("SELECT DISTINCT line FROM lines2 ORDER BY line")]

    def both(self, sql):
        """A statement, for the followed tables and for the others."""
        return sql.format(points="points", lines="lines"), sql.format(points="points2", lines="lines2")

    def transaction(self):
        """Statements of a transaction, for both pairs of tables."""
        here, there = ["BEGIN;"], ["BEGIN;"]
        for _ in range(self.chance.choice((1, 1, 2, 3, 5))):
            for sql in self.both(self.statement()) if self.chance.random() < 0.9 else []:
                (there if "points2" in sql or "lines2" in sql else here).append(sql)
            if self.chance.random() < 0.15:
                here.append("SAVEPOINT s;")
                for _ in range(self.chance.choice((1, 2))):
                    here.append(self.both(self.statement())[0])
                here.append("ROLLBACK TO s;")
        if self.chance.random() < 0.15:
            here.append("SET CONSTRAINTS ALL IMMEDIATE;")
            if self.chance.random() < 0.5:
                here, there = [["SET CONSTRAINTS ALL DEFERRED;" if s.startswith("SET") else s for s in part] for part in (here, there)]
        return here + ["COMMIT;"], there + ["COMMIT;"]

    def keep(self):
        """The other tables get the rows of the followed ones."""
        self.run("BEGIN; TRUNCATE points2, lines2; INSERT INTO points2 SELECT * FROM points; INSERT INTO lines2 SELECT * FROM lines; COMMIT;")

    def fresh(self):
        """Makes the fresh mesh; False if it refuses the lines."""
        self.run("DROP TABLE IF EXISTS fresh CASCADE;")
        self.run("SELECT abacus_create('fresh', 2, '{h}'); SELECT abacus_insert('fresh', 'SELECT id, x, y, h FROM points2 WHERE x IS NOT NULL ORDER BY id');")
        rows = ("SELECT line, geom FROM lines2 WHERE geom IS NOT NULL" if self.drawn else "SELECT line, position, point FROM lines2")
        z = ", z => 'h'" if self.with_z else ""
        # points that have waited, since they spanned no triangle, are inserted with those of the lines
        return (self.run(f"SELECT abacus_constrain('fresh', '{rows}'{z});", REFUSALS) is not None and
                self.run("CALL abacus_build('fresh');", REFUSALS) is not None)

    def step(self):
        self.look_at_tables()
        here, there = self.transaction()
        self.run(" ".join(there))
        wanted = self.fresh()
        made = self.run(" ".join(here), REFUSALS) is not None
        if not made:
            self.run("ROLLBACK;")
        if made and not wanted and "ROLLBACK TO" in " ".join(here):
            self.done["rolled back what would fail"] += 1
        if made != wanted:
            raise Failure(f"{'followed' if made else 'refused'} what a fresh mesh {'refuses' if made else 'accepts'}: {' '.join(here)}")
        if not made:
            self.keep()
            if not self.fresh():
                raise Failure("the former tables give no fresh mesh")
        self.done["refused" if not made else "followed"] += 1
        self.compare()

    # ---- Comparison -----------------------------------------------------------------------------

    def vertices(self, mesh):
        rows = self.rows(f"SELECT id, x, y, attributes[1] FROM abacus_vertices('{mesh}') WHERE vertex = id OR vertex IS NULL")
        return {int(i): (float(x), float(y), h) for i, x, y, h in rows}

    def triangles(self, mesh, vertices):
        found = []
        for row in self.rows(f"SELECT v0, v1, v2 FROM abacus_simplices('{mesh}')"):
            places = [vertices[int(i)][:2] for i in row]
            k = places.index(min(places))
            found.append(tuple(places[k:] + places[:k]))
        return sorted(found)

    def edges(self, mesh, vertices):
        return sorted((*sorted((vertices[int(a)][:2], vertices[int(b)][:2])), lines)
                      for a, b, lines in self.rows(f"SELECT v0, v1, lines FROM abacus_edges('{mesh}', fixed => true)"))

    def differ(self, what, here, there):
        if here != there:
            raise Failure(f"{what} differ from those of a fresh mesh:\n{sorted(set(here) - set(there))}\nnot\n{sorted(set(there) - set(here))}")

    def compare(self):
        faults = self.run("SELECT * FROM abacus_check('mesh') LIMIT 5;")
        if faults:
            raise Failure(f"abacus_check:\n{faults}")
        here, there = self.vertices("mesh"), self.vertices("fresh")
        self.differ("vertices", sorted(here.values()), sorted(there.values()))
        self.differ("triangles", self.triangles("mesh", here), self.triangles("fresh", there))
        self.differ("fixed edges", self.edges("mesh", here), self.edges("fresh", there))
        places = "line, position, x, y, part" if self.drawn else "line, position, point, x, y, part"
        self.differ("lines", self.run(f"SELECT {places} FROM abacus_lines('mesh');").splitlines(),
                    self.run(f"SELECT {places} FROM abacus_lines('fresh');").splitlines())
        self.differ("kinds", self.run("SELECT DISTINCT line, kind FROM abacus_lines('mesh') ORDER BY line;").splitlines(),
                    self.run(f"SELECT DISTINCT line, kind FROM lines WHERE {'NOT ST_IsEmpty(geom)' if self.drawn else 'true'} ORDER BY line;").splitlines())
        lost = self.run("SELECT id, x, y, h FROM points WHERE x IS NOT NULL EXCEPT ALL SELECT id, x, y, attributes[1] FROM abacus_vertices('mesh');")
        if lost and self.with_points:
            raise Failure(f"points are not in the mesh: {lost}")
        made = self.run("SELECT count(*) FROM abacus_vertices('mesh') AS v WHERE NOT EXISTS (SELECT FROM points AS p WHERE p.id = v.id) "
                        "AND v.id >= 0;")
        if made != "0" and self.with_points:
            raise Failure(f"{made} vertices that lines have made have no negative id")
        self.done["comparisons"] += 1

    # ---- Worlds -----------------------------------------------------------------------------------

    def create(self):
        self.run("DROP TABLE IF EXISTS mesh, points, lines, points2, lines2 CASCADE;")
        parted = " PARTITION BY HASH (id)" if self.chance.random() < 0.15 else ""
        lines = "line int, geom geometry, kind text" if self.drawn else "line int, position int, point int, kind text"
        lines_parted = " PARTITION BY HASH (line)" if self.chance.random() < 0.15 else ""
        self.run(f"CREATE TABLE points (id int, x float8, y float8, h float8){parted}; CREATE TABLE lines ({lines}){lines_parted};"
                 f"CREATE TABLE points2 (id int, x float8, y float8, h float8); CREATE TABLE lines2 ({lines});")
        for table, is_parted in (("points", parted), ("lines", lines_parted)):
            if is_parted:
                self.run("".join(f"CREATE TABLE {table}_{n} PARTITION OF {table} FOR VALUES WITH (MODULUS 2, REMAINDER {n});" for n in range(2)))
        if self.chance.random() < 0.5:
            self.run("CREATE INDEX ON points (id); CREATE INDEX ON lines (line);")
        self.points, self.lines = [], []
        if self.with_points and self.chance.random() < 0.7:
            for _ in range(self.chance.choice((1, 5, 10))):
                for sql in self.both(self.insert_points() or "SELECT;"):
                    self.run(sql)
        self.run("SELECT abacus_create('mesh', 2, '{h}');")
        z = ", z => 'h'" if self.with_z else ""
        track = [f"SELECT abacus_track('mesh', 'points', deferred => {self.chance.choice(('true', 'false'))});"] if self.with_points else []
        track.append(f"SELECT abacus_track_lines('mesh', 'lines', kind => 'kind'{z});")
        if self.drawn:
            self.chance.shuffle(track)
        self.run(" ".join(track))

    def live(self, end):
        self.create()
        for _ in range(self.chance.choice((15, 40, 80))):
            if time.monotonic() > end:
                break
            if self.chance.random() < 0.2:
                self.run(f"SET abacus.cache_size = '{self.chance.choice((1, 1, 8))}MB'; SET abacus.threads = {self.chance.choice((1, 2, 3, 7))};")
            self.step()
        sync = ["SELECT abacus_track_lines('mesh', 'lines', kind => 'kind'" + (", z => 'h'" if self.with_z else "") + ");"]
        if self.with_points:
            sync.append("SELECT abacus_track('mesh', 'points');")
        self.run(" ".join(sync))
        self.fresh() # time may be over before the first step
        self.compare()

    def close(self, keep):
        self.session.close()
        self.log.close()
        if not keep:
            os.remove(self.script)


if __name__ == "__main__":
    model_worlds.main(__doc__, World, "{comparisons} comparisons in {worlds} worlds agree with fresh meshes")
