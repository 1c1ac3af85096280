#!/bin/bash
# PC_AsText of pgpointcloud writes coordinates with six digits, and PC_Get with fifteen.
#
# Version     pgpointcloud 1.2.4 (Debian 12: postgresql-15-pointcloud 1.2.4-2+b1), PostgreSQL 15
# Behaviour   PC_AsText gives every value six significant digits: of coordinates in metres, as in UTM, those after
#             the point are gone, and of seven before it the last. The stored point is whole, and so is what the
#             cast to PostGIS's geometry makes of it. PC_Get, which returns numeric, has fifteen digits of a double.
# Output      {"pcid":1,"pt":[500000,5e+06,101.346]} of 500000.25, 5000000.75, 101.3456789
# Expected    as many digits as give the stored number back, as for PostgreSQL's own double precision
# Way out     The cast to geometry; for other dimensions PC_Get, if fifteen digits are enough.
set -euo pipefail
. "$(dirname "$0")/tools.bash"

unpack postgresql-15=15.20-0+deb12u1 postgresql-client-15=15.20-0+deb12u1 libpq5=15.20-0+deb12u1 \
    postgresql-15-pointcloud=1.2.4-2+b1
start_server
double() {
    echo "<pc:dimension><pc:position>$1</pc:position><pc:size>8</pc:size><pc:name>$2</pc:name><pc:interpretation>double</pc:interpretation></pc:dimension>"
}
psql -Xqd postgres -c "CREATE EXTENSION pointcloud" -c "INSERT INTO pointcloud_formats (pcid, srid, schema) VALUES (1, 0,
    '<?xml version=\"1.0\"?><pc:PointCloudSchema xmlns:pc=\"http://pointcloud.org/schemas/PC/1.1\">$(double 1 X)$(double 2 Y)$(double 3 Z)</pc:PointCloudSchema>')"

expect "version" 1.2.4 "$(value "extversion FROM pg_extension WHERE extname = 'pointcloud'")"
point="PC_MakePoint(1, ARRAY[500000.25, 5000000.75, 101.3456789])"
expect "a point as text" '{"pcid":1,"pt":[500000,5e+06,101.346]}' "$(value "PC_AsText($point)")"
expect "a patch as text" '{"pcid":1,"pts":[[500000,5e+06,101.346]]}' "$(value "PC_AsText(PC_Patch($point))")"
expect "its y by PC_Get" 5000000.75 "$(value "PC_Get($point, 'y')")"
expect "0.1 + 0.2 by PC_Get" 0.3 "$(value "PC_Get(PC_MakePoint(1, ARRAY[0, 0, 0.1::float8 + 0.2]), 'z')")"
expect "0.1 + 0.2 in PostgreSQL" 0.30000000000000004 "$(value "0.1::float8 + 0.2")"
