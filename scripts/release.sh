#!/bin/bash
# Makes releases. docs/releasing.md is the checklist; this does what a machine can do.
#
#   release.sh check            what is missing for a release of this version; nothing if it can be made
#   release.sh date [DAY]       enters the day (today) of the release, in CHANGELOG.md, META.json and debian/changelog
#   release.sh build [N...]     makes the files of the release from the commit that is checked out: the tarball, the zip for
#                               PGXN, and Debian's sources and packages for these versions of PostgreSQL (all). Everything
#                               is built twice and compared, bit by bit. Needs `check` to pass. In build/release/VERSION
#   release.sh draft [N...]     the same from a copy that is dated today, before the release
#   release.sh next VERSION     begins the next version: freezes the scripts of this one, from which ALTER EXTENSION UPDATE
#                               leads on, and enters the new number everywhere
#   release.sh rehearse         begins a next version in a copy, and tests the update from this version and earlier ones;
#                               for that it installs the copy, and then this version again
set -euo pipefail
. "$(dirname "$0")/common.sh"
. scripts/packages.sh

extensions=(abacus abacus_lab abacus_postgis abacus_postgis_raster)
versions=(15 17 18 19)
node_packages=(viewer/package{,-lock}.json client/laz/package{,-lock}.json) # the version is in the lines 3 and 9
version=$(sed -n "s/^default_version = '\(.*\)'/\1/p" abacus.control)
output=$ABACUS_BUILD/release/$version
copy=$ABACUS_BUILD/release/copy
from=$ABACUS_ROOT # what is released: the commit that is checked out there

# A problem that a release must not have.
missing() {
    echo "$*"
    problems=$((problems + 1))
}

check() {
    local extension problems=0 format file
    [[ -z $(git status --porcelain) ]] || missing "There are changes that are not committed"
    for extension in "${extensions[@]}"; do
        grep -qx "default_version = '$version'" "$extension.control" || missing "$extension.control has another version"
        python3 -c "import json, sys; sys.exit(json.load(open('META.json'))['provides']['$extension']['version'] != '$version')" ||
            missing "META.json has another version of $extension"
    done
    python3 -c "import json, sys; meta = json.load(open('META.json')); sys.exit(meta['version'] != '$version' or meta['release_status'] != 'stable')" ||
        missing "META.json does not say that $version is stable (release.sh date)"
    for file in "${node_packages[@]}"; do sed -n 3p "$file" | grep -q "\"$version\"" || missing "$file has another version"; done
    grep -qE "^## \[${version//./\\.}\] - [0-9]{4}-[0-9]{2}-[0-9]{2}$" CHANGELOG.md ||
        missing "CHANGELOG.md has no day for $version (release.sh date)"
    [[ $(head -n 1 debian/changelog) == "abacus ($version) unstable; "* ]] ||
        missing "debian/changelog does not begin with $version, for unstable (release.sh date)"
    [[ ! -e sql/releases/abacus--$version.sql ]] || missing "$version was released before: sql/releases has its script"
    [[ -e test/tap/meshes/$version.sql ]] || missing "There is no mesh of $version in test/tap/meshes"
    for ((format = 2; format <= $(newest_format); ++format)); do
        compgen -G "test/tap/meshes/format-$format*.sql" >/dev/null || missing "There is no mesh of format $format in test/tap/meshes"
    done
    ((problems == 0))
}

newest_format() {
    grep -ohE 'format_[a-z]+ = [0-9]+' src/capi/header.cpp | awk '{ if ($3 > newest) newest = $3 } END { print newest }'
}

set_date() {
    local day=${1:-$(date -u +%F)}
    date -u -d "$day" >/dev/null || fail "$day is not a day"
    sed -i -E "s/^## \[${version//./\\.}\] - .*/## [$version] - $day/" CHANGELOG.md
    sed -i 's/"release_status": "unstable"/"release_status": "stable"/' META.json
    sed -i -E "1s/^abacus \(.*\) [A-Za-z]+;/abacus ($version) unstable;/
        0,/^ -- /s/^( -- .*>  ).*/\1$(date -u -d "$day" '+%a, %d %b %Y') 00:00:00 +0000/" debian/changelog
}

# The script of each extension as it is released, from where later versions go on.
next() {
    local new=${1:-} extension folder
    [[ $new =~ ^[0-9]+\.[0-9]+\.[0-9]+$ && $new != "$version" ]] || fail "usage: $0 next VERSION, such as 1.2.3"
    for extension in "${extensions[@]}"; do
        folder=${extension#abacus}
        cat "sql/install$folder"/*.sql >"sql/releases/$extension--$version.sql"
        mkdir -p "sql/upgrade$folder"
        echo "-- From $version: what has changed and cannot be said by CREATE OR REPLACE." >"sql/upgrade$folder/$version.sql"
        sed -i "s/^default_version = .*/default_version = '$new'/" "$extension.control"
    done
    sed -i -E "s/\"version\": \"${version//./\\.}\"/\"version\": \"$new\"/; s/\"release_status\": \"stable\"/\"release_status\": \"unstable\"/" META.json
    sed -i "3s/\"$version\"/\"$new\"/; 9s/\"$version\"/\"$new\"/" "${node_packages[@]}"
    sed -i "0,/^## \[/s/^## \[.*/## [$new] - unreleased\n\n&/" CHANGELOG.md
    { printf 'abacus (%s) UNRELEASED; urgency=medium\n\n  * %s\n\n' "$new" "See CHANGELOG.md."
      sed -n '0,/^ -- /{/^ -- /p}' debian/changelog
      echo
      cat debian/changelog; } >debian/changelog.new
    mv debian/changelog.new debian/changelog
}

# A clone of the commit that is checked out.
make_copy() {
    rm -rf "$copy"
    mkdir -p "${copy%/*}"
    git clone -q --no-hardlinks . "$copy"
}

# in_copy COMMAND...: a command of this script in the copy, which is committed afterwards.
in_copy() {
    (cd "$copy" && scripts/release.sh "$@" && git add -A &&
        git -c user.name=release -c user.email=release@localhost commit -q -m "$*")
}

rehearse() {
    local status=0
    make_copy
    in_copy next "${version%.*}.$((${version##*.} + 1))"
    (cd "$copy" && scripts/dev.sh one test/tap/update.pl) || status=1
    (cd "$copy" && as_root make -s -C build/extension -f "$copy/Makefile.pgxs" PG_CONFIG="$PG_CONFIG" uninstall >/dev/null)
    install_extension
    return "$status"
}

# archive FOLDER: tarball and zip of the commit.
archive() {
    local prefix=abacus-$version
    mkdir -p "$1"
    git -C "$from" archive --format=tar --prefix="$prefix/" HEAD | gzip -9 -n >"$1/$prefix.tar.gz"
    TZ=UTC git -C "$from" archive --format=zip -9 --prefix="$prefix/" HEAD >"$1/$prefix.zip"
}

# sources FOLDER: Debian's source package, from the tarball there.
sources() {
    (cd "$1" && tar -xzf "abacus-$version.tar.gz" && dpkg-source -b "abacus-$version" && rm -r "abacus-$version")
}

# Within a chroot: the packages of a source package in build/release/in, built in one folder one after the other.
packages() {
    local folder=$ABACUS_BUILD/release/in which=$1 time package
    export CCACHE_DISABLE=1 # the second time the compiler runs again
    packages_tools
    for time in once again; do
        rm -rf "$folder/work" "$folder/$time"
        mkdir -p "$folder/work" "$folder/$time"
        (cd "$folder/work" && dpkg-source -x ../*.dsc source && cd source && packages_prepare "$which" && packages_build "$which")
        cp "$folder"/work/*.deb "$folder/$time"
    done
    diff -r "$folder/once" "$folder/again" || fail "Built twice, the packages differ"
    # its Debian has all that a package needs
    for package in "$folder"/once/*.deb; do as_root apt-get install -q -y --no-install-recommends --simulate "$package" >/dev/null; done
    rm -r "$folder/work" "$folder/again"
}

build() {
    local folder number in which=-b epoch
    if (($#)); then versions=("$@"); fi
    epoch=$(git -C "$from" log -1 --format=%ct)
    export SOURCE_DATE_EPOCH=$epoch
    rm -rf "$output"
    for folder in once again; do
        archive "$output/$folder"
        sources "$output/$folder"
    done
    diff -r "$output"/once "$output"/again || fail "Made twice, the sources differ"
    mv "$output"/once/* "$output"
    rm -r "$output"/{once,again}
    for number in "${versions[@]}"; do
        heading "Packages for PostgreSQL $number"
        in=$ABACUS_BUILD/chroot-$number/build/release/in
        rm -rf "$in"
        mkdir -p "$in"
        cp "$output"/abacus_"$version".{dsc,tar.xz} "$in"
        scripts/chroot.sh "$number" scripts/release.sh packages "$which"
        which=-B
        cp "$in"/once/*.deb "$output"
    done
    (cd "$output" && sha256sum -- *.* >SHA256SUMS && cat SHA256SUMS)
    echo "All was built twice, with the same bits. What is left to do: docs/releasing.md"
}

draft() {
    make_copy
    in_copy date
    (cd "$copy" && scripts/release.sh check)
    from=$copy
    build "$@"
}

command=${1:-}
shift $(($# > 0))
case $command in
check | rehearse) "$command" ;;
date) set_date "$@" ;;
next | packages | draft) "$command" "$@" ;;
build) check && build "$@" ;;
*) fail "usage: $0 check|date [DAY]|build [N...]|draft [N...]|next VERSION|rehearse" ;;
esac
