#!/usr/bin/python3
"""Random changes of meshes against a model.

A world is two meshes of one dimension and what they should hold. `mesh` is
changed by abacus_insert, abacus_delete, abacus_stage, abacus_triangulate and
abacus_build; the table `model` records its points by plain SQL, in the same
transactions. `followed` follows the table `tracked` (abacus_track), at once, at
commit, or as one with partitions; it is
changed by INSERT, UPDATE, DELETE, MERGE, COPY and TRUNCATE. Changes are of one
point or many, in transactions with savepoints, committed or rolled back, with
large and small caches, and some are made to fail on the way.

Every few steps, inside transactions and outside, from this session and from
another, the points of both meshes must be those of their tables, abacus_check
must find no fault, places must be located in simplices that are there, and the
simplices must be those that CGAL makes of the same points (oracle_compare).

Everything follows from seed and world number. A failure prints both, and leaves
the SQL of the world in a file.
"""
import os
import random
import subprocess
import time

import model_worlds
from model_places import Places
from psql_session import Failure, Session

MOST_POINTS = {2: 20000, 3: 6000}  # enough to overflow a cache of 1 MB
BEGINNINGS = (1, 10, 100, 1000, 12000)
EXPECTED = ("injected failure", "out of memory", "lock timeout")
SIZES = (1, 1, 1, 2, 5, 20, 100, 600)


class LoggedSession(Session):
    """A session that writes its statements into a file."""

    def __init__(self, log):
        super().__init__()
        self.log = log

    def run(self, sql, expected=()):
        self.log.write(sql + "\n")
        self.log.flush()
        return super().run(sql, expected)


class World:
    """Two meshes, their tables, and the session that changes them."""

    def __init__(self, seed, number, options, done):
        self.chance = random.Random(f"{seed}.{number}")
        self.dimension = self.chance.choice((2, 3))
        self.axes = ("x", "y", "z")[:self.dimension]
        self.columns = ", ".join(("id",) + self.axes + ("h",))
        self.places = Places(self.chance, self.dimension)
        self.kind = self.chance.choice(Places.KINDS)
        self.steps = self.chance.choice((20, 60, 150))
        self.options = options
        self.done = done
        self.next_id = 1
        self.savepoints = None  # names; None outside a transaction
        self.next_savepoint = 1
        self.script = os.path.join(options.folder, f"seed-{seed}-world-{number}.sql")
        self.log = open(self.script, "w", encoding="utf-8")
        self.session = LoggedSession(self.log)
        self.watcher = Session()
        self.watcher.run("SET lock_timeout = '20ms';")

    # ---- Points ----------------------------------------------------------------

    def some(self, table, count):
        """SQL of a few rows of a table, chosen by the seed."""
        return (f"SELECT {self.columns} FROM {table} "
                f"ORDER BY hashint8extended(id, {self.chance.randrange(2**31)}), id LIMIT {count}")

    def fresh(self, count):
        """Rows of new points, as lists of words; with some attributes NULL, some zeros negative."""
        rows = []
        for _ in range(count):
            kind = self.kind if self.chance.random() < 0.9 else self.chance.choice(Places.KINDS)
            place = [repr(float(x)) if x != 0 or self.chance.random() < 0.7 else "-0.0"
                     for x in self.places.place(kind)]
            attribute = "NULL" if self.chance.random() < 0.1 else str(self.chance.randrange(100))
            rows.append([str(self.next_id)] + place + [attribute])
            self.next_id += 1
        return rows

    def copy(self, table, rows):
        """COPY of the rows."""
        lines = "\n".join("\t".join("\\N" if v == "NULL" else v for v in row) for row in rows)
        return f"COPY {table} ({self.columns}) FROM STDIN;\n{lines}\n\\."

    def values(self, rows):
        """The rows as SQL that gives columns of the right types."""
        types = ["bigint"] + ["float8"] * (self.dimension + 1)
        first = "(" + ", ".join(f"{v}::{t}" for v, t in zip(rows[0], types)) + ")"
        return "VALUES " + ", ".join([first] + ["(" + ", ".join(row) + ")" for row in rows[1:]])

    def size(self, table):
        """How many points a change is to have; many go when there are too many."""
        count = self.chance.choice(SIZES)
        there = int(self.session.run(f"SELECT count(*) FROM {table};"))
        return count, there > MOST_POINTS[self.dimension]

    # ---- Changes: SQL that changes mesh and table alike -----------------------------

    def call(self, function):
        """SQL up to the arguments; now and then of the function that tells what it has changed."""
        if function != "abacus_stage" and self.chance.random() < 0.3:
            return f"SELECT count(*) FROM {function}_returning"
        return f"SELECT {function}"

    def change_mesh(self):
        count, full = self.size("model")
        choice = self.chance.random()
        self.session.run("DROP TABLE IF EXISTS step;")
        if full or choice < 0.35:
            everything = self.chance.random() < 0.03
            self.done["delete"] += 1
            return [f"CREATE TEMP TABLE step AS {self.some('model', 10**9 if everything else count * (4 if full else 1))};",
                    "DELETE FROM model WHERE id IN (SELECT id FROM step);",
                    f"{self.call('abacus_delete')}('mesh', 'SELECT {self.columns[:-3] if self.chance.random() < 0.5 else self.columns} FROM step');"]
        if choice < 0.9:
            how = "abacus_stage" if choice > 0.7 else "abacus_insert"
            self.done[how[7:]] += 1
            return [f"CREATE TEMP TABLE step AS SELECT * FROM ({self.values(self.fresh(count))}) AS v ({self.columns});",
                    "INSERT INTO model TABLE step;",
                    f"{self.call(how)}('mesh', 'TABLE step');"]
        if choice < 0.93:
            self.done["attribute"] += 1
            return ["SELECT abacus_add_attribute('mesh', 'more'), abacus_drop_attribute('mesh', 'more');"]
        self.done["triangulate"] += 1
        return ["SELECT abacus_triangulate('mesh');"]

    def change_tracked(self):
        count, full = self.size("tracked")
        chosen = f"(SELECT id FROM ({self.some('tracked', count)}) AS c)"
        axis = self.chance.choice(self.axes)
        kinds = ["delete"] if full else [
            "insert", "insert", "copy", "delete", "move", "attribute", "vanish", "appear",
            "conflict", "merge", "truncate", "nothing"]
        kind = self.chance.choice(kinds)
        if kind == "truncate" and self.chance.random() < 0.6:
            kind = "insert"
        self.done["tracked " + kind] += 1
        if kind in ("insert", "copy"):
            rows = self.fresh(count)
            if kind == "copy":
                return [self.copy("tracked", rows)]
            return [f"INSERT INTO tracked ({self.columns}) {self.values(rows)};"]
        if kind == "delete":
            return [f"DELETE FROM tracked WHERE id IN {chosen};"]
        if kind == "move":
            return [f"UPDATE tracked SET {axis} = {axis} * 0.5 + 1 WHERE id IN {chosen};"]
        if kind == "attribute":
            return [f"UPDATE tracked SET h = coalesce(h, 0) + 1 WHERE id IN {chosen};"]
        if kind == "vanish":
            return [f"UPDATE tracked SET {axis} = NULL WHERE id IN {chosen};"]
        if kind == "appear":
            return ["UPDATE tracked SET " + ", ".join(f"{a} = coalesce({a}, id % 7)" for a in self.axes) +
                    f" WHERE {' + '.join(self.axes)} IS NULL;"]
        if kind == "nothing":
            return [f"UPDATE tracked SET note = 'seen' WHERE id IN {chosen};"]
        if kind == "truncate":
            return ["TRUNCATE tracked;"]
        taken = f"SELECT {self.columns} FROM tracked WHERE id IN {chosen}"
        rows = f"({taken} UNION ALL ({self.values(self.fresh(count))})) AS s ({self.columns})"
        if kind == "conflict":
            return [f"INSERT INTO tracked ({self.columns}) SELECT * FROM {rows} "
                    f"ON CONFLICT (id) DO UPDATE SET {axis} = tracked.{axis} + 0.25;"]
        return [f"MERGE INTO tracked AS t USING {rows} ON t.id = s.id "
                f"WHEN MATCHED AND t.id % 3 = 0 THEN DELETE "
                f"WHEN MATCHED THEN UPDATE SET {axis} = t.{axis} - 0.75 "
                f"WHEN NOT MATCHED THEN INSERT ({self.columns}) VALUES (" +
                ", ".join("s." + c for c in self.columns.split(", ")) + ");"]

    # ---- Steps ------------------------------------------------------------------------

    def change(self):
        """A change, perhaps one that fails on the way and then is as if it had never been."""
        statements = self.change_tracked() if self.chance.random() < 0.5 else self.change_mesh()
        alone = self.savepoints is None
        fails = self.chance.random() < 0.15
        self.session.run("BEGIN;" if alone else "SAVEPOINT change;")
        for statement in statements[:-1]:
            self.session.run(statement)
        if fails:
            self.session.run(f"SET abacus.fail_host_call = {int(10 ** self.chance.uniform(0, 3.3))};")
        went = self.session.run(statements[-1], EXPECTED if fails else ()) is not None
        if alone and went:
            went = self.session.run("COMMIT;", EXPECTED if fails else ()) is not None
        elif alone:
            self.session.run("ROLLBACK;")
        self.done["changes" if went else "failures"] += 1
        if not alone and not went:
            self.session.run("ROLLBACK TO change;")
        if fails:
            self.session.run("SET abacus.fail_host_call = 0;")

    def transaction(self):
        """A step of transactions; False if there was nothing to do."""
        choice = self.chance.random()
        if self.savepoints is None:
            if choice > 0.25:
                return False
            self.session.run("BEGIN;")
            self.savepoints = []
            return True
        if choice < 0.12:
            name = f"s{self.next_savepoint}"
            self.next_savepoint += 1
            self.session.run(f"SAVEPOINT {name};")
            self.savepoints.append(name)
        elif choice < 0.2 and self.savepoints:
            at = self.chance.randrange(len(self.savepoints))
            self.session.run(f"ROLLBACK TO {self.savepoints[at]};")
            del self.savepoints[at + 1:]
            self.done["rollbacks to savepoints"] += 1
        elif choice < 0.24 and self.savepoints:
            at = self.chance.randrange(len(self.savepoints))
            self.session.run(f"RELEASE {self.savepoints[at]};")
            del self.savepoints[at:]
        elif choice < 0.4:
            commits = self.chance.random() < 0.6
            self.session.run("COMMIT;" if commits else "ROLLBACK;")
            self.savepoints = None
            self.done["commits" if commits else "rollbacks"] += 1
        else:
            return False
        return True

    def step(self):
        self.done["steps"] += 1
        if self.chance.random() < 0.15:
            self.session.run(f"SET abacus.cache_size = '{self.chance.choice((1, 1, 2, 8, 128))}MB';")
            self.session.run(f"SET abacus.threads = {self.chance.choice((1, 1, 2, 3, 4, 7))};")
            self.session.run(f"SET abacus.tiny_intervals = {self.chance.choice(('on', 'off'))};")
            self.session.run(f"SET maintenance_work_mem = '{self.chance.choice((1, 4, 64))}MB';")
        if not self.transaction():
            if self.savepoints is None and self.chance.random() < 0.1:
                self.session.run(f"CALL abacus_build('mesh', {self.chance.choice((1, 7, 100, 10**6))});")
                self.done["builds"] += 1
            else:
                self.change()
        if self.chance.random() < 0.2:
            self.look()

    # ---- Comparison --------------------------------------------------------------------

    def differences(self, mesh, table):
        """SQL that counts how far the points of a mesh and a table differ."""
        names = ", ".join(self.axes)
        here = (f"SELECT id, {names}, h FROM {table} WHERE "
                + " AND ".join(f"{a} IS NOT NULL" for a in self.axes))
        there = f"SELECT id, {names}, attributes[1] FROM abacus_vertices('{mesh}')"
        return (f"SELECT (SELECT count(*) FROM ({here} EXCEPT ALL {there}) AS a) + "
                f"(SELECT count(*) FROM ({there} EXCEPT ALL {here}) AS b);")

    def look(self):
        """Both meshes, as this session and as others see them."""
        if self.savepoints is not None:  # a mesh that follows at commit must follow now
            self.session.run("SET CONSTRAINTS ALL IMMEDIATE;")
            if self.chance.random() < 0.7:
                self.session.run("SET CONSTRAINTS ALL DEFERRED;")
        for mesh, table in (("mesh", "model"), ("followed", "tracked")):
            for session in (self.session, self.watcher):
                found = session.run(self.differences(mesh, table),
                                    EXPECTED if session is self.watcher else ())
                if found is None:  # TRUNCATE keeps other readers out of the table
                    continue
                if found != "0":
                    raise Failure(f"{mesh} does not hold the points of {table}"
                                  + (" for another session" if session is self.watcher else ""))
                faults = session.run(f"SELECT * FROM abacus_check('{mesh}') LIMIT 5;")
                if faults:
                    raise Failure(f"abacus_check('{mesh}'):\n{faults}")
            self.locate(mesh)
            self.compare(mesh)
            self.done["comparisons"] += 1

    def locate(self, mesh):
        place = ", ".join(repr(float(x)) for x in self.places.place(self.kind))
        lost = self.session.run(
            f"SELECT count(*) FROM abacus_locate('{mesh}', {place}) AS l WHERE l.v0 IS NOT NULL "
            f"AND NOT EXISTS (SELECT FROM abacus_simplices('{mesh}') AS s WHERE s = l);")
        if lost != "0":
            raise Failure(f"abacus_locate('{mesh}', {place}) finds a simplex that is not there")

    def compare(self, mesh):
        """Simplices against CGAL's of the points that do not wait."""
        points, simplices = (os.path.join(self.options.folder, name)
                             for name in ("points.copy", "simplices.copy"))
        corners = ", ".join(f"v{i}" for i in range(self.dimension + 1))
        inside = f"FROM abacus_vertices('{mesh}') WHERE sequence IS NULL"
        for query, path in (
                (f"SELECT id, {', '.join(self.axes)} {inside} ORDER BY id", points),
                (f"SELECT code, {corners} FROM abacus_simplices('{mesh}')", simplices)):
            self.session.run(f"\\copy ({query}) TO '{path}' (FORMAT binary)")
        if self.session.run(f"SELECT count(*) {inside};") == "0":
            if self.session.run(f"SELECT count(*) FROM abacus_simplices('{mesh}');") != "0":
                raise Failure(f"{mesh} has simplices without vertices")
            return
        oracle = subprocess.run([self.options.oracle, str(self.dimension), points, simplices],
                                text=True, stdout=subprocess.PIPE, stderr=subprocess.STDOUT,
                                check=False)
        if oracle.returncode != 0:
            raise Failure(f"{mesh} is not CGAL's:\n{oracle.stdout}")

    def live(self, end):
        coordinates = ", ".join(f"{a} float8" for a in self.axes)
        domain = ""
        if self.chance.random() < 0.5:
            ones = ",".join(["1"] * self.dimension)
            domain = f", lower => '{{{ones.replace('1', '-1')}}}', upper => '{{{ones}}}'"
        create = [f"CREATE TABLE model (id bigint PRIMARY KEY, {coordinates}, h float8);",
                  f"CREATE TABLE tracked (note text, id bigint PRIMARY KEY, {coordinates}, h float8)"]
        follows = self.chance.choice(("at once", "at commit", "by partitions"))
        self.done[f"worlds that follow {follows}"] += 1
        if follows == "by partitions":
            create[-1] += " PARTITION BY HASH (id)"
            create += [f"CREATE TABLE tracked_{i} PARTITION OF tracked "
                       f"FOR VALUES WITH (modulus 3, remainder {i})" for i in range(3)]
        create = [statement.rstrip(";") + ";" for statement in create]
        for mesh in ("mesh", "followed"):
            create.append(f"SELECT abacus_create('{mesh}', {self.dimension}, '{{h}}'{domain});")
        self.session.run("DROP TABLE IF EXISTS model, tracked, mesh, followed;\n"
                         "SET client_min_messages = warning;\n" + "\n".join(create))
        for table in ("tracked", "model"):
            count = self.chance.choice(BEGINNINGS) // (1 if self.dimension == 2 else 3)
            if count > 0:
                self.session.run(self.copy(table, self.fresh(count)))
        track = f"SELECT abacus_track('followed', 'tracked', deferred => {follows == 'at commit'});"
        self.session.run(track)
        self.session.run(f"SELECT abacus_insert('mesh', 'SELECT {self.columns} FROM model');")
        for _ in range(self.steps):
            if time.monotonic() > end:
                break
            self.step()
        if self.savepoints is not None:
            self.session.run("COMMIT;")
            self.savepoints = None
        self.session.run("SELECT abacus_triangulate('mesh');")
        self.look()
        self.session.run(track)  # also verifies
        for mesh in ("mesh", "followed"):
            self.done["evictions"] += int(float(self.session.run(
                f"SELECT value FROM abacus_stats('{mesh}') WHERE name = 'evictions';")))

    def close(self, keep):
        self.session.close()
        self.watcher.close()
        self.log.close()
        if not keep:
            os.remove(self.script)


if __name__ == "__main__":
    model_worlds.main(__doc__, World, "{steps} steps in {worlds} worlds agree with the model", "--oracle")
