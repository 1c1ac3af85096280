"""Tables of levels of detail."""
from document import number, points, table
from results import median, ratio


def levels(results):
    """The levels beside the build of their mesh; then tiles by zoom, a column for each size of mesh."""
    rows = []
    for m in results.all(what="levels"):
        base = results.one(what="levels", points=m["points"], made="mesh")
        rows.append((f"{points(m['points'])} points: {'the mesh' if m['made'] == 'mesh' else 'six levels'}", f"{number(median(m, 'wall'))} s", f"{number(median(m, 'cpu'))} s",
                     *(("–", "–") if m is base else (number(ratio(median(m, figure), median(base, figure))) for figure in ("wall", "cpu")))))
    text = table(("", "wall", "CPU", "÷ build", "CPU ÷ build"), rows)
    tiles = [(f"{points(m['points'])} points, zoom {m['zoom']}", f"{number(1000 * median(m, 'cpu'))} ms", f"{number(1000 * median(m, 'wall'))} ms", number(median(m, "pages")),
              number(median(m, "bytes")), len(m["samples"])) for m in results.all(what="tile mesh")]
    return text + "\n" * bool(text and tiles) + table(("a tile", "CPU", "wall", "pages", "bytes", "tiles"), tiles)
