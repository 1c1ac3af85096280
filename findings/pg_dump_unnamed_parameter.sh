#!/bin/bash
# pg_dump writes an SQL function that cannot be restored, if an unnamed parameter is used in its body.
#
# Version     PostgreSQL 15 (Debian 12: 15.20-0+deb12u1); 18.6 writes the same
# Behaviour   A function has a body of the SQL standard (RETURN or BEGIN ATOMIC), a parameter without
#             a name, and another with one: also OUT parameters and columns of RETURNS TABLE are such.
#             In the dump the parameter of the body is an empty name in quotes. pg_get_functiondef says
#             the same. If no parameter has a name, it is $1, and the dump is right.
# Output      SELECT "";
#             ERROR:  zero-length delimited identifier at or near """"
# Expected    $1, as it was written. The function is valid and works.
# Way out     Name the parameters that the body uses.
set -euo pipefail
. "$(dirname "$0")/tools.bash"

unpack postgresql-15=15.20-0+deb12u1 postgresql-client-15=15.20-0+deb12u1 libpq5=15.20-0+deb12u1
start_server

# Says what the body of a function f(int) becomes in a dump, and what its restoration says.
dumped() {
    createdb source
    createdb target
    psql -Xqd source -c "$1"
    expect "f(41) of: $1" 42 "$(psql -XqAtd source -c 'SELECT f(41)')"
    pg_dump -f "$tmp/dump.sql" source
    body=$(grep -E '^ +(RETURN|SELECT) ' "$tmp/dump.sql" | sed 's:^ *::')
    psql -Xqd target -v ON_ERROR_STOP=1 -f "$tmp/dump.sql" >"$tmp/psql.log" 2>&1 || true
    error=$(sed -n 's/.*ERROR:  //p' "$tmp/psql.log")
    dropdb source
    dropdb target
}

dumped 'CREATE FUNCTION f(int) RETURNS int LANGUAGE sql RETURN $1 + 1'
expect "without names, in the dump" 'RETURN ($1 + 1);' "$body"
expect "restored" "" "$error"

dumped 'CREATE FUNCTION f(int) RETURNS TABLE (x int) LANGUAGE sql BEGIN ATOMIC SELECT $1 + 1; END'
expect "RETURNS TABLE, in the dump" 'SELECT ("" + 1);' "$body"
expect "restored" 'zero-length delimited identifier at or near """"' "$error"

dumped 'CREATE FUNCTION f(int, OUT x int) LANGUAGE sql RETURN $1 + 1'
expect "OUT, in the dump" 'RETURN ("" + 1);' "$body"
expect "restored" 'zero-length delimited identifier at or near """"' "$error"

dumped 'CREATE FUNCTION f(int, step int DEFAULT 1) RETURNS int LANGUAGE sql RETURN $1 + step'
expect "another with a name, in the dump" 'RETURN ("" + step);' "$body"
expect "restored" 'zero-length delimited identifier at or near """"' "$error"
