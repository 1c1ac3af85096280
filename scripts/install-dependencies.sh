#!/bin/bash
# Installs the Debian packages that Abacus is built, shown and tested with; if all are present, it does
# nothing, in a fraction of a second. ABACUS_POSTGRESQL is the server's version; by default that of the Debian
# here.
#
#   install-dependencies.sh build     what the extension needs
#   install-dependencies.sh server    ... and tests in a server
#   install-dependencies.sh versions  ... and tests of the core: all that another version is tested with
#   install-dependencies.sh demo      ... and the data of the demo
#   install-dependencies.sh view      ... and the viewer
#   install-dependencies.sh test      ... and all tests, which run the benchmarks once (default)
#   install-dependencies.sh bench     ... and perf
set -euo pipefail
. "$(dirname "$0")/common.sh"

version=$ABACUS_POSTGRESQL
packages=(
    make g++ pkg-config libxxhash-dev libprotozero-dev
    "postgresql-$version" "postgresql-server-dev-$version"
    libpq-dev libcgal-dev libgmp-dev libmpfr-dev libcairo2-dev libgeos-dev
)
demo=(
    gmt-gshhg-full gmt-gshhg-high   # shorelines, borders and rivers of the world
    python3-netcdf4 python3-numpy   # to read them
    python-matplotlib-data          # the Jacksboro fault elevation model
)
optional=(                          # tests that need what Debian lacks are left out
    "postgresql-$version-postgis-3" # for abacus_postgis, and to compare with
    "postgresql-$version-pgtap"
)
server=(
    "${optional[@]}" libtap-parser-sourcehandler-pgtap-perl libipc-run-perl mount
)
core=(
    ccache cmake libgtest-dev libgmock-dev libpng-dev
)
test=(
    "${server[@]}" "${core[@]}"
    libbenchmark-dev
    libtet1.5-dev libqhull-dev      # TetGen and Qhull, for comparison
    libtbb-dev                      # threads of CGAL's parallel triangulation, for comparison
    clang libclang-rt-14-dev        # clang brings libFuzzer
    clang-format clang-tidy
    gnuplot-nox                     # plots of docs/benchmarks.md
    python3-numpy python3-scipy python3-matplotlib python3-vtk9   # for comparing answers
    gdal-bin                        # reads tiles; gdal_grid, for comparison
    libp4est-dev libopenmpi-dev     # p4est, for comparing octrees
    metis                           # cuts a graph, for comparing parts
    openmpi-bin python3-mpi4py python3-petsc4py   # ranks of the parallel example
    python3-meshio python3-gmsh python3-h5py   # read and write the files of meshes
    python3-gdal                    # GeoTIFF
    chromium                        # shows the viewer's page in headless mode
    mmdebstrap                      # a Debian with another version of PostgreSQL
)
bench=(
    linux-perf                      # finds the functions that take most time
)

viewer=()
command -v npm >/dev/null || viewer=(nodejs npm) # Node.js may be installed from elsewhere

case ${1:-test} in
build) ;;
server) packages+=("${server[@]}") ;;
versions) packages+=("${server[@]}" "${core[@]}") ;;
demo) packages+=("${demo[@]}") ;;
view) packages+=("${demo[@]}" "${viewer[@]}") ;;
test) packages+=("${demo[@]}" "${viewer[@]}" "${test[@]}") ;;
bench) packages+=("${demo[@]}" "${viewer[@]}" "${test[@]}" "${bench[@]}") ;;
*) echo "usage: $0 [build|server|versions|demo|view|test|bench]" >&2; exit 2 ;;
esac

missing=()
for package in "${packages[@]}"; do
    status=$(dpkg-query -W -f '${db:Status-Status}' "$package" 2>/dev/null || true)
    [[ $status == installed ]] || missing+=("$package")
done
((${#missing[@]})) || exit 0

as_root=()
if ((EUID != 0)); then
    command -v sudo >/dev/null || { echo "neither root nor sudo: cannot install packages" >&2; exit 1; }
    as_root=(sudo)
fi
# Only what is optional may be missing for ever: apt's lists of an earlier run say so.
if [[ " ${optional[*]} " != *" ${missing[*]} "* || -z $(apt-cache show "postgresql-$version" 2>/dev/null) ]]; then
    "${as_root[@]}" env DEBIAN_FRONTEND=noninteractive apt-get update -q
fi
wanted=()
for package in "${missing[@]}"; do
    if [[ " ${optional[*]} " == *" $package "* && -z $(apt-cache show "$package" 2>/dev/null) ]]; then
        echo "Debian has no $package here: tests that need it are left out"
    else
        wanted+=("$package")
    fi
done
((${#wanted[@]})) || exit 0
echo "Installing ${wanted[*]}"
"${as_root[@]}" env DEBIAN_FRONTEND=noninteractive \
    apt-get install -q -y --no-install-recommends "${wanted[@]}"
