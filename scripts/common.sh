# Sourced by the other scripts: where things are, one way to install the
# extension, and a few words of output. They are run from any folder.

ABACUS_ROOT=$(cd "$(dirname "${BASH_SOURCE[0]}")/.." && pwd)
ABACUS_BUILD=$ABACUS_ROOT/build
ABACUS_JOBS=${ABACUS_JOBS:-$(nproc)}
PG_CONFIG=${PG_CONFIG:-/usr/lib/postgresql/15/bin/pg_config}

cd "$ABACUS_ROOT"
mkdir -p "$ABACUS_BUILD"

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

# Builds and installs the extension as a packager does, but in a folder of its
# own, so that the source tree stays clean.
install_extension() {
    local make=(make -s -C "$ABACUS_BUILD/extension" -f "$ABACUS_ROOT/Makefile.pgxs"
        PG_CONFIG="$PG_CONFIG")
    mkdir -p "$ABACUS_BUILD/extension"
    "${make[@]}" -j"$ABACUS_JOBS" all && as_root "${make[@]}" install >/dev/null
}

# Builds the given CMake targets (all by default) in build/release.
build_release() {
    local targets=("${@:-all}")
    cmake -S . -B build/release >/dev/null
    cmake --build build/release -j "$ABACUS_JOBS" --target "${targets[@]}"
}
