"""Tables of what Abacus replaces: insertion by an R-tree, and location in rows."""
import math

from document import number, points, size, spread, table
from results import median, ratio
from results import spread as spread_of

FIGURE_2_9 = (("search the R-tree", "search_percent", "16"), ("in-circle tests", "incircle_percent", "0.1"),
              ("delete from the R-tree", "delete_percent", "74"),
              ("… of that, searching for what is to be deleted", "delete_search_percent", "98"),
              ("insert into the R-tree", "insert_percent", "4"),
              ("other operations", "other_percent", "5"),
              ("boxes looked at that are those of simplices found", "search_efficiency_percent", "10"),
              ("rows deleted again", "deleted_percent", "67"))
DISSERTATION_POINTS = 100000
EXTRAPOLATED = 10**6
ORDERS = {"ordered": "along the curve", "places": "at random"}
ROWS_NAMES = {"abacus": "`abacus_locate` among the columns", "abacus_joined": "`abacus_locate` in a `LATERAL` join",
              "rows": "rows, test in double precision", "exact_rows": "rows, exact test (`numeric`)",
              "postgis": "PostGIS polygons under GiST, `ST_Intersects`"}


def goose_pairs(results, dimension):
    """(points, Goose, Abacus), ascending."""
    pairs = []
    for goose in results.all(what="goose", engine="goose", dimension=dimension):
        abacus = results.one(what="goose", engine="abacus", dimension=dimension, points=goose["points"])
        pairs.append((goose["points"], goose, abacus))
    return sorted(pairs, key=lambda pair: pair[0])


def exponent(pairs, engine):
    """Of the growth of CPU time with the number of points: from the second least to the most."""
    first, last = pairs[min(1, len(pairs) - 2)], pairs[-1]
    return math.log(median(last[engine], "cpu") / median(first[engine], "cpu")) / math.log(last[0] / first[0])


def goose(results):
    text = ""
    for dimension in 2, 3:
        pairs = goose_pairs(results, dimension)
        if not pairs:
            continue
        text += f"### {dimension}D\n\n" + times(pairs) + "\n"
        if len(pairs) > 1:
            text += extrapolation(pairs) + "\n\n"
        text += shares(pairs) + "\n"
    return text


def times(pairs):
    rows = [(f"{count:,}", spread(spread_of(goose, "cpu")), number(1e6 * median(goose, "cpu") / count),
             number(median(abacus, "cpu")), number(ratio(median(goose, "cpu"), median(abacus, "cpu"))),
             number(ratio(median(goose, "wall"), median(abacus, "wall"))),
             number(median(goose, "found_per_search")), number(median(goose, "hits_per_search")),
             number(median(goose, "boxes_per_search")),
             number((median(goose, "table_bytes") + median(goose, "index_bytes")) / median(goose, "simplices")))
            for count, goose, abacus in pairs]
    return table(("points", "Goose, CPU s", "µs a point", "Abacus, CPU s", "CPU ÷ Abacus", "wall ÷ Abacus",
                  "found a search", "hits a search", "boxes a search", "bytes a simplex"), rows)


def extrapolated(pairs, engine):
    """CPU seconds for a million points, by the growth between the larger sizes."""
    last = pairs[-1]
    return median(last[engine], "cpu") * (EXTRAPOLATED / last[0]) ** exponent(pairs, engine)


def extrapolation(pairs):
    seconds = extrapolated(pairs, 1)
    return (f"CPU time grows with the {exponent(pairs, 1):.2f}th power of the number of points, that of Abacus"
            f" with the {exponent(pairs, 2):.2f}th. Extrapolated to a million points, Goose takes"
            f" {number(seconds)} s, {number(seconds / extrapolated(pairs, 2))} times as long as Abacus.")


def times_abacus(results, figure="cpu"):
    """Time of Goose to that of Abacus in the plane, at the dissertation's number of points."""
    for count, goose_run, abacus in goose_pairs(results, 2):
        if count == DISSERTATION_POINTS:
            return ratio(median(goose_run, figure), median(abacus, figure))
    return None


def times_abacus_extrapolated(results):
    pairs = goose_pairs(results, 2)
    return extrapolated(pairs, 1) / extrapolated(pairs, 2) if len(pairs) > 1 else None


def shares(pairs):
    """Figure 2.9, at its number of points, or the nearest."""
    count, measured, _ = min(pairs, key=lambda pair: abs(pair[0] - DISSERTATION_POINTS))
    rows = [(name, percent, number(median(measured, figure))) for name, figure, percent in FIGURE_2_9]
    return table(("percent", "dissertation, 2D", f"here, {count:,} points"), rows)


def times_rows(habit, figure="cpu"):
    """Places that Abacus locates in the time that a table takes for one, along the curve, in the
    largest mesh, of the most places."""
    def measured(results):
        tables = results.all(what="rows", engine=habit, order="ordered")
        if not tables:
            return None
        slow = max(tables, key=lambda m: (m["points"], m["places"]))
        abacus = results.one(what="rows", engine="abacus", order="ordered", points=slow["points"],
                             places=slow["places"])
        return ratio(median(slow, figure), median(abacus, figure))
    return measured


def rows(results):
    found = []
    for abacus in sorted(results.all(what="rows", engine="abacus"),
                         key=lambda m: (m["points"], m["places"], m["order"])):
        places = abacus["places"]
        for m in results.all(what="rows", order=abacus["order"], points=abacus["points"], places=places):
            found.append((ROWS_NAMES[m["engine"]], f"{places:,} {ORDERS[m['order']]}", points(m["points"]),
                          number(places / median(m, "cpu")), number(places / median(m, "wall")),
                          number(ratio(median(m, "cpu"), median(abacus, "cpu"))), size(m["bytes"])))
    return table(("", "places", "points", "places a CPU second", "places a second",
                  "CPU time ÷ `abacus_locate`", "on disk"), found) if found else ""
