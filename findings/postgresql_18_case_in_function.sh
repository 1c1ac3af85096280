#!/bin/bash
# An SQL function that checks a text before it converts it raises an error in PostgreSQL 18, and did not in 17.
#
# Version     PostgreSQL 17.5 and 18.7, as compiled in PGlite 0.3.16 and 0.5.17 (npm: @electric-sql/pglite)
# Behaviour   Since 18 the statements of SQL functions are planned with the values of their arguments. The planner then evaluates
#             each branch of a CASE that it can, also the one that will not be taken, because the check is not immutable and has to
#             wait. So the conversion fails before the check is made. 17 knew no values of arguments. PostgreSQL's manual warns of CASE where
#             values are known while a query is planned; what changed is that they are known now. An immutable check is safe.
# Output      17: NULL for "dry"; 18: invalid input syntax for type double precision: "dry"
# Expected    NULL in both
# Way out     Let the check return what is converted: depth_of(note) that is NULL for "dry", then depth_of(note)::double precision.
set -euo pipefail
. "$(dirname "$0")/tools.bash"

command -v npm >/dev/null || exit 77
for version in 0.3.16 0.5.17; do
    npm install --silent --no-audit --no-fund --prefix "$tmp/$version" @electric-sql/pglite@$version >&2 || exit 77
done

cat >"$tmp/wells.mjs" <<'JAVASCRIPT'
const { PGlite } = await import(`${process.argv[2]}/node_modules/@electric-sql/pglite/dist/index.js`);
const database = new PGlite();
await database.exec(`
    CREATE FUNCTION is_depth(note text) RETURNS boolean LANGUAGE plpgsql STABLE AS $$ BEGIN RETURN note ~ '^[0-9.]+$'; END $$;
    CREATE FUNCTION depth_of(note text) RETURNS text LANGUAGE plpgsql STABLE AS $$ BEGIN RETURN substring(note FROM '^[0-9.]+$'); END $$;
    CREATE FUNCTION guarded(note text) RETURNS double precision LANGUAGE sql STABLE STRICT
        AS 'SELECT CASE WHEN is_depth(note) THEN note::double precision END';
    CREATE FUNCTION nested(note text) RETURNS double precision LANGUAGE sql STABLE STRICT
        AS 'SELECT depth_of(note)::double precision'`);

async function answer(query) {
    return database.query(query).then((result) => JSON.stringify(result.rows), (error) => `${error.code} ${error.message}`);
}
console.log((await database.query("SHOW server_version")).rows[0].server_version);
for (const name of ["guarded", "nested"]) {
    console.log(await answer(`SELECT well, ${name}(note) AS depth FROM (VALUES (1, '4.5'), (2, 'dry')) AS t (well, note)`));
}
JAVASCRIPT

read_by_both='[{"well":1,"depth":4.5},{"well":2,"depth":null}]'
expect "PostgreSQL 17" "17.5
$read_by_both
$read_by_both" "$(node "$tmp/wells.mjs" "$tmp/0.3.16")"
expect "PostgreSQL 18" "18.7
22P02 invalid input syntax for type double precision: \"dry\"
$read_by_both" "$(node "$tmp/wells.mjs" "$tmp/0.5.17")"
