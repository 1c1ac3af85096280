#!/usr/bin/python3
"""Random changes of the points and lines of a mesh against a model.

A world is a mesh, and what it should hold: points by id, lines by id, regions (model_regions.py). Points are inserted, staged and deleted, many of them on segments of
lines; lines are added, replaced and removed; attributes, too, which rewrites all pages. Changes are rolled back now and then, also to
savepoints. The model knows which changes must be refused: lines that cross, points that lines name, points through which two lines pass,
lines that are outlines of regions.

Then the lines must be those of the model, the fixed edges those that follow from it by exact arithmetic, the triangles and regions those of a
fresh mesh, and abacus_check must find no fault. Everything follows from seed and world number.
"""
import copy
import os
import random
import time

import numpy

import model_regions
import model_worlds
from psql_session import Failure, Session

UNIT = 2 ** 16  # places are whole numbers of 1 / UNIT, so halves are exact
REFUSALS = {"cross": "lines cross", "named": "cannot be deleted", "through": "cannot be deleted", "there": "already has a line", "used": "uses line"}


class Model:
    """Points and lines; places are pairs of integers."""

    def __init__(self):
        self.points = {}  # id: place
        self.lines = {}  # id: (places, ids, kind)
        self.regions = {}  # name: (lines, places of seeds)

    def segments(self, lines=None):
        for line, (places, _, kind) in (self.lines if lines is None else lines).items():
            for a, b in zip(places, places[1:]):
                yield line, a, b, kind

    def named(self):
        return {place for places, *_ in self.lines.values() for place in places}

    def used(self):
        """Lines that are outlines."""
        return {line for lines, _ in self.regions.values() for line in lines}

    def chain(self, a, b, places):
        """The places on a segment, in order along it."""
        (ax, ay), (bx, by) = a, b
        x, y = places[:, 0], places[:, 1]
        on = ((bx - ax) * (y - ay) == (by - ay) * (x - ax)) & (x >= min(ax, bx)) & (x <= max(ax, bx)) & (y >= min(ay, by)) & (y <= max(ay, by))
        return sorted(map(tuple, places[on].tolist()), key=lambda p: (p[0] - ax) * (bx - ax) + (p[1] - ay) * (by - ay))

    def fixed(self):
        """{(place, place): ({line}, is it hard)} of all edges on lines."""
        places = numpy.array(sorted(set(self.points.values())), dtype=numpy.int64)
        edges = {}
        for line, a, b, kind in self.segments():
            chain = self.chain(a, b, places)
            for p, q in zip(chain, chain[1:]):
                lines, hard = edges.get((min(p, q), max(p, q)), (set(), False))
                edges[min(p, q), max(p, q)] = (lines | {line}, hard or kind == "hard")
        return edges

    def is_crossed(self):
        """Whether two segments cross outside of the points."""
        def side(a, b, c):
            v = (b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0])
            return (v > 0) - (v < 0)
        edges = sorted(self.fixed())
        for n, (a, b) in enumerate(edges):
            for c, d in edges[n + 1:]:
                if c[0] > b[0]:
                    break
                if side(a, b, c) * side(a, b, d) < 0 and side(c, d, a) * side(c, d, b) < 0:
                    return True
        return False

    def passes_twice(self, p):
        """Whether lines pass through a place in two directions."""
        first = None
        for _, a, b, _ in self.segments():
            if self.chain(a, b, numpy.array([p], dtype=numpy.int64)):
                d = (b[0] - a[0], b[1] - a[1])
                if first is not None and first[0] * d[1] != first[1] * d[0]:
                    return True
                first = d
        return False


class World(model_regions.Regions):
    def __init__(self, seed, number, options, done):
        self.chance = random.Random(f"{seed}.{number}.lines")
        self.done = done
        self.extent = self.chance.choice((8, 14, 40, 1000))
        self.scale = self.chance.choice((1.0, 1.0, 2.0 ** -70, 2.0 ** 40)) / UNIT
        self.grain = UNIT if self.extent < 1000 else 1
        self.model = Model()
        self.next_id = self.next_line = 1
        self.script = os.path.join(options.folder, f"lines-seed-{seed}-world-{number}.sql")
        self.log = open(self.script, "w", encoding="utf-8")
        self.session = Session()

    def run(self, sql, expected=()):
        self.log.write(sql + "\n")
        self.log.flush()
        return self.session.run(sql, expected)

    # ---- Changes: each gives SQL, the model after it, and what refuses it ----------------

    def place(self):
        chance = self.chance.random()
        segments = list(self.model.segments())
        if chance < 0.3 and segments:  # the middle of a segment, or a quarter
            _, a, b, _ = self.chance.choice(segments)
            middle = tuple(p + (q - p) // self.chance.choice((2, 2, 4)) for p, q in zip(a, b))
            return middle
        if chance < 0.33 and self.model.points:
            return self.chance.choice(list(self.model.points.values()))
        if chance < 0.35:
            return tuple(self.chance.randrange(-4000, 4000) * UNIT for _ in range(2))
        return tuple(self.chance.randrange(self.extent * UNIT // self.grain) * self.grain for _ in range(2))

    def words(self, place):
        return ", ".join(repr(x * self.scale) + "::float8" for x in place)

    def fresh(self, count):
        points = {}
        for _ in range(count):
            points[self.next_id] = self.place()
            self.next_id += 1
        return points

    def rows(self, points):
        return "VALUES " + ", ".join(f"({i}::bigint, {self.words(p)}, {i % 7}::float8)" for i, p in points.items())

    def insert(self, model):
        points = self.fresh(self.chance.choice((1, 1, 2, 10, 60)))
        model.points |= points
        how = self.chance.choice(("abacus_insert", "abacus_insert", "abacus_stage"))
        sql = f"SELECT {how}('mesh', $q${self.rows(points)}$q$);"
        return sql if how == "abacus_insert" else sql + " SELECT abacus_triangulate('mesh');", None

    def delete(self, model):
        count = self.chance.choice((1, 1, 2, 5, 30))
        named = model.named()
        free = [i for i, p in model.points.items() if p not in named]
        if self.chance.random() < 0.1:
            free = list(model.points)
        elif self.chance.random() < 0.1:
            free = [i for i in free if model.passes_twice(model.points[i])]
        chosen = self.chance.sample(free, min(count, len(free), max(0, len(model.points) - 12)))
        if not chosen:
            return None
        rows = self.rows({i: model.points[i] for i in chosen})
        gone = {model.points.pop(i) for i in chosen} - set(model.points.values())
        why = None
        if gone & named:
            why = "named"
        elif any(model.passes_twice(p) for p in gone):
            why = "through"
        return f"SELECT abacus_delete('mesh', $q${rows}$q$);", why

    def constrain(self, model):
        lines, rows, added = {}, [], {}
        replaces = bool(model.lines) and self.chance.random() < 0.3
        is_new = self.chance.random() < 0.4
        for _ in range(self.chance.choice((1, 1, 1, 3, 8))):
            line = self.chance.choice(list(model.lines)) if model.lines and self.chance.random() < (0.8 if replaces else 0.03) else self.next_line
            if line in lines:
                continue
            self.next_line += line == self.next_line
            places, ids, position = [], [], self.chance.randrange(-5, 5)
            known = list((model.points | added).items())
            through = is_new and self.chance.random() < 0.3
            if through:  # a vertex is the middle
                (x, y), dx, dy = self.chance.choice(known)[1], *(self.chance.randrange(-3, 4) * self.grain for _ in range(2))
                ends = [(x - dx, y - dy), (x + dx, y + dy)]
                if (dx, dy) != (0, 0) and not set(ends) & (set(model.points.values()) | set(added.values())):
                    for place in ends:
                        added[self.next_id] = place
                        places.append(place)
                        ids.append(self.next_id)
                        rows.append((line, position, self.next_id, place))
                        self.next_id += 1
                        position += 2
            for _ in range(0 if through else self.chance.choice((2, 2, 3, 5))):
                number, place = self.chance.choice(known)
                if is_new and self.chance.random() < 0.5:
                    number, place = next(iter(self.fresh(1).items()))
                    if place in model.points.values() or place in added.values():
                        continue
                if places and self.chance.random() < 0.8 and number not in added:  # a near one
                    number, place = min(self.chance.sample(known, min(8, len(known))), key=lambda k: max(abs(k[1][0] - places[-1][0]), abs(k[1][1] - places[-1][1])) or 1e99)
                if places and places[-1] == place:
                    continue
                if number not in model.points:
                    added[number] = place
                places.append(place)
                ids.append(number)
                position += self.chance.randrange(1, 9)
                rows.append((line, position, number, place))
            if len(places) < 2:
                rows = [row for row in rows if row[0] != line]
                continue
            lines[line] = (places, ids, None)
        used = {row[2] for row in rows}
        added = {i: p for i, p in added.items() if i in used}
        if not lines:
            return None
        kind = self.chance.choice(("hard", "hard", "soft"))
        existing = "replace" if replaces else "error"
        why = "there" if not replaces and any(line in model.lines for line in lines) else None
        if lines.keys() & model.used():
            why = why or "used"
        for line, (places, ids, _) in lines.items():
            model.lines[line] = (places, ids, kind)
        model.points |= added
        if why is None and model.is_crossed():
            why = "cross"
        self.chance.shuffle(rows)
        if is_new:
            values = ", ".join(f"({line}, {at}, {i}, {self.words(p)})" for line, at, i, p in rows)
        else:
            values = ", ".join(f"({line}, {at}, {i})" for line, at, i, _ in rows)
        return f"SELECT abacus_constrain('mesh', $q$VALUES {values}$q$, kind => '{kind}', existing => '{existing}');", why

    def unconstrain(self, model):
        if not model.lines:
            return None
        gone = self.chance.sample(list(model.lines), min(len(model.lines), self.chance.choice((1, 1, 3, 100 if self.chance.random() < 0.1 else 2))))
        for line in gone:
            del model.lines[line]
        why = "used" if set(gone) & model.used() else None
        return "SELECT abacus_unconstrain('mesh', 'VALUES " + ", ".join(f"({line})" for line in gone) + "');", why

    def rewrite(self, _):
        return "SELECT abacus_add_attribute('mesh', 'more'), abacus_drop_attribute('mesh', 'more');", None

    def change(self):
        """One change, made or refused."""
        chosen = self.chance.choices((self.insert, self.delete, self.constrain, self.unconstrain, self.rewrite, self.enclose, self.region, self.unregion),
                                     (4, 4, 6, 1.5, 0.3, 2, 2, 0.4))[0]
        model = copy.deepcopy(self.model)
        made = chosen(model)
        if made is None:
            return
        sql, why = made
        self.run("SAVEPOINT change;")
        of_lines = (self.constrain, self.unconstrain, self.enclose)
        by_regions = model_regions.REFUSALS if chosen == self.region or chosen in of_lines and model.regions else ()
        went = self.run(sql, (*((REFUSALS[why],) if why else ()), *by_regions))
        if why and went is not None:
            raise Failure(f"not refused ({why}): {sql}")
        if went is None:
            self.run("ROLLBACK TO change;")
        else:
            self.model = model
        self.done[f"{chosen.__name__}{' refused: ' + (why or 'regions') if went is None else ''}"] += 1

    def step(self):
        if self.chance.random() < 0.3:
            self.run(f"SET abacus.cache_size = '{self.chance.choice((1, 1, 8))}MB'; SET abacus.threads = {self.chance.choice((1, 2, 3, 7))}; "
                     f"SET abacus.tiny_intervals = {'on' if self.chance.random() < 0.1 else 'off'};")
        self.run("BEGIN;")
        before = copy.deepcopy(self.model)
        for _ in range(self.chance.choice((1, 1, 2, 5))):
            self.change()
            if self.chance.random() < 0.25:
                kept = copy.deepcopy(self.model)
                self.run("SAVEPOINT s;")
                for _ in range(self.chance.choice((1, 2, 4))):
                    self.change()
                if self.chance.random() < 0.3:
                    self.look()
                self.run("ROLLBACK TO s;")
                self.model = kept
                self.done["rollbacks to savepoints"] += 1
        if self.chance.random() < 0.15:
            self.run("ROLLBACK;")
            self.model = before
            self.done["rollbacks"] += 1
        else:
            self.run("COMMIT;")
        self.done["steps"] += 1

    # ---- Comparison ------------------------------------------------------------------------

    def answer(self, query):
        return [row.split("|") for row in self.run(query + ";").splitlines()]

    def triangles(self, mesh, within=""):
        rows = []
        for row in self.answer(f"SELECT v0, v1, v2 FROM abacus_simplices('{mesh}'{within})"):
            places = [self.model.points[int(i)] for i in row]
            k = places.index(min(places))
            rows.append(tuple(places[k:] + places[:k]))
        return sorted(rows)

    def look(self):
        faults = self.run("SELECT * FROM abacus_check('mesh') LIMIT 5;")
        if faults:
            raise Failure(f"abacus_check:\n{faults}")
        model = self.model
        wanted = sorted((line, i, *p, kind) for line, (places, ids, kind) in model.lines.items() for i, p in zip(ids, places))
        found = sorted((int(line), int(i), round(float(x) / self.scale), round(float(y) / self.scale), kind)
                       for line, i, x, y, kind in self.answer("SELECT line, point, x, y, kind FROM abacus_lines('mesh')"))
        if found != wanted:
            raise Failure(f"lines are\n{found}\nnot\n{wanted}")
        found = {}
        for a, b, lines, kind in self.answer("SELECT v0, v1, array_to_string(lines, ','), kind FROM abacus_edges('mesh', fixed => true)"):
            edge = tuple(sorted((model.points[int(a)], model.points[int(b)])))
            if edge in found:
                raise Failure(f"edge {edge} comes twice")
            found[edge] = ({int(line) for line in lines.split(",")}, kind == "hard")
        wanted = model.fixed()
        if found != wanted:
            other = {e: (found.get(e), wanted.get(e)) for e in found.keys() | wanted.keys() if found.get(e) != wanted.get(e)}
            raise Failure(f"fixed edges differ (found, wanted): {other}")
        self.run("DROP TABLE IF EXISTS fresh CASCADE; SET abacus.tiny_intervals = off;")
        self.run(f"SELECT abacus_triangulate('fresh', $q${self.rows(model.points)}$q$);")
        if model.lines:
            # by place: a point that a line was given may be gone if another one is there
            rows = ", ".join(f"({line}, {n}, NULL, {self.words(p)})" for line, (places, *_) in model.lines.items() for n, p in enumerate(places))
            self.run(f"SELECT abacus_constrain('fresh', $q$VALUES {rows}$q$);")
        here, there = self.triangles("mesh"), self.triangles("fresh")
        if here != there:
            raise Failure(f"triangles differ from a fresh mesh: {set(here) ^ set(there)}")
        self.look_at_regions()
        self.done["comparisons"] += 1

    def live(self, end):
        self.run("DROP TABLE IF EXISTS mesh CASCADE; DROP TABLE IF EXISTS fresh CASCADE;")
        points = self.fresh(self.chance.choice((12, 40, 150, 150, 3000, 9000)))
        points |= {self.next_id + n: p for n, p in enumerate([(0, 0), (self.extent * UNIT, 0), (0, self.extent * UNIT)])}
        self.next_id += 3
        self.model.points = points
        self.run(f"SELECT abacus_triangulate('mesh', $q${self.rows(points).replace('::float8)', '::float8 AS h)', 0)}$q$, '{{h}}');")
        for n in range(self.chance.choice((10, 30, 60))):
            if time.monotonic() > end:
                break
            self.step()
            if self.chance.random() < 0.4 or n < 3:
                self.look()
        self.look()

    def close(self, keep):
        self.session.close()
        self.log.close()
        if not keep:
            os.remove(self.script)


if __name__ == "__main__":
    model_worlds.main(__doc__, World, "{steps} steps in {worlds} worlds agree with the model")
