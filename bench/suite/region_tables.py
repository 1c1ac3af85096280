"""Tables of regions: how one is made and asked, and a terrain with breaklines and regions."""
from document import number, points, size, spread, table
from results import median, ratio, values
from results import spread as spread_of

WITHIN = {"all": "all", "region": "the region", "polygon": "the polygon"}
ENGINES = {"abacus": "Abacus", "postgis": "PostGIS, triangles under GiST"}


def seconds(triple):
    return f"{spread(triple)} s" if triple else "–"


def against(measurement, base):
    """Elapsed time and that of the processor, beside those of another measurement."""
    return tuple(number(ratio(median(measurement, figure), median(base, figure)) if base else None) for figure in ("wall", "cpu"))


def within(results):
    """What is asked of a region or a polygon, beside the same of all."""
    rows = []
    for m in results.all(what="within"):
        base = results.one(what="within", points=m["points"], question=m["question"], within="all")
        rows.append((f"{points(m['points'])} points: {m['question']} in {WITHIN[m['within']]}", ENGINES[m["engine"]], seconds(spread_of(m, "wall")),
                     seconds(spread_of(m, "cpu")), *against(m, None if m is base else base), len(m["samples"])))
    text = table(("question", "", "wall", "CPU", "÷ all", "CPU ÷ all", "runs"), rows)
    steps = [(f"{points(m['points'])} points: {m['step']}", seconds(spread_of(m, "wall")), seconds(spread_of(m, "cpu")), size(max(values(m, "memory"))),
              len(m["samples"])) for m in results.all(what="region step")]
    return text + "\n" * bool(text and steps) + table(("step", "wall", "CPU", "memory", "runs"), steps)


def terrain(results):
    """Ways from tables to contours, each with the time of its steps; then the changes."""
    rows = []
    for m in results.all(what="terrain"):
        base = results.one(what="terrain", points=m["points"], way="points alone")
        rows.append((m["way"], *(number(median(m, step)) for step in ("triangulate", "constrain", "region", "contours")), spread(spread_of(m, "wall")),
                     *against(m, None if m is base else base), number(median(m, "each")), size(max(values(m, "memory"))), len(m["samples"])))
    text = table(("", "triangulate s", "constrain s", "region s", "contours s", "all s", "÷ points alone", "CPU ÷ points alone",
                  "contours of each region s", "memory", "runs"), rows)
    edits = []
    for m in results.all(what="region edit"):
        base = results.one(what="region edit", points=m["points"], edit=m["edit"], inside=False)
        edits.append((f"a {m['edit']} {'into a region' if m['inside'] else 'where there are neither'}, median of {m['transactions']:,}",
                      f"{number(1000 * median(m, 'wall'))} ms", f"{number(1000 * m['percentile99'])} ms", against(m, base)[0] if m["inside"] else "–"))
    return text + "\n" * bool(text and edits) + table(("change", "a transaction", "99 of 100 at most", "÷ without lines and regions"), edits)
