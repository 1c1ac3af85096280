#!/bin/bash
# Runs a command in a small Debian with another version of PostgreSQL, or with libraries of another processor.
# The Debian is made once, in build/chroot-NAME/root, from the mirror that apt uses here.
#
#   chroot.sh NAME COMMAND...   e.g. chroot.sh 17 scripts/test.sh regress
#   chroot.sh NAME              only makes it
#
# NAME is 15, 17, 18, 19 or arm64. Exits with 77 if it cannot be made here: not root, no mirror, or no such suite
# there. A command installs the packages that it needs.
#
# In the chroot the source tree is /abacus, which is read-only, and build/chroot-NAME/build is its folder
# build. Nothing is mounted where others see it: all mounts are in a namespace of the command, and end with
# it, as do all its processes.
set -euo pipefail
. "$(dirname "$0")/common.sh"

# Debian's suites with these versions of PostgreSQL. Experimental has only what differs from sid.
declare -A suites=([15]=bookworm [17]=trixie [18]=forky [19]="sid experimental" [arm64]=trixie)

name=${1:-}
suite=${suites[${name:-none}]:-}
[[ -n $suite ]] || fail "usage: $0 15|17|18|19|arm64 [COMMAND...]"
shift
root=$ABACUS_BUILD/chroot-$name/root
build=$ABACUS_BUILD/chroot-$name/build
architectures=$(dpkg --print-architecture)
server=()
if [[ $name == arm64 ]]; then
    architectures+=,arm64
else
    server=(ABACUS_POSTGRESQL="$name" ABACUS_PACKAGES=versions)
fi

cannot() {
    echo "There is no Debian $suite for $name: $*" >&2
    exit 77
}

# The first Debian mirror that apt knows here.
mirror() {
    apt-get indextargets --format '$(REPO_URI)' 'Created-By: Packages' 'Label: Debian' | head -n 1
}

# The common part: no server is started, no cluster is made, only the programs are unpacked. A mirror may be a
# copy from an earlier day, with valid signatures but past dates.
make_root() {
    local from archive sources=()
    ((EUID == 0)) || cannot "it needs root"
    command -v mmdebstrap >/dev/null || { apt-get update -q && apt-get install -q -y --no-install-recommends mmdebstrap; } ||
        cannot "the package mmdebstrap is missing"
    from=$(mirror)
    [[ -n $from ]] || cannot "apt knows no mirror of Debian; try apt-get update"
    for archive in $suite; do sources+=("deb $from $archive main"); done
    rm -rf --one-file-system "$root.new"
    mkdir -p "${root%/*}" "$build"
    # apt takes nothing from experimental that nobody names, not even libpq of the server's version.
    printf 'Package: src:postgresql-%s\nPin: release *\nPin-Priority: 990\n' "$name" >"${root%/*}/preferences"
    mmdebstrap --variant=apt --components=main --architectures="$architectures" \
        --aptopt='APT::Install-Recommends "false"' --aptopt='Acquire::Check-Valid-Until "false"' \
        --aptopt='Acquire::Languages "none"' \
        --dpkgopt=force-unsafe-io --dpkgopt='path-exclude=/usr/share/man/*' \
        --dpkgopt='path-exclude=/usr/share/doc/*' --dpkgopt='path-exclude=/usr/share/locale/*' \
        --customize-hook='mkdir -p "$1/etc/postgresql-common" "$1/abacus"' \
        --customize-hook='echo "create_main_cluster = false" >"$1/etc/postgresql-common/createcluster.conf"' \
        --customize-hook="copy-in ${root%/*}/preferences /etc/apt" \
        --customize-hook='printf "#!/bin/sh\nexit 101\n" >"$1/usr/sbin/policy-rc.d"' \
        --customize-hook='chmod 755 "$1/usr/sbin/policy-rc.d"' \
        "${suite%% *}" "$root.new" "${sources[@]}" || cannot "mmdebstrap has failed"
    mv "$root.new" "$root"
}

# Runs the command with mounts of its own.
run() {
    local certificates=()
    mkdir -p build "$build"
    if [[ -n ${NODE_EXTRA_CA_CERTS:-} ]]; then # npm may reach its registry through a proxy
        cp -L "$NODE_EXTRA_CA_CERTS" "$root/etc/proxy.crt"
        certificates=(NODE_EXTRA_CA_CERTS=/etc/proxy.crt)
    fi
    # shellcheck disable=SC2016 # expanded in the chroot
    exec unshare --mount --propagation private --pid --fork --kill-child --mount-proc bash -c '
        set -euo pipefail
        root=$1 source=$2 build=$3
        shift 3
        for folder in proc dev sys; do mount --rbind "/$folder" "$root/$folder"; done
        mount -t tmpfs -o mode=1777 tmpfs "$root/tmp"
        mount --bind "$source" "$root/abacus"
        mount -o remount,bind,ro "$root/abacus"
        mount --bind "$build" "$root/abacus/build"
        cp -L /etc/resolv.conf /etc/hosts "$root/etc/"
        exec chroot "$root" "$@"' bash "$root" "$ABACUS_ROOT" "$build" \
        /usr/bin/env -i HOME=/root LANG=C.UTF-8 TERM="${TERM:-dumb}" PYTHONDONTWRITEBYTECODE=1 \
        PATH=/usr/lib/ccache:/usr/local/sbin:/usr/local/bin:/usr/sbin:/usr/bin:/sbin:/bin \
        ABACUS_CHROOT="$name" "${server[@]}" "${certificates[@]}" ABACUS_SHORTCUTS="${ABACUS_SHORTCUTS:-1}" \
        ${ABACUS_SEED:+ABACUS_SEED="$ABACUS_SEED"} ${ABACUS_KILLS:+ABACUS_KILLS="$ABACUS_KILLS"} \
        ABACUS_JOBS="$ABACUS_JOBS" ABACUS_WERROR="${ABACUS_WERROR-}" \
        bash -c 'cd /abacus && exec "$@"' bash "$@"
}

if [[ ! -d $root ]]; then make_root; fi
if (($#)); then run "$@"; fi
