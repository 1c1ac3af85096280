#!/bin/bash
# GRASS interpolates and rasterizes a missing value as 0.
#
# Version     GRASS GIS 8.2.1 (Debian 12: grass-core 8.2.1-1)
# Behaviour   Points of a map have a column of heights, and one of them has no height: NULL in the table. v.surf.idw counts
#             it as the height 0, and v.to.rast writes a cell with 0. Neither says so, nor has an option to leave
#             such points out.
# Output      0.00 at the point without a height, and 10.25 half-way to a point of 20.5, which is 15.50 and 19.50 without it; 3 cells
# Expected    heights from the points that have one; 2 cells
# Way out     v.extract with where="height IS NOT NULL" first.
set -euo pipefail
. "$(dirname "$0")/tools.bash"

unpack_grass
cd "$tmp"

# What is made of the points, and of those with a height: the surface at the third point and half-way to the second, and cells.
cat >heights.sh <<'END'
g.region n=11 s=0 e=11 w=0 res=1 --quiet
printf '1.5|1.5|10.5\n9.5|9.5|20.5\n5.5|5.5|\n' |
    v.in.ascii input=- output=sites separator=pipe columns="x double precision, y double precision, height double precision" --quiet
v.extract input=sites where="height IS NOT NULL" output=known --quiet
for name in sites known; do
    v.surf.idw input=$name column=height npoints=2 output=surface --overwrite --quiet
    v.to.rast input=$name use=attr attribute_column=height output=cells --overwrite --quiet
    at() { r.what map=surface coordinates="$1" | cut -d '|' -f 4 | xargs printf %.2f; }
    echo "$name: $(at 5.5,5.5) $(at 7.5,7.5), $(r.stats -n1 cells --quiet | wc -l) cells"
done
END
PATH=$tmp/usr/bin:$PATH grass --tmp-location XY --exec bash heights.sh >said 2>log
expect "version" 8.2.1 "$(PATH=$tmp/usr/bin:$PATH grass --version 2>&1 | awk 'NR == 1 { print $3 }')"
expect "values" "sites: 0.00 10.25, 3 cells
known: 15.50 19.50, 2 cells" "$(grep cells said)"
expect "warnings about a height" "" "$(grep -iE "null|missing|empty" log || true)"
