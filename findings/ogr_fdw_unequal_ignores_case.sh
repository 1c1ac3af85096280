#!/bin/bash
# With ogr_fdw, `name <> 'ridge'` leaves out the rows with "Ridge", of a shapefile.
#
# Version     ogr_fdw 1.1.3 (Debian 12: postgresql-15-ogr-fdw 1.1.3-1+b2), GDAL 3.6.2, PostgreSQL 15
# Behaviour   The condition goes to OGR, whose = and <> ignore case for formats without an SQL of their own.
#             PostgreSQL checks the rows that come back, which is enough for =, but rows that differ by case alone do
#             not come back for <>. NOT IN with one name is the same.
# Output      two of the three names other than "ridge"
# Expected    Gully, Ridge, Scarp
# Way out     name || '' <> 'ridge', which stays in PostgreSQL.
set -euo pipefail
. "$(dirname "$0")/tools.bash"

unpack postgresql-15=15.20-0+deb12u1 postgresql-client-15=15.20-0+deb12u1 libpq5=15.20-0+deb12u1 \
    postgresql-15-ogr-fdw=1.1.3-1+b2 gdal-bin=3.6.2+dfsg-1+b2
printf 'name,WKT\nRidge,POINT (1 1)\nridge,POINT (2 2)\nGully,POINT (3 3)\nScarp,POINT (4 4)\n' >"$tmp/names.csv"
LD_LIBRARY_PATH=$libraries "$tmp/usr/bin/ogr2ogr" -f "ESRI Shapefile" "$tmp/names.shp" "$tmp/names.csv"
start_server
psql -Xqd postgres -c "CREATE EXTENSION ogr_fdw" \
    -c "CREATE SERVER file FOREIGN DATA WRAPPER ogr_fdw OPTIONS (datasource '$tmp/names.shp', format 'ESRI Shapefile')" \
    -c "CREATE FOREIGN TABLE names (name varchar) SERVER file OPTIONS (layer 'names')"

names() {
    psql -XqAtd postgres -c "SELECT string_agg(name, ' ' ORDER BY name COLLATE \"C\") FROM names WHERE $1"
}

expect "version" 1.1 "$(psql -XqAtd postgres -c "SELECT extversion FROM pg_extension WHERE extname = 'ogr_fdw'")"
expect "all" "Gully Ridge Scarp ridge" "$(names true)"
expect "= 'ridge'" ridge "$(names "name = 'ridge'")"
expect "<> 'ridge'" "Gully Scarp" "$(names "name <> 'ridge'")"
expect "NOT IN ('ridge')" "Gully Scarp" "$(names "name NOT IN ('ridge')")"
expect "|| '' <> 'ridge'" "Gully Ridge Scarp" "$(names "name || '' <> 'ridge'")"
