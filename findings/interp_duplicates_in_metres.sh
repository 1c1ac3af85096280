#!/bin/bash
# interp of R takes points 30 cm apart for duplicates, in coordinates of a map.
#
# Version     interp 1.1.3, R 4.2.2 (Debian 12: r-cran-interp 1.1-3-1, r-base-core 4.2.2.20221110-2)
# Behaviour   Points of UTM, with a northing of 5,700,000 m, are refused as "duplicate points found" if they are
#             30 cm apart. No two are equal, so that duplicate = "mean" or "strip" do not help. The same points less an offset are accepted.
# Output      50 cm apart: a result; 30 cm apart: an error; 30 cm apart without 500,000 and 5,700,000: a result
# Expected    results: doubles tell places a nanometre apart there
# Way out     Subtract whole kilometres first.
set -euo pipefail
. "$(dirname "$0")/tools.bash"

unpack_r r-cran-interp=1.1-3-1

cat >"$tmp/metres.R" <<'R'
library(interp)
cat(as.character(packageVersion("interp")), "\n")
at <- expand.grid(x = 0:9, y = 0:9)
for (options in list(c(500000, 5700000, 0.5), c(500000, 5700000, 0.3), c(0, 0, 0.3))) {
    x <- options[1] + options[3] * at$x
    y <- options[2] + options[3] * at$y
    stopifnot(!any(duplicated(cbind(x, y))))
    for (rule in c("error", "mean"))
        cat(options, rule, tryCatch(is.list(interp(x, y, at$x, duplicate = rule)), error = conditionMessage), "\n")
}
R
expect "steps" "1.1.3
5e+05 5700000 0.5 error TRUE
5e+05 5700000 0.5 mean TRUE
5e+05 5700000 0.3 error shull: duplicate points found
5e+05 5700000 0.3 mean shull: duplicate points found
0 0 0.3 error TRUE
0 0 0.3 mean TRUE" "$(run_r "$tmp/metres.R")"
