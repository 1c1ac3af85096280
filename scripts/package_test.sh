#!/bin/bash
# Builds Debian's packages from a copy of the source, one for each installed version of PostgreSQL; checks
# them with lintian, installs them, runs regression tests of the installed extension, and removes them again.
# It changes the system in which it runs, so it is meant for a chroot.
#
#   chroot.sh 17 scripts/package_test.sh
set -euo pipefail
. "$(dirname "$0")/common.sh"

folder=$ABACUS_BUILD/package
source=$folder/abacus
export DEBIAN_FRONTEND=noninteractive DEB_BUILD_OPTIONS="nocheck noddebs parallel=$ABACUS_JOBS"
export CCACHE_DIR=${CCACHE_DIR:-$ABACUS_BUILD/ccache}

heading "Copy"
rm -rf "$folder"
mkdir -p "$source"
tar -C "$ABACUS_ROOT" --exclude=./build --exclude=./.git --exclude='*.o' -cf - . | tar -C "$source" -xf -
cd "$source"

heading "Packages for the build"
as_root apt-get update -q
as_root apt-get install -q -y --no-install-recommends dpkg-dev fakeroot lintian postgresql-server-dev-all
pg_buildext updatecontrol
as_root apt-get build-dep -q -y --no-install-recommends -P nocheck ./

heading "Build"
dpkg-buildpackage -us -uc -b --build-profiles=nocheck

heading "lintian"
lintian --allow-root --fail-on error --info "$folder"/*.changes

for version in $(pg_buildext supported-versions); do
    package=postgresql-$version-abacus
    heading "$package"
    as_root apt-get install -q -y --no-install-recommends "$folder/$package"_*.deb
    mkdir -p "$folder/$version"
    (cd "$folder/$version" &&
        pg_virtualenv -v "$version" make -s -f "$source/Makefile.pgxs" \
            PG_CONFIG="/usr/lib/postgresql/$version/bin/pg_config" installcheck REGRESS="create query edit" ISOLATION=)
    as_root apt-get remove -q -y "$package"
    left=$(find "/usr/lib/postgresql/$version" "/usr/share/postgresql/$version" -name 'abacus*')
    [[ -z $left ]] || fail "The package has left $left"
done
echo "All packages tested"
