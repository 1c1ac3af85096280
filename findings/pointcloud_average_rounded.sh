#!/bin/bash
# PC_PatchAvg of pgpointcloud rounds an average to a value that the dimension can store.
#
# Version     pgpointcloud 1.2.4 (Debian 12: postgresql-15-pointcloud 1.2.4-2+b1), PostgreSQL 15
# Behaviour   The average of a dimension of whole numbers, such as the intensity, the number of the return or a
#             flag, is a whole number; that of coordinates is rounded to the scale of the schema. The function returns
#             numeric, and its description says that it returns the average.
# Output      PC_PatchAvg 6, avg() of the same values 5.5; of flags of which a quarter is 1: 0 and 0.25
# Expected    5.5 and 0.25
# Way out     avg(PC_Get(point, 'name')) over PC_Explode(patch).
set -euo pipefail
. "$(dirname "$0")/tools.bash"

unpack postgresql-15=15.20-0+deb12u1 postgresql-client-15=15.20-0+deb12u1 libpq5=15.20-0+deb12u1 \
    postgresql-15-pointcloud=1.2.4-2+b1
start_server
dimension() {
    echo "<pc:dimension><pc:position>$1</pc:position><pc:size>$3</pc:size><pc:name>$2</pc:name><pc:interpretation>$4</pc:interpretation><pc:scale>$5</pc:scale></pc:dimension>"
}
schema="$(dimension 1 X 4 int32_t 0.01)$(dimension 2 Y 4 int32_t 0.01)$(dimension 3 Intensity 2 uint16_t 1)$(dimension 4 Flag 1 uint8_t 1)"
psql -Xqd postgres -c "CREATE EXTENSION pointcloud" -c "INSERT INTO pointcloud_formats (pcid, srid, schema) VALUES (1, 0,
    '<?xml version=\"1.0\"?><pc:PointCloudSchema xmlns:pc=\"http://pointcloud.org/schemas/PC/1.1\">$schema</pc:PointCloudSchema>')" \
    -c "CREATE TABLE patches AS SELECT PC_Patch(PC_MakePoint(1, ARRAY[i * 0.01, i, i, (i % 4 = 0)::integer])) AS patch FROM generate_series(1, 8) AS i" \
    -c "CREATE TABLE tens AS SELECT PC_Patch(PC_MakePoint(1, ARRAY[i * 0.01, i, i, 0])) AS patch FROM generate_series(1, 10) AS i"

exact() {
    value "avg(PC_Get(point, '$2'))::float8 FROM $1, PC_Explode(patch) AS point"
}

expect "version" 1.2.4 "$(value "extversion FROM pg_extension WHERE extname = 'pointcloud'")"
expect "average of 1 to 10, stored as uint16" 6 "$(value "PC_PatchAvg(patch, 'intensity') FROM tens")"
expect "... by avg()" 5.5 "$(exact tens intensity)"
expect "average of flags" 0 "$(value "PC_PatchAvg(patch, 'flag') FROM patches")"
expect "... by avg()" 0.25 "$(exact patches flag)"
expect "average of x, scale 0.01" 0.05 "$(value "PC_PatchAvg(patch, 'x') FROM patches")"
expect "... by avg()" 0.045 "$(exact patches x)"
