#!/bin/bash
# GRASS gives sloping lines the height 0 where it breaks them.
#
# Version     GRASS GIS 8.2.1 (Debian 12: grass-core 8.2.1-1)
# Behaviour   v.clean tool=break adds a vertex where lines cross. On a line whose two ends have the same height, the vertex has
#             that height; on a sloping one it has the height 0, in the middle of any mountain, even if the other line ends there
#             with a height.
# Output      a line from (0, 0, 7) to (10, 10, 9), broken at (5, 5): height 0 there; one at the height 7: 7
# Expected    8, which lies on the line. Nothing is said, and the map stays three-dimensional.
# Way out     Break lines where the heights can be computed, in PostGIS by ST_Node (which takes the mean of both lines), or
#             drape the broken lines over the terrain again.
set -euo pipefail
. "$(dirname "$0")/tools.bash"

unpack_grass
cd "$tmp"

# A line from corner to corner, and one that crosses it or ends on it: break LINE LINE, each as x y z x y z.
cat >break.sh <<'END'
line() {
    printf 'L 2 1\n %s %s %s\n %s %s %s\n 1 1\n' "$@"
}
{ line $1; line $2; } >lines.txt
v.in.ascii -zn input=lines.txt output=lines format=standard --quiet
v.clean input=lines output=broken tool=break --quiet
v.out.ascii input=broken format=standard precision=3 >broken.txt
END

# The heights at (5, 5).
heights() {
    PATH=$tmp/usr/bin:$PATH grass --tmp-location XY --exec bash break.sh "$1" "$2" >log 2>&1
    awk '$1 == 5 && $2 == 5 { print $3 }' broken.txt | sort | uniq -c | awk '{ print $1 " x " $2 }' | paste -sd,
}

expect "version" 8.2.1 "$(PATH=$tmp/usr/bin:$PATH grass --version 2>&1 | awk 'NR == 1 { print $3 }')"
expect "two level lines" "2 x 7,2 x 9" "$(heights "0 0 7 10 10 7" "0 10 9 10 0 9")"
expect "a sloping line and a level one" "2 x 0,2 x 9" "$(heights "0 0 7 10 10 9" "0 10 9 10 0 9")"
expect "two sloping lines, both of the height 8 there" "4 x 0" "$(heights "0 0 7 10 10 9" "0 10 9 10 0 7")"
expect "a sloping line, and one that ends on it at 8" "2 x 0,1 x 8" "$(heights "0 0 7 10 10 9" "0 10 9 5 5 8")"
