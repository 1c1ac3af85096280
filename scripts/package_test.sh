#!/bin/bash
# Builds Debian's packages from a copy of the source, one for each installed version of PostgreSQL; checks
# them with lintian, installs them, runs regression tests of the installed extension, and removes them again.
# It changes the system in which it runs, so it is meant for a chroot.
#
#   chroot.sh 17 scripts/package_test.sh
set -euo pipefail
. "$(dirname "$0")/common.sh"
. scripts/packages.sh

folder=$ABACUS_BUILD/package
source=$folder/abacus
export CCACHE_DIR=${CCACHE_DIR:-$ABACUS_BUILD/ccache}

heading "Copy"
rm -rf "$folder"
mkdir -p "$source"
tar -C "$ABACUS_ROOT" --exclude=./build --exclude=./.git --exclude='*.o' -cf - . | tar -C "$source" -xf -
cd "$source"

heading "Packages for the build"
packages_tools
packages_prepare -b

heading "Build"
packages_build -b

heading "lintian"
lintian --allow-root --fail-on error --info "$folder"/*.changes

heading "abacus-viewer"
as_root apt-get install -q -y --no-install-recommends "$folder"/abacus-viewer_*.deb
# Asks the installed viewer about a mesh: seen_by_viewer VERSION.
seen_by_viewer() {
    # shellcheck disable=SC2016 # the shell within expands it
    pg_virtualenv -v "$1" bash -euo pipefail -c '
        createdb seen
        psql -X -q -d seen -c "CREATE EXTENSION abacus" -c "SELECT abacus_triangulate('"'mesh', 'VALUES (1, 0, 0), (2, 1, 0), (3, 0, 1)'"')"
        abacus-viewer -d seen --port 8099 &
        trap "kill $!" EXIT
        for _ in {1..100}; do
            if node -e "fetch(\"http://localhost:8099/mesh/public/mesh/api/info\").then(async (answer) => process.exit((await answer.json()).simplices === 1 ? 0 : 1), () => process.exit(1))"; then exit 0; fi
            sleep 0.2
        done
        exit 1'
}

for version in $(pg_buildext supported-versions); do
    package=postgresql-$version-abacus
    heading "$package"
    as_root apt-get install -q -y --no-install-recommends "$folder/$package"_*.deb
    mkdir -p "$folder/$version"
    (cd "$folder/$version" &&
        pg_virtualenv -v "$version" make -s -f "$source/Makefile.pgxs" \
            PG_CONFIG="/usr/lib/postgresql/$version/bin/pg_config" installcheck REGRESS="create query edit" ISOLATION=)
    seen_by_viewer "$version" || fail "The installed viewer does not show a mesh"
    as_root apt-get remove -q -y "$package"
    left=$(find "/usr/lib/postgresql/$version" "/usr/share/postgresql/$version" -name 'abacus*')
    [[ -z $left ]] || fail "The package has left $left"
done
echo "All packages tested"
