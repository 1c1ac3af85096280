# Sourced: how Debian's packages are built, for the version of PostgreSQL that is tested. It installs what the build
# needs, so it is meant for a chroot (chroot.sh).

export DEBIAN_FRONTEND=noninteractive DEB_BUILD_OPTIONS="nocheck noddebs parallel=$ABACUS_JOBS"
# In Debian's experimental there is a version that postgresql-common does not count among the supported ones.
export PG_SUPPORTED_VERSIONS=$ABACUS_POSTGRESQL

packages_tools() {
    as_root apt-get update -q
    as_root apt-get install -q -y --no-install-recommends dpkg-dev fakeroot lintian \
        postgresql-server-dev-all "postgresql-server-dev-$ABACUS_POSTGRESQL"
}

# packages_prepare -b|-B and packages_build -b|-B are run in a copy of the source: for all packages, or without the viewer,
# which is the same for all versions.
packages_prepare() {
    pg_buildext updatecontrol
    as_root apt-get build-dep -q -y --no-install-recommends -P nocheck $([[ $1 == -b ]] || echo --arch-only) ./
}

packages_build() {
    dpkg-buildpackage -us -uc "$1" --build-profiles=nocheck
}
