#!/bin/bash
# interp of R is NA along the right and the upper side of its points.
#
# Version     interp 1.1.3, R 4.2.2 (Debian 12: r-cran-interp 1.1-3-1, r-base-core 4.2.2.20221110-2)
# Behaviour   interp(..., output = "grid") over the rectangle that the points fill, which is the default of xo and yo, leaves the column
#             with the greatest x and the row with the greatest y NA, though points lie there. At the other two sides there are values, and output =
#             "points" has them on all four.
# Output      19 of 100 nodes are NA, where each is one of the points
# Expected    no NA, as from output = "points"
# Way out     Ask for nodes with output = "points", xo and yo from expand.grid().
set -euo pipefail
. "$(dirname "$0")/tools.bash"

unpack_r r-cran-interp=1.1-3-1

cat >"$tmp/sides.R" <<'R'
library(interp)
cat(as.character(packageVersion("interp")), "\n")
at <- expand.grid(x = 0:9, y = 0:9)
height <- at$x + 2 * at$y
grid <- interp(at$x, at$y, height, xo = 0:9, yo = 0:9)
cat("grid:", sum(is.na(grid$z)), "NA, at x = 9:", sum(is.na(grid$z[10, ])), "at y = 9:", sum(is.na(grid$z[, 10])),
    "at x = 0:", sum(is.na(grid$z[1, -10])), "at y = 0:", sum(is.na(grid$z[-10, 1])), "\n")
points <- interp(at$x, at$y, height, xo = at$x, yo = at$y, output = "points")
cat("points:", sum(is.na(points$z)), "NA, greatest error", max(abs(points$z - height)), "\n")
default <- interp(at$x, at$y, height)
cat("default:", sum(is.na(default$z)), "NA of", length(default$z), "\n")
R
expect "nodes" "1.1.3
grid: 19 NA, at x = 9: 10 at y = 9: 10 at x = 0: 0 at y = 0: 0
points: 0 NA, greatest error 0
default: 79 NA of 1600" "$(run_r "$tmp/sides.R")"
