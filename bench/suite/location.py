"""Parts that ask a mesh: places a second in one statement, and pages that a cold question reads."""
import random

import server
from points import PointSet


def build(points, count, cache="largest"):
    megabytes = server.cache_size(cache)
    with server.Session(abacus__cache_size=f"{megabytes}MB") as session:
        session.run(points.triangulate())
    server.query("VACUUM (FREEZE, ANALYZE) mesh")
    return {"dimension": points.dimension, "set": points.name, "points": count}


def create_places(points, count):
    """The table `places`, at random in the unit square or cube, and `ordered`, along the curve.

    The code of a simplex is a place on that curve. Rows lie in the tables in the order in which
    they are asked for.
    """
    server.drop("places", "ordered")
    columns = points.columns.split(", ")
    server.query("SELECT setseed(0.5); CREATE TABLE places AS SELECT id, "
                 + ", ".join(f"random() AS {column}" for column in columns)
                 + f" FROM generate_series(1, {count}) AS id")
    megabytes = server.cache_size("largest")
    with server.Session(abacus__cache_size=f"{megabytes}MB", max_parallel_workers_per_gather=0) as session:
        session.run(f"CREATE TABLE ordered AS SELECT {points.columns} FROM places ORDER BY"
                    f" coalesce((abacus_locate('mesh', {points.columns})).code, 0)")
    server.query("VACUUM (FREEZE, ANALYZE) places, ordered")


def a_call_each(points, table, places):
    return (f"SELECT count(abacus_locate('mesh', {points.columns}))"
            f" FROM (SELECT * FROM {table} LIMIT {places or 'ALL'}) AS place")


def one_call(points, table, places):
    return (f"SELECT count(code) FROM abacus_locate('mesh', 'SELECT id, {points.columns}"
            f" FROM {table} LIMIT {places or 'ALL'}')")


def measure_rate(suite, points, labels, table, cache, runs, places=None, form=a_call_each):
    """Samples of one SELECT over a table of places, or the first of them; the first time, which
    is not counted, fills the cache."""
    measurement = {"what": "locate", "order": table, "cache": cache, "form": form.__name__, **labels}
    statement = form(points, table, places)
    megabytes = tenth_of_mesh() if cache == "tenth" else server.cache_size(cache)
    with server.Session(abacus__cache_size=f"{megabytes}MB", max_parallel_workers_per_gather=0) as session:
        places = places or int(session.run(f"SELECT count(*) FROM {table}"))
        measurement |= {"places": places, "samples": []}
        session.run(statement)
        for _ in range(runs):
            sample = session.timed(statement)
            del sample["printed"]
            measurement["samples"].append(sample)
            suite.say(f"  {table:8} cache {cache:8} {form.__name__:11} {places / sample['wall']:12,.0f} places a second")
    suite.measurements.append(measurement)


def tenth_of_mesh():
    """A tenth of what the mesh takes on disk, in MB; the least that a cache can have is one."""
    return max(1, int(server.query("SELECT pg_table_size('mesh') / 10 / 1048576")))


def pages_read(points, places):
    """Pages of the mesh that one session after a fresh start reads for these places, by kind."""
    server.restart(autovacuum="off")
    with server.Session(abacus__cache_size="1MB") as session:
        for place in places:
            session.run(f"SELECT abacus_locate('mesh', {', '.join(map(repr, place))})")
        read = session.run("""
            SELECT count(*) FILTER (WHERE relfilenode = pg_relation_filenode('mesh')),
                   count(*) FILTER (WHERE level = 0), count(*) FILTER (WHERE level > 0)
            FROM pg_buffercache
                 LEFT JOIN index_pages ON relfilenode = pg_relation_filenode('mesh_pkey')
                                          AND relblocknumber = block
            WHERE relforknumber = 0 AND reldatabase = (SELECT oid FROM pg_database
                                                       WHERE datname = current_database())""")
    return [int(count) for count in read.split("|")]


PLACES_ON_END = 100


def measure_cold(suite, points, labels):
    """What is read for the first place of a session after a fresh start of the server, for a second
    place, far away, when the mesh is open, and for each of a hundred. Averages over samples make
    the figures."""
    server.drop("index_pages")
    server.create_extension("pg_buffercache")
    server.create_extension("pageinspect")
    server.query("CREATE TABLE index_pages AS"
                 " SELECT block, (bt_page_stats('mesh_pkey', block)).btpo_level AS level"
                 " FROM generate_series(1, pg_relation_size('mesh_pkey') / 8192 - 1) AS block")
    chance = random.Random(1)
    kinds = ("heap", "leaf", "inner")
    questions = [{"what": "cold", "question": question, **labels, "samples": []}
                 for question in ("first", "next", "each")]
    for _ in range({"full": 20, "quick": 20, "smoke": 1}[suite.mode]):
        places = [[chance.random() for _ in range(points.dimension)] for _ in range(PLACES_ON_END)]
        one, two, many = (pages_read(points, places[:count]) for count in (1, 2, PLACES_ON_END))
        second = [after - before for before, after in zip(one, two)]
        each = [pages / PLACES_ON_END for pages in many]
        for question, read in zip(questions, (one, second, each)):
            question["samples"].append(dict(zip(kinds, read)))
    suite.measurements += questions
    for measurement in questions:
        mean = sum(s["heap"] + s["leaf"] for s in measurement["samples"]) / len(measurement["samples"])
        suite.say(f"  cold, {measurement['question']:5} {mean:.2f} heap and leaf pages")


def location(dimension, sizes):
    """A part: a mesh of uniform points, warm and cold."""
    def measure(suite):
        size, places = sizes[suite.mode]
        points = PointSet(dimension, "uniform", size)
        runs = {"full": 5, "quick": 3, "smoke": 1}[suite.mode]
        server.restart(shared_buffers="2GB" if size >= 1000000 else "128MB")
        try:
            labels = build(points, points.create_table())
            create_places(points, places)
            measure_rate(suite, points, labels, "ordered", "largest", runs)
            measure_rate(suite, points, labels, "places", "largest", runs)
            measure_rate(suite, points, labels, "places", "tenth", runs, places // 50)
            for some in None, places // 10, places // 50:
                measure_rate(suite, points, labels, "places", "tenth", runs, some, one_call)
            measure_cold(suite, points, labels)
        finally:
            server.restart()
        server.drop("mesh", "mesh_vertices", "points", "places", "ordered", "index_pages")
    return measure
