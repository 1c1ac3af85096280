#!/bin/bash
# With ogr_fdw, LIKE on a column of a GeoPackage is an error.
#
# Version     ogr_fdw 1.1.3 (Debian 12: postgresql-15-ogr-fdw 1.1.3-1+b2), GDAL 3.6.2, PostgreSQL 15
# Behaviour   The condition goes to the driver as ILIKE, which SQLite does not know. The same query works for a
#             shapefile. There is no option to keep conditions from the driver.
# Output      ERROR: GDAL AppDefined [1] failed to prepare SQL: … WHERE (name ILIKE 'r%')
# Expected    the rows, as without the condition
# Way out     name || '' LIKE 'r%', or starts_with(name, 'r'): PostgreSQL keeps these for itself.
set -euo pipefail
. "$(dirname "$0")/tools.bash"

unpack postgresql-15=15.20-0+deb12u1 postgresql-client-15=15.20-0+deb12u1 libpq5=15.20-0+deb12u1 \
    postgresql-15-ogr-fdw=1.1.3-1+b2 gdal-bin=3.6.2+dfsg-1+b2
printf 'name,WKT\nRidge,POINT (1 1)\nridge,POINT (2 2)\nGully,POINT (3 3)\n' >"$tmp/names.csv"
for format in GPKG "ESRI Shapefile"; do
    LD_LIBRARY_PATH=$libraries "$tmp/usr/bin/ogr2ogr" -f "$format" "$tmp/names.$([[ $format == GPKG ]] && echo gpkg || echo shp)" "$tmp/names.csv"
done
start_server
psql -Xqd postgres -c "CREATE EXTENSION ogr_fdw"
for kind in gpkg shp; do
    psql -Xqd postgres -c "CREATE SERVER $kind FOREIGN DATA WRAPPER ogr_fdw OPTIONS (datasource '$tmp/names.$kind')" \
        -c "CREATE FOREIGN TABLE $kind (name varchar) SERVER $kind OPTIONS (layer 'names')"
done

names() {
    psql -XqAtd postgres -c "SELECT string_agg(name, ' ') FROM $1 WHERE $2" 2>&1 | grep -oE 'failed to prepare SQL|^[A-Za-z ]+$'
}

expect "version" 1.1 "$(psql -XqAtd postgres -c "SELECT extversion FROM pg_extension WHERE extname = 'ogr_fdw'")"
expect "= in a GeoPackage" ridge "$(names gpkg "name = 'ridge'")"
expect "LIKE in a GeoPackage" "failed to prepare SQL" "$(names gpkg "name LIKE 'r%'")"
expect "LIKE in a shapefile" ridge "$(names shp "name LIKE 'r%'")"
expect "|| '' LIKE in a GeoPackage" ridge "$(names gpkg "name || '' LIKE 'r%'")"
expect "starts_with in a GeoPackage" ridge "$(names gpkg "starts_with(name, 'r')")"
