#!/bin/bash
# ogr_fdw reads times of whole seconds, and disregards their zone.
#
# Version     ogr_fdw 1.1.3 (Debian 12: postgresql-15-ogr-fdw 1.1.3-1+b2), GDAL 3.6.2, PostgreSQL 15
# Behaviour   The parts of a second that a GeoPackage has are left out, so a row is not found by its own time, and rows of
#             one second are in no order. A time with a zone keeps its digits and loses the zone: the same moment, written
#             in two zones, is two timestamps. OGR itself has both.
# Output      2026-01-01 10:00:00 of 10:00:00.125Z, and 12:00:00 of 12:00:00.125+02:00, the same moment
# Expected    10:00:00.125 for both, or timestamptz
# Way out     ogr2ogr, which writes timestamps with time zone and milliseconds.
set -euo pipefail
. "$(dirname "$0")/tools.bash"

unpack postgresql-15=15.20-0+deb12u1 postgresql-client-15=15.20-0+deb12u1 libpq5=15.20-0+deb12u1 \
    postgresql-15-ogr-fdw=1.1.3-1+b2 gdal-bin=3.6.2+dfsg-1+b2
printf 'id,t\n1,2026-01-01T10:00:00.125Z\n2,2026-01-01T12:00:00.125+02:00\n3,2026-01-01T10:00:00.875Z\n' >"$tmp/times.csv"
printf 'Integer,DateTime\n' >"$tmp/times.csvt"
LD_LIBRARY_PATH=$libraries "$tmp/usr/bin/ogr2ogr" -f GeoJSON "$tmp/times.geojson" "$tmp/times.csv" -oo AUTODETECT_TYPE=NO
LD_LIBRARY_PATH=$libraries "$tmp/usr/bin/ogr2ogr" -f GPKG "$tmp/times.gpkg" "$tmp/times.csv" -oo AUTODETECT_TYPE=NO 2>/dev/null
start_server
psql -Xqd postgres -c "CREATE EXTENSION ogr_fdw"
for kind in gpkg geojson; do
    psql -Xqd postgres -c "CREATE SERVER $kind FOREIGN DATA WRAPPER ogr_fdw OPTIONS (datasource '$tmp/times.$kind')" \
        -c "CREATE FOREIGN TABLE $kind (id integer, t timestamp) SERVER $kind OPTIONS (layer 'times')"
done

value() {
    psql -XqAtd postgres -c "SELECT $1" 2>/dev/null
}

expect "version" 1.1 "$(value "extversion FROM pg_extension WHERE extname = 'ogr_fdw'")"
for kind in gpkg geojson; do
    expect "$kind" "10:00:00 12:00:00 10:00:00" "$(value "string_agg(t::time::text, ' ' ORDER BY id) FROM $kind")"
    expect "$kind, after the second" "" "$(value "string_agg(id::text, ' ' ORDER BY id) FROM $kind WHERE t > '2026-01-01 10:00:00' AND t < '2026-01-01 10:00:01'")"
done
expect "OGR" "10:00:00.125+00 12:00:00.125+02 10:00:00.875+00" \
    "$(LD_LIBRARY_PATH=$libraries "$tmp/usr/bin/ogrinfo" -q -al "$tmp/times.geojson" 2>/dev/null | sed -n 's/^ *t (DateTime) = .* //p' | paste -s -d ' ')"
