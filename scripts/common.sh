# Sourced by the other scripts: the folders, a common way to install the extension, and functions for output.
# Scripts can be run from any folder.

ABACUS_ROOT=$(cd "$(dirname "${BASH_SOURCE[0]}")/.." && pwd)
ABACUS_BUILD=$ABACUS_ROOT/build
ABACUS_JOBS=${ABACUS_JOBS:-$(nproc)}

# The major version of PostgreSQL in the Debian here; 15 in any other system.
debian_postgresql() {
    local VERSION_CODENAME=
    . /etc/os-release
    case $VERSION_CODENAME in
    trixie) echo 17 ;;
    forky | sid) echo 18 ;;
    *) echo 15 ;;
    esac
}
ABACUS_POSTGRESQL=${ABACUS_POSTGRESQL:-$(debian_postgresql)} # the major version that is built for and tested
PG_CONFIG=${PG_CONFIG:-/usr/lib/postgresql/$ABACUS_POSTGRESQL/bin/pg_config}

cd "$ABACUS_ROOT"
mkdir -p "$ABACUS_BUILD"

# ccache, if it is installed: shared by all checkouts, whose folder is not part of an object file, except for
# the debugger.
compilers=()
if command -v ccache >/dev/null; then
    compilers=("CC=ccache ${CC:-gcc}" "CXX=ccache ${CXX:-g++}")
    export CMAKE_C_COMPILER_LAUNCHER=ccache CMAKE_CXX_COMPILER_LAUNCHER=ccache
    export CCACHE_BASEDIR=$ABACUS_ROOT CCACHE_NOHASHDIR=1 CCACHE_SLOPPINESS=pch_defines,time_macros,include_file_mtime,include_file_ctime
fi

as_root() {
    if ((EUID == 0)); then "$@"; else sudo "$@"; fi
}

heading() {
    printf '\n== %s\n' "$*"
}

fail() {
    printf '%s\n' "$*" >&2
    exit 1
}

# Builds and installs the extensions as a packager does, but in a folder of its own, so that the source tree
# stays clean.
extension_make=(make -s -C "$ABACUS_BUILD/extension" -f "$ABACUS_ROOT/Makefile.pgxs"
    PG_CONFIG="$PG_CONFIG" "${compilers[@]}")

build_extension() {
    mkdir -p "$ABACUS_BUILD/extension"
    "${extension_make[@]}" -j"$ABACUS_JOBS" all
}

install_extension() {
    build_extension && as_root "${extension_make[@]}" install >/dev/null
}

# Builds the given CMake targets (all by default) in build/release; warnings are errors if ABACUS_WERROR says
# so. In another Debian (chroot.sh) there are no benchmarks to build.
build_release() {
    local targets=("${@:-all}")
    cmake -S . -B build/release ${ABACUS_WERROR:+-DABACUS_WERROR=ON} \
        ${ABACUS_CHROOT:+-DABACUS_BENCH=OFF} >/dev/null
    cmake --build build/release -j "$ABACUS_JOBS" --target "${targets[@]}"
}
