#!/bin/bash
# postgres (Postgres.js) reads an array with a lower bound as an array within an array.
#
# Version     postgres 3.4.9 (npm), PostgreSQL 15
# Behaviour   PostgreSQL writes the bounds of an array before it if they do not begin with 1: [0:1]={1,2}. An int2vector,
#             for example pg_index.indkey, begins with 0, and so does an array that was filled from element 0.
#             Postgres.js returns such an array one level deeper, without an error. A NULL in any array is NaN, or
#             the text NULL (its issue 1049). pg 8.23.1 (node-postgres) returns all of them right.
# Output      [ [ 1.5, NaN ] ] for '[0:1]={1.5,NULL}'::float8[]
# Expected    [ 1.5, null ]
# Way out     Select to_json of the array; or, if it has no NULL, the slice a[:], which begins with 1.
set -euo pipefail
. "$(dirname "$0")/tools.bash"

command -v npm >/dev/null || exit 77
unpack postgresql-15=15.20-0+deb12u1 postgresql-client-15=15.20-0+deb12u1 libpq5=15.20-0+deb12u1
npm install --silent --no-audit --no-fund --prefix "$tmp" postgres@3.4.9 pg@8.23.1 >&2 || exit 77
start_server

cat >"$tmp/bounds.mjs" <<'JAVASCRIPT'
import { inspect } from "node:util";
import pg from "pg";
import postgres from "postgres";

const [directory] = process.argv.slice(2);

function expect(what, expected, found) {
    const text = inspect(found, { breakLength: Infinity });
    if (text !== expected) {
        console.error(`CHANGED: ${what}\n  it was: ${expected}\n  it is:  ${text}`);
        process.exit(1);
    }
    console.log(`${what}: ${text}`);
}

const client = new pg.Client({ host: directory, user: "owner", database: "postgres" });
await client.connect();
const sql = postgres({ path: `${directory}/.s.PGSQL.5432`, username: "owner", database: "postgres" });

async function both(expression, ofPostgres, ofPg) {
    const query = `SELECT ${expression} AS a`;
    expect(`postgres, ${expression}`, ofPostgres, (await sql.unsafe(query))[0].a);
    expect(`pg, ${expression}`, ofPg, (await client.query(query)).rows[0].a);
}

await both("'[0:1]={1.5,NULL}'::float8[]", "[ [ 1.5, NaN ] ]", "[ 1.5, null ]");
await both("'{1.5,NULL}'::float8[]", "[ 1.5, NaN ]", "[ 1.5, null ]");
await both("'{a,NULL,\"NULL\"}'::text[]", "[ 'a', 'NULL', 'NULL' ]", "[ 'a', null, 'NULL' ]");
const key = "indkey::int2[] FROM pg_index WHERE indexrelid = 'pg_attribute_relid_attnum_index'::regclass";
expect("postgres, indkey", "[ [ 1, 6 ] ]", (await sql.unsafe(`SELECT ${key}`))[0].indkey);
await both("to_json('[0:1]={1.5,NULL}'::float8[])", "[ 1.5, null ]", "[ 1.5, null ]");
await both("('[0:1]={1.5,2}'::float8[])[:]", "[ 1.5, 2 ]", "[ 1.5, 2 ]");
await client.end();
await sql.end();
JAVASCRIPT
node "$tmp/bounds.mjs" "$tmp"
