"""Regions in the worlds of model_lines.py: rings among the lines, outlines and seeds.

Which regions can be is not modelled, only what they are: if the mesh has them, a fresh mesh with the same points and lines must take them all, and
give them the same triangles.
"""
import math

from psql_session import Failure

# what refuses a region, or a change of lines because of one
REFUSALS = ("uses line", "ends at line", "is on a fixed edge", "leaks to the hull", "overlap", "is not closed", "is empty", "is outside of mesh")


class Regions:
    """A part of a World, which has a model, chance, words() and run()."""

    def enclose(self, model):
        """A ring through points that are near each other."""
        some = self.chance.sample(sorted(set(model.points.values())), min(25, len(set(model.points.values()))))
        x, y = some[0]
        near = sorted(some, key=lambda p: math.hypot(p[0] - x, p[1] - y))[:self.chance.choice((3, 4, 4, 7))]
        cx, cy = (sum(axis) / len(near) for axis in zip(*near))
        places = sorted(near, key=lambda p: (math.atan2(p[1] - cy, p[0] - cx), p))
        places.append(places[0])
        of = {place: i for i, place in model.points.items()}
        line, self.next_line = self.next_line, self.next_line + 1
        ids = [of[place] for place in places]
        model.lines[line] = (places, ids, "hard")
        rows = ", ".join(f"({line}, {at}, {i})" for at, i in enumerate(ids))
        return f"SELECT abacus_constrain('mesh', $q$VALUES {rows}$q$);", "cross" if model.is_crossed() else None

    def region(self, model):
        """Outlines, or a seed within one."""
        rings = [line for line, (places, *_) in model.lines.items() if len(places) > 3 and places[0] == places[-1]]
        if not rings:
            return None
        name = self.chance.choice(["r", "a region", "Ü'\""]) + str(self.chance.randrange(20))
        if name in model.regions:
            return None
        chosen = self.chance.sample(rings, min(len(rings), self.chance.choice((1, 1, 2, 3))))
        if self.chance.random() < 0.6:
            model.regions[name] = (sorted({self.first_equal(model, line, chosen) for line in chosen}), [])
            return self.making("mesh", {name: (chosen, [])}), None
        corners = [model.lines[line][0][:-1] for line in chosen]
        model.regions[name] = ([], sorted({tuple(sum(axis) // len(ring) for axis in zip(*ring)) for ring in corners}))
        return self.making("mesh", {name: model.regions[name]}), None

    def first_equal(self, model, line, chosen):
        """Of lines with the same segments the least one counts."""
        def segments(other):
            places = model.lines[other][0]
            return sorted(tuple(sorted(pair)) for pair in zip(places, places[1:]))
        return min(other for other in chosen if segments(other) == segments(line))

    def unregion(self, model):
        if not model.regions:
            return None
        name = self.chance.choice(sorted(model.regions))
        del model.regions[name]
        return f"SELECT abacus_unregion('mesh', $n${name}$n$);", None

    def making(self, mesh, regions):
        """SQL that gives regions to a mesh: {name: (lines, seeds)}."""
        outlines = ", ".join(f"($n${name}$n$, {line})" for name, (lines, _) in regions.items() for line in lines)
        seeds = ", ".join(f"($n${name}$n$, {self.words(place)})" for name, (_, places) in regions.items() for place in places)
        return " ".join(f"SELECT abacus_region('{mesh}', $q$VALUES {rows}$q$);" for rows in (outlines, seeds) if rows)

    def look_at_regions(self):
        """The mesh and the fresh one have the regions of the model, with the same triangles."""
        if self.model.regions:
            self.run(self.making("fresh", self.model.regions))
        here, there = ({name: self.triangles(mesh, f", $n${name}$n$") for (name,) in self.answer(f"SELECT region FROM abacus_regions('{mesh}')")} for mesh in ("mesh", "fresh"))
        if here.keys() != self.model.regions.keys():
            raise Failure(f"regions are {sorted(here)}, not {sorted(self.model.regions)}")
        for name, triangles in here.items():
            if triangles != there.get(name):
                raise Failure(f"region {name} differs from that of a fresh mesh: {set(triangles) ^ set(there.get(name, ()))}")
        self.done["regions compared"] += len(here)
