#!/bin/bash
# Contours of a triangulation by GMT fall into pieces where they pass through vertices.
#
# Version     GMT 6.4.0 (Debian 12: gmt 6.4.0+dfsg-2)
# Behaviour   `gmt contour` (`pscontour` in classic mode) moves a height that is exactly a level a little, and draws the
#             contour between the triangles so made. Of a pyramid with whole heights, contours of whole numbers come with
#             scraps some millionths long, which -D writes as contours of their own; some rings stay open.
# Output      closed and open contours of the levels 1 to 4, each of which is a square: 1 and 12, 1 and 10, 0 and 6, 0 and 5.
#             The same pyramid half a unit higher: 1 and 0 for each.
# Expected    1 and 0: one square for each level. Heights in whole metres are common.
# Way out     Levels that no vertex has: add 0.001 to the heights (0.0005 is too little).
set -euo pipefail
. "$(dirname "$0")/tools.bash"

unpack gmt=6.4.0+dfsg-2 gmt-common=6.4.0+dfsg-2 libgmt6=6.4.0+dfsg-2
export LD_LIBRARY_PATH=$libraries GMT_SHAREDIR=$tmp/usr/share/gmt HOME=$tmp
gmt=$tmp/usr/bin/gmt
cd "$tmp"

# contours NAME OFFSET: of a pyramid with 11 x 11 vertices: NAME_C.txt has the closed ones, NAME_O.txt the others.
contours() {
    for x in {0..10}; do
        for y in {0..10}; do
            printf '%s %s %s\n' "$x" "$y" "$(printf '%s\n' "$x" "$y" $((10 - x)) $((10 - y)) | sort -n | head -n 1)$2"
        done
    done >"$1.txt"
    "$gmt" pscontour "$1.txt" -C1 -D"$1_%c.txt" -JX5 -R0/10/0/10 >/dev/null 2>errors
    touch "$1_C.txt" "$1_O.txt"
}

# count NAME LEVEL: closed and open ones of this level.
count() {
    echo "$(grep -c -- "-Z$2\$" "$1_C.txt") and $(grep -c -- "-Z$2\$" "$1_O.txt")"
}

expect "version" 6.4.0 "$("$gmt" --version)"
contours whole ""
contours half .5
contours moved .001
for case in "1 1 and 12" "2 1 and 10" "3 0 and 6" "4 0 and 5"; do
    level=${case%% *}
    expect "level $level, heights whole" "${case#* }" "$(count whole "$level" || true)"
    expect "level $level, half a unit higher" "1 and 0" "$(count half "$level" || true)"
    expect "level $level, 0.001 higher" "1 and 0" "$(count moved "$level" || true)"
done
