"""Points, lines and regions of a file that has triangles, too: the mesh has all of them if they belong together, else the triangles alone."""
from .load import Script, table, wholes
from .load_plan import PlanScript
from .psql import literal, statement

KEY = "least(v0, v1, v2) AS a, greatest(v0, v1, v2) AS b, v0 # v1 # v2 AS c"  # of a triangle, whatever its first corner
# The file's triangles are those of its points and lines if all of them are there, and there is no other, or none in its regions
TRIAL = """DECLARE
    faces bigint := (SELECT count(*) FROM abacus_import_simplices);
    said text;
BEGIN
    BEGIN
        {steps}
        IF faces <> (SELECT count(*) FROM (SELECT {key} FROM abacus_import_simplices) AS f JOIN (SELECT {key} FROM abacus_simplices({mesh})) AS s USING (a, b, c))
            OR faces NOT IN ((SELECT value FROM abacus_stats({mesh}) WHERE name = 'simplices'), (SELECT coalesce(sum(triangles), 0) FROM abacus_regions({mesh}))) THEN
            RAISE EXCEPTION 'they are not those of its points{lines}';
        END IF;
    EXCEPTION WHEN OTHERS THEN
        said := sqlerrm;
        RAISE WARNING USING MESSAGE = 'the triangles of the file are loaded as they are{without}: ' || said,
            HINT = 'With --retriangulate, points{lines} are taken without the triangles.';
        EXECUTE {load};
        EXECUTE {srid};
    END;
END"""


class FacesScript(PlanScript):
    def __init__(self, name, found):
        super().__init__(name, found)
        self.rows += len(found.faces.simplices)

    def tables(self):
        yield from super().tables()
        faces = self.found.faces
        yield from table("simplices", ["v0 bigint", "v1 bigint", "v2 bigint"], [(wholes, faces.ids[corner]) for corner in faces.simplices.T])

    def steps(self):
        plan, faces = list(super().steps()), self.found.faces
        count = len(set(self.plan.line.tolist()))
        without = ", without " + " and ".join(text for of, text in ((count, f"{count} lines"), (self.plan.regions, "regions")) if of) if count else ""
        yield "DO " + literal(TRIAL.format(
            mesh=self.mesh, key=KEY, steps="\n        ".join(f"EXECUTE {literal(step)};" for step in plan), lines=" and lines" if count else "", without=without,
            load=literal(Script(self.name, faces, None, False, False).load_sql()), srid=literal(f"SELECT abacus_set_srid({self.mesh}, {self.found.srid})")))
