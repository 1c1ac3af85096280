"""Figures 5.17 to 5.21: the two caches, probing, translation."""
from beside import HERE, THERE, count, number, percent
from dissertation import FIGURE, FUNCTIONS
from document import table


class CacheFigures:
    def __init__(self, report):
        self.report = report
        self.generators = {
            "figure-5-17": lambda: self.hits(2, FIGURE["5.17"]),
            "figure-5-18": lambda: self.hits(3, FIGURE["5.18"]),
            "figure-5-19": lambda: self.probing(2, FIGURE["5.19"]),
            "figure-5-20": lambda: self.probing(3, FIGURE["5.20"]),
            "figure-5-21": self.functions}

    def hits(self, dimension, figure):
        entries = [{**entry, **entry["triangulate"]["stats"]} for entry in self.report.steps(dimension)]
        beside = self.report.beside(dimension, figure, entries)
        beside.add("points", "vertices", lambda e: count(e["points"]))
        beside.add("links followed", "steps", lambda e: count(e["steps"]))
        beside.add("cache misses", FIGURE["5.19" if dimension == 2 else "5.20"]["misses"],
                   lambda e: f"{e['misses']:,.0f}")
        beside.add("cache hit ratio", "hits", lambda e: percent(1 - e["misses"] / e["steps"], 5))
        beside.add("incircle cache hit ratio", "incircle",
                   lambda e: percent(e["incircle_hits"] / e["incircle_tests"]))
        beside.add("page searches a miss", None, lambda e: ratio(e["link_probes"], e["misses"]))
        beside.add("pages read, of those written", None, lambda e: percent(e["loads"] / e["stores"], 1))
        beside.add("translation, of the core's time", None,
                   lambda e: percent(e["translation_ns"] / e["total_ns"], 0))
        return beside.markdown()

    def probing(self, dimension, figure):
        entries = [{"key": m.get("frequency", m["points"]), "points": m["points"], **m["samples"][0]}
                   for m in self.report.results.all(what="probing", dimension=dimension)]
        beside = self.report.beside(dimension, figure, entries)
        beside.add("points", "vertices", lambda e: count(e["points"]))
        beside.add("cache misses", "misses", lambda e: f"{e['misses']:,}")
        for row, name in (("quick", "served by a quick probe"), ("ray", "… a ray-casting probe"),
                          ("concentric", "… a concentric probe")):
            beside.add(name, row, lambda e, row=row: percent(e[f"served_{row}"] / e["misses"])
                       if e["misses"] else "N/A")
        beside.add("pages read a miss", None, lambda e: ratio(
            e["pages_quick"] + e["pages_ray"] + e["pages_concentric"], e["misses"]))
        return beside.markdown()

    def functions(self):
        found = self.report.results.all(what="functions")
        ours = [(f"`{name}`" if " " not in name else name, percent(share)) for name, share in
                (found[0]["functions"] if found else [])]
        rows = []
        for place in range(max(len(FUNCTIONS), len(ours))):
            theirs = FUNCTIONS[place] if place < len(FUNCTIONS) else ("", "")
            rows.append((place + 1, f"`{theirs[0]}`" if theirs[0] else "", theirs[1],
                         *(ours[place] if place < len(ours) else ("", ""))))
        text = table(("", THERE, "share", HERE, "share"), rows)
        if found:
            modules = ", ".join(f"{percent(share, 1)} in {name}" for name, share in found[0]["modules"][:4])
            text += f"\n{count(found[0]['points'])} points; {modules}.\n"
        return text


def ratio(dividend, divisor):
    return number(dividend / divisor) if divisor else "N/A"
