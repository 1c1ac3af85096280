#!/bin/bash
# ogr2ogr writes numbers to PostgreSQL with 15 digits, so most doubles change.
#
# Version     GDAL 3.6.2 (Debian 12: gdal-bin 3.6.2+dfsg-1+b2), PostgreSQL 15
# Behaviour   A double needs up to 17 digits. ogr2ogr copies a table of 1,000 doubles to another table of the
#             same database: 908 are another number there, with COPY and with INSERT, without a warning. 606 of
#             1,000 arrays differ too. ogr2ogr reads the numbers exactly, and writes them exactly to a GeoPackage.
# Output      0.3 instead of 0.30000000000000004
# Expected    The number as it was.
# Way out     Select the number as text, and give the type of the new column:
#             -sql "SELECT id, v::text AS v FROM heights" -lco COLUMN_TYPES=v=float8
set -euo pipefail
. "$(dirname "$0")/tools.bash"

unpack gdal-bin=3.6.2+dfsg-1+b2 libgdal32=3.6.2+dfsg-1+b2 gdal-data=3.6.2+dfsg-1 \
    postgresql-15=15.20-0+deb12u1 postgresql-client-15=15.20-0+deb12u1 libpq5=15.20-0+deb12u1
start_server
unset CPL_DEBUG
export GDAL_DATA=$tmp/usr/share/gdal
expect "version" "GDAL 3.6.2, released 2023/01/02" "$("$tmp/usr/bin/ogr2ogr" --version)"

psql -Xqd postgres -c "CREATE TABLE heights AS SELECT i AS id, sqrt(i::float8) AS v, ARRAY[sqrt(i::float8)] AS a FROM generate_series(1, 1000) i;
    UPDATE heights SET v = 0.1::float8 + 0.2::float8 WHERE id = 1; ALTER TABLE heights ADD PRIMARY KEY (id)"

# Copies by ogr2ogr with these arguments; then the first number, and how many differ.
copied() {
    "$tmp/usr/bin/ogr2ogr" -overwrite -f PostgreSQL "PG:dbname=postgres" "PG:dbname=postgres" -nln copy "$@" 2>"$tmp/warnings"
    psql -XqAtd postgres -F ', ' -c "SELECT min(c.v) FILTER (WHERE id = 1), count(*) FILTER (WHERE c.v <> h.v), count(*)
        FROM copy c JOIN heights h USING (id)"
}

expect "COPY" "0.3, 908, 1000" "$(copied heights --config PG_USE_COPY YES)"
expect "warnings" "" "$(cat "$tmp/warnings")"
expect "INSERT" "0.3, 908, 1000" "$(copied heights --config PG_USE_COPY NO)"
expect "arrays that differ" 606 "$(psql -XqAtd postgres -c "SELECT count(*) FROM copy c JOIN heights h USING (id) WHERE c.a <> h.a")"
expect "as text" "0.30000000000000004, 0, 1000" "$(copied -sql "SELECT id, v::text AS v FROM heights" -lco COLUMN_TYPES=v=float8)"
"$tmp/usr/bin/ogr2ogr" -f GPKG "$tmp/heights.gpkg" "PG:dbname=postgres" heights 2>"$tmp/warnings"
expect "GeoPackage, hash of the numbers" "$(psql -XqAtd postgres -c 'SELECT v FROM heights ORDER BY id' | md5sum)" \
    "$(/usr/bin/python3 -c "
import sqlite3, sys
for v, in sqlite3.connect(sys.argv[1]).execute('SELECT v FROM heights ORDER BY id'):
    print(repr(v).removesuffix('.0'))" "$tmp/heights.gpkg" | md5sum)"
