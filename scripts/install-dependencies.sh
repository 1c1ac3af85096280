#!/bin/bash
# Installs the Debian 12 packages that Abacus is built, shown and tested with;
# does nothing (in a fraction of a second) when all are present.
#
#   install-dependencies.sh build     what the extension needs
#   install-dependencies.sh demo      ... and the data of the demo
#   install-dependencies.sh test      ... and all tests, which run the benchmarks once (default)
#   install-dependencies.sh bench     ... and PostGIS, to compare with, and perf
set -euo pipefail

packages=(
    make g++ pkg-config libxxhash-dev
    postgresql-15 postgresql-server-dev-15
    libcgal-dev libgmp-dev libmpfr-dev libcairo2-dev
)
demo=(
    gmt-gshhg-full gmt-gshhg-high   # shorelines, borders and rivers of the world
    python3-netcdf4 python3-numpy   # to read them
    python-matplotlib-data          # the Jacksboro fault elevation model
)
test=(
    cmake clang libclang-rt-14-dev  # clang brings libFuzzer
    clang-format clang-tidy
    libgtest-dev libgmock-dev libbenchmark-dev libpng-dev
    libtet1.5-dev libqhull-dev      # TetGen and Qhull, to compare with
    gnuplot-nox                     # plots of docs/benchmarks.md
    python3-numpy python3-scipy python3-matplotlib python3-vtk9   # whose answers ours are compared with
    postgresql-15-pgtap libtap-parser-sourcehandler-pgtap-perl libipc-run-perl
)
bench=(
    postgresql-15-postgis-3
    gdal-bin                        # gdal_grid, to compare with
    linux-perf                      # tells the functions that take most time
)

case ${1:-test} in
build) ;;
demo) packages+=("${demo[@]}") ;;
test) packages+=("${demo[@]}" "${test[@]}") ;;
bench) packages+=("${demo[@]}" "${test[@]}" "${bench[@]}") ;;
*) echo "usage: $0 [build|demo|test|bench]" >&2; exit 2 ;;
esac

missing=()
for package in "${packages[@]}"; do
    status=$(dpkg-query -W -f '${db:Status-Status}' "$package" 2>/dev/null || true)
    [[ $status == installed ]] || missing+=("$package")
done
((${#missing[@]})) || exit 0

echo "Installing ${missing[*]}"
as_root=()
if ((EUID != 0)); then
    command -v sudo >/dev/null || { echo "neither root nor sudo: cannot install packages" >&2; exit 1; }
    as_root=(sudo)
fi
"${as_root[@]}" env DEBIAN_FRONTEND=noninteractive apt-get update -q
"${as_root[@]}" env DEBIAN_FRONTEND=noninteractive \
    apt-get install -q -y --no-install-recommends "${missing[@]}"
