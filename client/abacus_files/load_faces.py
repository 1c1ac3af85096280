"""Points, lines and regions of a file that has triangles, too: the mesh has all of them if they belong together, else the triangles alone."""
from .english import counted
from .load import Script, table, wholes
from .load_plan import PlanScript
from .psql import literal, statement

KEY = "least(v0, v1, v2) AS a, greatest(v0, v1, v2) AS b, v0 # v1 # v2 AS c"  # of a triangle, whatever its first corner
FACES = "pg_temp.abacus_import_faces"  # a mesh for a while
# The file's triangles are those of its points and lines if they are as many, all or in its regions, and differ at most in the edges between points on one
# circle. This is so if abacus_load can change the file's triangles together with those outside of the regions: then it makes the same mesh of them.
TRIAL = """DECLARE
    faces bigint := (SELECT count(*) FROM abacus_import_simplices);
    simplices text := 'TABLE abacus_import_simplices';
    said text;
BEGIN
    BEGIN
        {steps}
        IF faces = (SELECT coalesce(sum(triangles), 0) FROM abacus_regions({mesh})) THEN
            simplices := simplices || {outside};
        ELSIF faces <> (SELECT value FROM abacus_stats({mesh}) WHERE name = 'simplices') THEN
            RAISE EXCEPTION '{other}';
        END IF;
        IF faces <> (SELECT count(*) FROM (SELECT {key} FROM abacus_import_simplices) AS f JOIN (SELECT {key} FROM abacus_simplices({mesh})) AS s USING (a, b, c)) THEN
            PERFORM abacus_load('{faces}', 'SELECT id, x, y FROM abacus_import_points', simplices, lines => {fixed});
            IF (SELECT value FROM abacus_stats('{faces}') WHERE name = 'changeable') = 0 THEN
                RAISE EXCEPTION '{other}';
            END IF;
            DROP TABLE {faces} CASCADE;
        END IF;
    EXCEPTION WHEN OTHERS THEN
        said := sqlerrm;
        RAISE WARNING USING MESSAGE = 'the triangles of the file are loaded as they are{without}: ' || said,
            HINT = 'With --retriangulate the mesh is made of its points{lines} alone.';
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
        without = ", without " + " and ".join(text for of, text in ((count, counted(count, "line")), (self.plan.regions, "regions")) if of) if count else ""
        lines = " and lines" if count else ""
        yield "DO " + literal(TRIAL.format(
            mesh=self.mesh, key=KEY, faces=FACES, steps="\n        ".join(f"EXECUTE {literal(step)};" for step in plan), lines=lines, without=without,
            other=f"its points{lines} make other triangles", fixed=literal(f"SELECT 1, v0, v1 FROM abacus_edges({self.mesh}, fixed => true)"),
            outside=literal(f" UNION ALL (SELECT v0, v1, v2 FROM abacus_cells({self.mesh}) EXCEPT "
                            f"SELECT v0, v1, v2 FROM abacus_regions({self.mesh}) AS r, abacus_cells({self.mesh}, within => r.region))"),
            load=literal(Script(self.name, faces, None, False, False, False).load_sql()), srid=literal(f"SELECT abacus_set_srid({self.mesh}, {self.found.srid})")))
